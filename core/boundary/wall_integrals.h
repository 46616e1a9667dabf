// What walls cut off a particle's support: integrals of the kernel over facets, exact for flat facets up to quadrature,
// for any kernel. By Gauss's theorem (Ferrand et al. 2013; Chiron et al. 2019)
//   ∫_solid ∇W dV = ∫_facets W n dS,   ∫_solid W dV = ∫_facets H(r) (n·x) dS,   H = r^−d ∫_r^R W s^{d−1} ds,
// where n points into the fluid, x from a facet's point to the particle; and the integrals over a triangle become
// line integrals along its edges, smooth ones, by the same theorem in its plane.
//
// Solid is what lies behind a facet, seen from the particle, up to the next back of a facet: an open sheet counts as
// infinitely thick, a closed body as thick as it is. Planes end where they meet other planes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/boundary/facet_grid.h"
#include "core/boundary/wall_surface.h"
#include "core/scene.h"

namespace molten {

/// A piece of one plane within a particle's support.
template <int Dim> struct WallPatch {
  Point<Dim> normal;    // unit, into the fluid
  Point<Dim> centroid;  // of W over the piece, from the particle, m
  double weight;        // ∫ W dS, 1/m
  double hidden;        // the part of ∫ W dV behind the piece
  double distance;      // of the particle from the plane, m
  std::int32_t wall;
};

/// Integrals of one kernel, as functions of a distance (m).
class RadialIntegrals {
 public:
  RadialIntegrals() = default;
  RadialIntegrals(KernelKind kernel, int dim, double smoothing_length);

  /// Of an infinite plane at the distance d > 0: ∫ W dS (1/m), and the part of ∫ W dV behind it.
  double plane_weight(double d) const { return at(plane_weight_, d); }
  double plane_hidden(double d) const { return at(plane_hidden_, d); }
  /// ∫_r^R W s ds, and in 3-D r ∫_r^R H s ds.
  double weight_beyond(double r) const { return at(weight_beyond_, r); }
  double hidden_beyond(double r) const { return at(hidden_beyond_, r); }
  double kernel(double r) const { return at(kernel_, r); }
  /// H(r) in 3-D, 1/m³
  double hidden_per_height(double r) const { return at(volume_beyond_, r) / (r * r * r); }
  double reach() const { return reach_; }  // support radius, m

 private:
  using Table = std::vector<double>;
  double at(const Table& table, double r) const {
    const double s = r * per_entry_;
    if (!(s < static_cast<double>(table.size() - 1))) return 0;
    const auto k = static_cast<std::size_t>(s);
    return table[k] + (s - static_cast<double>(k)) * (table[k + 1] - table[k]);
  }
  void fill_planes_2d();
  void fill_planes_3d();

  double reach_ = 0, per_entry_ = 0;  // m, 1/m
  Table kernel_, weight_beyond_, volume_beyond_, hidden_beyond_, plane_weight_, plane_hidden_;
};

template <int Dim> class WallIntegrals {
 public:
  WallIntegrals() = default;
  WallIntegrals(const std::vector<Wall<Dim>>& walls, const WallSurface<Dim>& surface, KernelKind kernel,
                double smoothing_length);

  double reach() const { return radial_.reach(); }

  /// Calls visit(patch) for each plane that has facets in the support of x.
  template <class Visit> void visit(const Point<Dim>& x, Visit&& visit) const;

  /// The whole of a plane as a patch; its weight is 0 behind the plane and beyond the support.
  WallPatch<Dim> at_plane(std::int32_t plane, const Point<Dim>& x) const {
    const Plane& p = planes_[static_cast<std::size_t>(plane)];
    const double d = p.normal.dot(x) - p.offset;
    const bool near = d > 0 && d < reach();
    return {p.normal, -d * p.normal, near ? radial_.plane_weight(d) : 0, near ? radial_.plane_hidden(d) : 0, d, p.wall};
  }

  static constexpr std::int32_t no_plane = -1, many_planes = -2;
  /// The only plane that is within `reach` (m) of x and goes on without an edge there; or no plane; or many.
  std::int32_t plane_near(const Point<Dim>& x, double reach) const;

  std::size_t bytes() const;

 private:
  struct Edge {
    Point<Dim> start, along, outward;  // m, unit, unit in the plane (3-D)
    double length;                     // m
    bool inner;                        // between two facets of one plane
  };
  struct Sheet {  // a facet, or what is left of an infinite plane
    Point<Dim> normal, centre;
    double radius;  // m, of a sphere about the centre that holds it
    std::uint32_t edges_begin, edges_end;
    std::int32_t plane;
    double area;  // m²; 0: not a triangle that shares no plane with a neighbour
  };
  struct Plane {
    Point<Dim> normal;
    double offset;  // m, normal · any point
    std::int32_t wall;
  };
  struct Sum {
    double weight = 0, hidden = 0;
    Point<Dim> moment = Point<Dim>::Zero();  // ∫ W x dS in the plane
  };

  void add_facets(const WallSurface<Dim>& surface);
  void add_planes(const std::vector<Wall<Dim>>& walls);
  void add_sheet(const std::vector<Point<Dim>>& corners, const std::vector<bool>& inner, std::int32_t plane);
  void add_small(Sum& sum, const Sheet& sheet, const Point<Dim>& x, double d) const;
  void add(Sum& sum, const Sheet& sheet, const Point<Dim>& x, double d) const;
  double distance(const Sheet& sheet, const Point<Dim>& x, bool outer_edges_alone) const;
  template <class Visit> void for_each_sheet(const Point<Dim>& x, Visit&& visit) const;
  WallPatch<Dim> patch_of(const Sum& sum, const Plane& plane, double d) const;

  RadialIntegrals radial_;
  FacetGrid<Dim> grid_;        // of the sheets but the infinite planes
  std::vector<Sheet> sheets_;  // by plane; what is left of infinite planes last
  std::vector<Edge> edges_;
  std::vector<Plane> planes_;
  std::size_t facets_ = 0;  // sheets in the grid
};

template <int Dim>
template <class Visit>
void WallIntegrals<Dim>::for_each_sheet(const Point<Dim>& x, Visit&& visit) const {
  for (const std::int32_t k : grid_.near(x)) visit(sheets_[k]);
  for (std::size_t k = facets_; k < sheets_.size(); ++k) visit(sheets_[k]);
}

template <int Dim> template <class Visit> void WallIntegrals<Dim>::visit(const Point<Dim>& x, Visit&& visit) const {
  double d = 0;
  std::int32_t current = no_plane;
  Sum sum;
  const auto finish = [&] {
    if (current != no_plane && sum.weight * reach() > 1e-9) visit(patch_of(sum, planes_[current], d));
  };
  for_each_sheet(x, [&](const Sheet& sheet) {
    if (sheet.plane != current) {
      finish();
      sum = {};
      current = sheet.plane;
      d = planes_[current].normal.dot(x) - planes_[current].offset;
    }
    if (std::abs(d) < reach()) add(sum, sheet, x, d);
  });
  finish();
}

}  // namespace molten
