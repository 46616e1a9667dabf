// Free bodies and walls that stay in place: a body's corners do not go through a wall's faces. The impulses of a step
// are found one after another until they agree (projected Gauss–Seidel; Catto, Iterative Dynamics with Temporal
// Coherence, 2005), for contacts that the step to come would make as well as for those that are. Corners of walls do
// not hold faces of bodies, and bodies do not hold each other.
#pragma once

#include <vector>

#include "core/bodies.h"

namespace molten {

/// The corners of a body's facets in its own frame, each once, m.
template <int Dim> std::vector<Point<Dim>> corners_of(const Contact<Dim>& contact, std::size_t body);

/// A free body in a step of dt (s), whose velocities change.
template <int Dim> struct HeldBody {
  const RigidBody<Dim>& body;
  const std::vector<Point<Dim>>& corners;
  RigidMotion<Dim>& motion;
  Spin<Dim>& angular_momentum;  // kg m²/s
};

/// Walls give back the part `restitution` of the velocity that a corner has towards them and leave it the part `slip`
/// along them, or brake it with their friction. `gravity` in m/s²; what is behind a wall comes out no faster than it
/// would have fallen in.
template <int Dim>
void hold_at_walls(const Contact<Dim>& contact, const HeldBody<Dim>& held, double dt, double gravity);

}  // namespace molten
