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
// - Walls touched at the same moment: slip acts once per contact; the velocity ends up approaching none of them.
// - After 8 bounces the motion of this step ends at the last contact.
// - Corners at exactly the same place join, also of different walls. A facet without area holds from all sides.
// - The same contact time: faces before edges and vertices, then planes, then the lower facet index.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace molten {

template <int Dim> using Point = Eigen::Matrix<double, Dim, 1>;

/// What happens to a velocity at a wall.
struct Response {
  double restitution = 0;  // what the normal part keeps, reversed
  double slip = 0;         // what the tangential part keeps: 0 no-slip, 1 free slip
};

/// What a wall's surface is like to a fluid that it supports (wall_support.h).
template <int Dim> struct WallSkin {
  Point<Dim> velocity = Point<Dim>::Zero();  // m/s; along the wall: it does not move as a whole
  std::optional<double> temperature;         // of the surface, or behind the layer; none: insulating
  double layer_diffusivity = 0;              // m²/s, conductivity of a layer over ρ c_p of the fluid; 0: no layer
  double layer_thickness = 0;                // m
};

/// A wall: facets (triangles in 3-D, segments in 2-D) or one infinite plane. One-sided: only particles on the side that
/// the normals point to are held (segments: the normal is to the left of a → b; triangles: counter-clockwise).
template <int Dim> struct Wall {
  std::vector<Point<Dim>> vertices;  // m
  std::vector<std::array<std::int32_t, Dim>> facets;
  bool is_plane = false;
  Point<Dim> plane_point = Point<Dim>::Zero(), plane_normal = Point<Dim>::Zero();  // m, unit
  Response response;
  WallSkin<Dim> skin;
};

/// A particle in motion. `rate` is what moves the position (velocity, or velocity + XSPH); both are reflected at walls.
template <int Dim> struct Motion {
  Point<Dim> position, velocity, rate;  // m, m/s, m/s
};

template <int Dim> class WallSurface;

template <int Dim> class Contact {
 public:
  /// `radius` (m) of the particles; `cell` (m) of the grid that lists the facets, made larger where huge walls need it.
  /// Throws Error (geometry) on a bad index, a coordinate that is not finite, or a plane without a unit normal.
  Contact(std::vector<Wall<Dim>> walls, double radius, double cell);
  ~Contact();
  Contact(Contact&&) noexcept;
  Contact& operator=(Contact&&) noexcept;

  bool empty() const;  // no walls

  /// The walls as given, less their vertices and facets, which are in the surface.
  const std::vector<Wall<Dim>>& walls() const;
  const WallSurface<Dim>& surface() const;

  /// Moves a particle by dt (s) along its rate, bouncing; a particle that overlaps a wall at the start is pushed out
  /// along the wall's normal. Returns how many bounces there were. A rate that is not finite moves it all the same.
  int move(Motion<Dim>& motion, double dt) const;

  /// False only if no wall can be met within `reach` (m) of x beyond the radius: the cheap test for most particles.
  bool may_touch(const Point<Dim>& x, double reach) const;

  /// Distance (m) from x to the nearest wall surface and the side: negative behind it. Brute force over near cells up
  /// to `limit`; returns `limit` if none is nearer. For tests, set-up checks and diagnostics.
  double signed_distance(const Point<Dim>& x, double limit) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace molten
