// What walls cut off a particle's support: integrals of the kernel over facets, exact for flat facets up to quadrature,
// for any kernel. By Gauss's theorem (Ferrand et al. 2013; Chiron et al. 2019)
//   ∫_solid ∇W dV = ∫_facets W n dS,   ∫_solid W dV = ∫_facets H(r) (n·x) dS,   H = r^−d ∫_r^R W s^{d−1} ds,
// where n points into the fluid, x from a facet's point to the particle; and the integrals over a triangle become
// line integrals along its edges, smooth ones, by the same theorem in its plane.
//
// Solid is what lies behind a facet, seen from the particle, up to the next back of a facet: an open sheet counts as
// infinitely thick, a closed body as thick as it is. Planes end where they meet other planes.
//
// Facets much smaller than the support are gathered in clumps. What is small for its distance, r, counts by its moments
// of up to second order, ∫ f dS ≈ A f + ½ ∫(y ⊗ y) dS : ∇∇f, which leaves an error of (size/r)⁴: so a mesh costs as
// much as a coarse one of the same shape.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/boundary/edge_integrals.h"
#include "core/boundary/facet_grid.h"
#include "core/boundary/radial_integrals.h"
#include "core/boundary/wall_patch.h"
#include "core/boundary/wall_surface.h"
#include "core/scene.h"

namespace molten {

template <int Dim> class WallIntegrals {
 public:
  WallIntegrals() = default;
  WallIntegrals(const std::vector<Wall<Dim>>& walls, const WallSurface<Dim>& surface, KernelKind kernel,
                double smoothing_length);

  double reach() const { return radial_.reach(); }

  /// Calls visit(patch) for each patch in the support of x.
  template <class Visit> void visit(const Point<Dim>& x, Visit&& visit) const;

  /// What facets lie in side by side.
  struct Plane {
    Point<Dim> normal;
    double offset;  // m, normal · any point
    std::int32_t wall;
  };
  const Plane& plane(std::int32_t number) const { return planes_[static_cast<std::size_t>(number)]; }
  /// Of a plane without an edge near, at a height (m) over it.
  RadialIntegrals::Plane of_plane(double height) const { return radial_.plane(height); }

  static constexpr std::int32_t no_plane = -1, many_planes = -2;
  /// The only plane that is within `reach` (m) of x and goes on without an edge there; or no plane; or many.
  std::int32_t plane_near(const Point<Dim>& x, double reach) const;

  std::size_t bytes() const;

 private:
  struct Edge {
    Point<Dim> start, along, outward;  // m, unit, unit in the plane (3-D)
    double length;                     // m
    bool inner;                        // between two facets of one plane
    bool cancels;                      // and what the other one adds along it is always added, too
  };
  struct Sheet {  // a facet, or what is left of an infinite plane
    Point<Dim> normal, centre;
    double radius;  // m, of a sphere about the centre that holds it
    std::uint32_t edges_begin, edges_end;
    std::int32_t plane;
    double size;       // m^(d−1)
    Turn<Dim> spread;  // ∫ y ⊗ y dS/size about the centre, m²
  };
  /// Facets side by side, which count as one from afar.
  struct Clump {
    Point<Dim> normal, centre;
    double radius;     // m
    bool whole;        // no edge of it is left to a neighbour to cancel
    double size;       // ∫ dS, m^(d−1)
    double area;       // |∫ n dS|, m^(d−1)
    double bulge;      // ∫ n·(y − centre) dS, m^d
    Turn<Dim> spread;  // as a sheet's
    std::uint32_t sheets_begin, sheets_end;
  };
  struct Sum {
    double weight = 0, hidden = 0;
    Point<Dim> moment = Point<Dim>::Zero();  // ∫ W x dS in the plane
  };
  struct Foot {  // of a particle in the plane of a sheet
    Point<Dim> place;
    double height, radius2;  // m, of the particle over it; m², of the disc that the support cuts out of the plane
  };
  class Builder;

  void add_planes(const std::vector<Wall<Dim>>& walls);
  void add_sheet(const std::vector<Point<Dim>>& corners, const std::vector<bool>& inner,
                 const std::vector<bool>& cancels, std::int32_t plane);
  void add(PatchSums<Dim>& sums, const Clump& clump, const Point<Dim>& x) const;
  void add(PatchSums<Dim>& sums, const Sheet& sheet, bool whole, const Point<Dim>& x) const;
  void add_part(Sum& sum, const Sheet& sheet, const Point<Dim>& centre, double scale, const Point<Dim>& x) const;
  void add_exact(Sum& sum, const Sheet& sheet, const Point<Dim>& x, double d) const;
  void add_segment(Sum& sum, const Edge& edge, const Foot& foot) const;
  void add_polygon(Sum& sum, const Sheet& sheet, const Foot& foot) const;
  void take_off_beyond(Sum& sum, const Edge& edge, const Foot& foot, double p) const;
  void add_along(Sum& sum, const Edge& edge, const Foot& foot, double p, double from, double to) const;
  bool misses(const Sheet& sheet, const Foot& foot) const;
  double distance(const Sheet& sheet, const Point<Dim>& x, bool outer_edges_alone) const;

  RadialIntegrals radial_;
  EdgeIntegrals across_;       // 3-D
  FacetGrid<Dim> grid_;        // of the clumps
  std::vector<Clump> clumps_;  // of facets
  std::vector<Sheet> sheets_;  // by clump; what is left of infinite planes last
  std::vector<Edge> edges_;
  std::vector<Plane> planes_;
  std::size_t facets_ = 0;  // sheets in clumps
};

template <int Dim> template <class Visit> void WallIntegrals<Dim>::visit(const Point<Dim>& x, Visit&& visit) const {
  PatchSums<Dim> sums;
  for (const std::int32_t k : grid_.near(x)) add(sums, clumps_[k], x);
  for (std::size_t k = facets_; k < sheets_.size(); ++k) add(sums, sheets_[k], false, x);
  for (const PatchSum<Dim>& sum : sums)
    if (sum.weight() * reach() > 1e-9) visit(sum.patch());
}

}  // namespace molten
