// Moving spheres against walls: exact continuous collision with faces, edges and vertices, several bounces a step, in
// double precision ([P] 6.3, made exact). Stateless after construction; thread-safe.
//
// The rules, where [P] has none:
// - A contact leaves a gap of 1e-8 radii (at least 1e-14 of the largest coordinate), far above round-off: resting and
//   sliding neither drift through the wall nor feel the edges inside it.
// - Sides: a centre in front of a wall's nearest point is pushed out to one radius. A centre behind a face by less than
//   one radius is brought to its front, unless another front is as near; behind the rim of an open wall, or deeper,
//   nothing holds it.
// - A particle with no room (a gap narrower than its diameter, a sharp wedge) goes to the middle and moves as a smaller
//   one; it stays on the fluid's side.
// - Walls touched at the same moment: slip or friction acts once per contact; the velocity ends up approaching none of
//   them.
// - After 8 bounces the motion of this step ends at the last contact.
// - A two-sided wall is two walls back to back.
// - A body that moves is met in its own frame, where a particle's way over the step counts as straight: what is in
//   front of its surface stays there. Between a body and a wall, and between bodies, the same rules hold; a gap that
//   closes to less than a diameter is no room.
// - Corners at exactly the same place join, also of different walls. A facet without area holds from all sides.
// - The same contact time: faces before edges and vertices, then planes, then the lower facet index, and walls before
//   bodies.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/boundary/rigid_motion.h"
#include "core/cluster_motion.h"

namespace molten {

/// What happens to a velocity at a wall, relative to the wall's own.
struct Response {
  double restitution = 0;  // what the normal part keeps, reversed
  double slip = 0;         // what the tangential part keeps: 0 no-slip, 1 free slip
  /// Instead of slip: the wall holds the tangential part up to a stress and drags with it beyond (Mohr–Coulomb).
  struct Grip {
    double friction = 0;  // Coulomb's coefficient: tangential over normal impulse
    double hold = 0;      // m/s²; what the stress that sticks, the wall's yield stress, can brake a particle with
  };
  std::optional<Grip> grip = std::nullopt;
};

/// What a wall's surface is like to the fluid; `temperature` and the layer with support alone (wall_support.h).
template <int Dim> struct WallSkin {
  Point<Dim> velocity = Point<Dim>::Zero();  // m/s; its part along the wall counts: the wall stays where it is
  std::optional<double> temperature;         // of the surface, or behind the layer; none: insulating
  double layer_diffusivity = 0;              // m²/s, conductivity of a layer over ρ c_p of the fluid; 0: no layer
  double layer_thickness = 0;                // m

  Point<Dim> velocity_along(const Point<Dim>& normal) const { return velocity - velocity.dot(normal) * normal; }
};

/// How facets are found; `by_rule` is for runs, the others for comparison. All give the same contacts.
enum class SearchMethod { by_rule, grid, tree };

/// A wall: facets (triangles in 3-D, segments in 2-D) or one infinite plane. One-sided: only particles on the side that
/// the normals point to are held (segments: the normal is to the left of a → b; triangles: counter-clockwise).
template <int Dim> struct Wall {
  std::vector<Point<Dim>> vertices;  // m
  std::vector<std::array<std::int32_t, Dim>> facets;
  bool is_plane = false;
  Point<Dim> plane_point = Point<Dim>::Zero(), plane_normal = Point<Dim>::Zero();  // m, unit
  bool two_sided = false;                                                          // facets hold from behind, too
  Response response;
  WallSkin<Dim> skin;
  std::int32_t body = -1;  // the body that it is part of, whose frame it is given in (rigid_motion.h); −1: fixed
};

/// A particle in motion. `rate` is what moves the position (velocity, or velocity + XSPH); both are reflected at walls.
template <int Dim> struct Motion {
  Point<Dim> position, velocity, rate;  // m, m/s, m/s
};

template <int Dim> class WallSurface;

/// What a body gives to the particles that hit it, a unit of particle mass.
template <int Dim> struct Kick {
  Point<Dim> linear = Point<Dim>::Zero();  // m/s
  Spin<Dim> angular = Spin<Dim>::Zero();   // m²/s; about the body's centre at the end of the step
};

/// A point over the face of a wall.
template <int Dim> struct OverFace {
  Point<Dim> normal;  // unit, of the wall's front
  double gap;         // m; negative behind the wall
  const Wall<Dim>* wall;
};

template <int Dim> class Contact {
 public:
  /// `radius` (m) of the particles; `cell` (m) of the grid that lists the facets, made larger where huge walls need it.
  /// Throws Error (geometry) on a bad index, a coordinate that is not finite, or a plane without a unit normal.
  Contact(std::vector<Wall<Dim>> walls, double radius, double cell, SearchMethod method = SearchMethod::by_rule);
  ~Contact();
  Contact(Contact&&) noexcept;
  Contact& operator=(Contact&&) noexcept;

  bool empty() const;  // no walls
  std::size_t bodies() const;

  /// How a body moves during the step to come.
  void set_motion(std::size_t body, const RigidMotion<Dim>& motion);

  /// The walls that stay in place (−1) or those of a body, less their vertices and facets, which are in the surface.
  const std::vector<Wall<Dim>>& walls_of(std::int32_t body) const;
  const WallSurface<Dim>& surface_of(std::int32_t body) const;

  /// Moves a particle by dt (s) along its rate, bouncing; a particle that overlaps a wall at the start is pushed out
  /// along the wall's normal. Returns how many bounces there were. A rate that is not finite moves it all the same.
  /// `kicks`: one for each body, or none; what the particle's velocity gains at a body is added to the body's.
  int move(Motion<Dim>& motion, double dt, std::span<Kick<Dim>> kicks = {}) const;

  /// Moves all of a cluster at once, as `move` would each, where `face` is all that they can meet and each bounces off
  /// it once at most; 1 for those that did, else 0. Where one does more, nothing is moved: no value.
  std::optional<ClusterLanes> bounce_off(std::int32_t face, ClusterMotion<Dim>& motion, double dt) const;

  /// The face that is all that a particle can meet within `reach` (m) of x; −1 if there is none, or more than it.
  std::int32_t only_face(const Point<Dim>& x, double reach) const;

  /// False only if no wall can be met within `reach` (m) of x beyond the radius: the cheap test for most particles.
  /// Bodies count where their motion starts; their own way is part of the reach.
  bool may_touch(const Point<Dim>& x, double reach) const;

  /// The same for all x in the box lower..upper at once.
  bool may_touch_in(const Point<Dim>& lower, const Point<Dim>& upper, double reach) const;

  /// How far (m) a particle at x may go, or a body come, before they can meet; up to `limit`. A little less than exact.
  double free_way(const Point<Dim>& x, double limit) const;

  /// `may_touch` for the walls of one body when it is at `pose`.
  bool may_touch_body(std::size_t body, const Pose<Dim>& pose, const Point<Dim>& x, double reach) const;

  /// Calls f for each wall that stays in place over whose face x is, up to `limit` (m) in front or behind.
  void visit_fixed_walls(const Point<Dim>& x, double limit, const std::function<void(const OverFace<Dim>&)>& f) const;
  /// False only if there is none for any point within `reach` (m) of x.
  bool may_touch_fixed(const Point<Dim>& x, double reach) const;
  /// The gap (m) that contacts leave.
  double skin() const;

  /// Distance (m) from x to the nearest wall surface and the side: negative behind it. Brute force over what is near up
  /// to `limit`; returns `limit` if none is nearer. For tests, set-up checks and diagnostics.
  double signed_distance(const Point<Dim>& x, double limit) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace molten
