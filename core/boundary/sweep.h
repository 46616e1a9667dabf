// First contact of a moving sphere (a circle in 2-D) with one facet or plane, exact up to round-off. Replaces the test
// of [P] 6.3 (eqs 6-10 to 6-13), which tests edges and vertices only where the sphere meets the facet's *plane*, and
// lets an overlap (t < 0) pass.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "core/boundary/contact.h"

namespace molten {

/// The part of a facet that is nearest. A segment in 2-D has a face (its inside) and two vertices.
enum class Feature : std::uint8_t { face, edge, vertex };

/// A triangle (3-D) or segment (2-D). Edge k runs from corner k to corner k + 1.
template <int Dim> struct Facet {
  std::array<Point<Dim>, Dim> corner;  // m
  Point<Dim> normal;                   // unit; zero for a facet without area, which then holds from all sides
};

/// A facet's normal is found in extended precision, so that needles are good down to an aspect of 1e-12.
template <int Dim> Facet<Dim> make_facet(const std::array<Point<Dim>, Dim>& corner);

template <int Dim> struct NearestPoint {
  Point<Dim> point;
  double distance;  // m, not negative
  Feature feature;
  int index;  // which edge or vertex of the facet
};

template <int Dim> NearestPoint<Dim> nearest_point(const Facet<Dim>& facet, const Point<Dim>& x);

/// A cheap test: true only if the facet is further from x than `distance` (m).
template <int Dim> bool further_than(const Facet<Dim>& facet, const Point<Dim>& x, double distance);

template <int Dim> struct SweepHit {
  double t;           // fraction of the displacement, 0 to 1
  Point<Dim> normal;  // unit, from the point of contact to the sphere's centre
  Feature feature;
  int index;  // which edge or vertex of the facet
};

/// Approaching slower than this fraction of the speed is sliding, not a contact: it is round-off. A centre that is
/// behind a facet by this fraction of its distance counts as in front.
inline constexpr double sliding_tolerance = 1e-12, side_tolerance = 1e-9;

template <int Dim> bool approaches(const Point<Dim>& u, const Point<Dim>& normal) {
  const double along = u.dot(normal);
  return along < 0 && along < -sliding_tolerance * u.norm();  // most do not, and need no root
}

/// The centre has settled in front of all walls, so a face that it is this far behind is the back of a thin plate.
inline bool is_behind_plate(double height, double radius) { return height < -radius / 2; }

/// True if a path whose height above a plane starts at `height` (m) and falls by `descent` (m) stays clear of it.
inline bool misses_slab(double height, double descent, double radius) {
  const double end = height - descent;
  return std::min(height, end) > radius || std::max(height, end) < -radius;
}

/// The sphere at x moves by d (m). A contact is where it first touches the facet with its centre on the front side; an
/// overlap at the start that is approaching is a contact at t = 0, also when the centre is behind the face by up to one
/// radius.
template <int Dim>
std::optional<SweepHit<Dim>> sweep_facet(const Facet<Dim>& facet, const Point<Dim>& x, const Point<Dim>& d,
                                         double radius);

/// The same for the infinite plane through `point` with the unit normal `normal`.
template <int Dim>
std::optional<SweepHit<Dim>> sweep_plane(const Point<Dim>& point, const Point<Dim>& normal, const Point<Dim>& x,
                                         const Point<Dim>& d, double radius);

}  // namespace molten
