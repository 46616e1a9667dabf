// Boundary particles, for replication: walls made of particles instead of, or beside, their surface.
//   Dynamic (Dalrymple and Knio 2001; Crespo et al. 2007): two staggered rows that keep their places, or move as their
//   wall does, and take part in density and pressure as the fluid does. Their density may follow its rate every so many
//   steps only, and is never below that at rest (Hughes and Graham 2010).
//   Repulsive (Monaghan and Kos 1999, as in SPHysics 2.2): one row with normals that pushes the fluid away
//   (repulsion.h).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/boundary/contact.h"

namespace molten {

/// A dynamic boundary particle.
template <int Dim> struct HeldPoint {
  Point<Dim> at;           // m; of a wall that moves: in its body's frame
  std::int32_t body = -1;  // −1: stays
};

/// A repulsive one.
template <int Dim> struct RepulsivePoint {
  Point<Dim> at, normal;                      // m, unit; into the fluid
  std::array<Point<Dim>, Dim - 1> tangent{};  // unit
  std::array<double, Dim - 1> pitch{};        // m; to the next ones along the tangents
};

/// A row on the walls, `pitch` (m) apart or as near to that as whole parts of their edges allow, and one half a pitch
/// behind it, between its particles; around corners that the fluid is inside of, too. Planes have none.
template <int Dim> std::vector<HeldPoint<Dim>> held_points(const std::vector<Wall<Dim>>& walls, double pitch);

/// The pitch (m) with which both rows together hold as many particles as fluid of this spacing (m): two a cell.
template <int Dim> double held_pitch(double spacing);

/// A row on each flat part of the walls, its ends included. Throws Error(geometry) where a flat part is narrower than a
/// spacing (m): its ends would push too hard.
template <int Dim>
std::vector<RepulsivePoint<Dim>> repulsive_points(const std::vector<Wall<Dim>>& walls, double spacing);

}  // namespace molten
