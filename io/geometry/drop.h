// What something that moves straight on meets first, walls' backs too.
#pragma once

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/boundary/contact.h"
#include "core/boundary/sweep.h"

namespace molten {

/// Where something that falls first meets a wall.
struct Landing {
  double t = HUGE_VAL;  // fraction of the way
  std::size_t wall = 0;
  bool behind = false;
};

/// Moves points straight along `way` (m) onto walls, from either side.
template <int Dim> class Drop {
 public:
  Drop(const std::vector<Wall<Dim>>& walls, const Point<Dim>& way, double radius) : way_(way), radius_(radius) {
    for (std::size_t k = 0; k < walls.size(); ++k) {
      if (walls[k].is_plane) planes_.push_back({walls[k].plane_point, walls[k].plane_normal, k});
      for (const auto& f : walls[k].facets) add(walls[k], f, k);
    }
  }

  const Point<Dim>& way() const { return way_; }

  Landing from(const Point<Dim>& x) const {
    Landing first;
    const auto meet = [&](const auto& hit, std::size_t wall, bool behind) {
      if (hit && hit->t < first.t) first = {hit->t, wall, behind};
    };
    for (const auto& p : planes_) meet(sweep_plane(p.point, p.normal, x, way_, radius_), p.wall, false);
    for (const auto& f : facets_) meet(sweep_facet(f.facet, x, way_, radius_), f.wall, f.behind);
    return first;
  }

 private:
  struct Part {
    Facet<Dim> facet;
    std::size_t wall;
    bool behind;
  };
  struct Plane {
    Point<Dim> point, normal;
    std::size_t wall;
  };

  /// The side that is met.
  void add(const Wall<Dim>& wall, const std::array<std::int32_t, Dim>& corners, std::size_t index) {
    std::array<Point<Dim>, Dim> c;
    for (int k = 0; k < Dim; ++k) c[k] = wall.vertices[corners[k]];
    Facet<Dim> facet = make_facet<Dim>(c);
    const bool behind = facet.normal.dot(way_) > 0;
    if (behind) {
      std::swap(c[0], c[1]);
      facet = make_facet<Dim>(c);
    }
    facets_.push_back({facet, index, behind && !wall.two_sided});
  }

  Point<Dim> way_;  // m
  double radius_;   // m
  std::vector<Part> facets_;
  std::vector<Plane> planes_;
};

}  // namespace molten
