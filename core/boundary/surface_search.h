// Walls that move together, in their own frame: the first that a moving sphere meets, and the nearest to a point. Two
// ways to find the facets, which give the same answers to the bit: grid lists for short paths, a tree for long ones,
// huge meshes and walls that are crowded somewhere in a large space (facet_grid.h, facet_tree.h).
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/boundary/contact.h"
#include "core/boundary/facet_grid.h"
#include "core/boundary/facet_sides.h"
#include "core/boundary/facet_tree.h"
#include "core/boundary/wall_surface.h"

namespace molten {

/// The first wall met, by the fraction t of the path. `rank` breaks ties: planes, then facets, in the order given.
template <int Dim> struct FirstContact {
  double key = HUGE_VAL, t = 0;
  std::int64_t rank = -1;
  Point<Dim> normal = Point<Dim>::Zero();
  std::int32_t wall = 0;
};

/// The nearest point of a wall; `normal` points to its front side.
template <int Dim> struct NearestWall {
  double key = HUGE_VAL, distance = 0;
  bool behind = false;
  std::int64_t rank = -1;
  Point<Dim> point = Point<Dim>::Zero(), normal = Point<Dim>::Zero();
};

/// The facets that can matter to a sphere on a short way, so that they are looked for once.
struct FewFacets {
  static constexpr int most = 4;
  std::array<std::int32_t, most> facet{};
  int count = -1;       // −1: more, or not known
  bool inside = false;  // only one, and nothing else: the sphere stays over its inside

  bool known() const { return count >= 0; }
  void forget() { count = -1, inside = false; }
  std::span<const std::int32_t> list() const { return {facet.data(), static_cast<std::size_t>(std::max(count, 0))}; }
};

template <int Dim> class SurfaceSearch {
 public:
  /// `radius` (m) of the spheres, `skin` (m) the gap that a contact leaves, `cell` (m) of the grid that is wanted.
  SurfaceSearch(const std::vector<Wall<Dim>>& walls, double radius, double skin, double cell, SearchMethod method);

  bool empty() const { return planes_.empty() && surface_.facets().empty(); }
  bool has_planes() const { return !planes_.empty(); }
  const WallSurface<Dim>& surface() const { return surface_; }
  /// Distance (m) of the furthest corner from the frame's origin.
  double extent() const;

  /// False only if no wall can be met within `reach` (m) of x beyond the radius.
  bool any_within(const Point<Dim>& x, double reach) const;
  /// The same for all x in the box lower..upper.
  bool any_within(const Point<Dim>& lower, const Point<Dim>& upper, double reach) const;

  /// The facets within a radius of any place within `reach` (m) of x.
  FewFacets few_within(const Point<Dim>& x, double reach) const;
  /// The facet that is alone within a radius of all places within `reach` (m) of x, which are over its inside; −1 if
  /// none is.
  std::int32_t only_face(const Point<Dim>& x, double reach) const;

  /// What a sphere of radius r (m), at most that of the construction, meets first on its way from x to x + d. `few`:
  /// where they are known for all of the way, only they are looked at.
  FirstContact<Dim> first_contact(const Point<Dim>& x, const Point<Dim>& d, double r, const FewFacets& few = {}) const {
    return few.inside ? meet_face(few.facet[0], x, d, r) : search_contact(x, d, r, few);
  }

  /// The nearest wall within a radius that holds a particle at x: behind an open wall's rim nothing holds it.
  NearestWall<Dim> nearest_held(const Point<Dim>& x, const FewFacets& few = {}) const;
  /// Whether there is one.
  bool is_held(const Point<Dim>& x, const FewFacets& few) const {
    return few.inside ? std::abs(height(few.facet[0], x)) < radius_ : nearest_held(x, few).rank >= 0;
  }

  /// The nearest wall within `limit` (m) of x.
  NearestWall<Dim> nearest_any(const Point<Dim>& x, double limit) const;

  /// f(wall, normal, height) for each face that x is over, up to `limit` (m) in front or behind.
  using OnFace = std::function<void(std::int32_t, const Point<Dim>&, double)>;
  void visit_faces(const Point<Dim>& x, double limit, const OnFace& f) const;

 private:
  struct Plane {
    Point<Dim> point, normal;
    std::int32_t wall;
  };

  const FacetTree<Dim>& tree() const;
  bool is_long(const Point<Dim>& d) const;
  double height(std::int32_t facet, const Point<Dim>& x) const {
    const Facet<Dim>& f = surface_.facets()[facet];
    return f.normal.dot(x - f.corner[0]);
  }
  std::int64_t rank(std::int32_t facet) const { return static_cast<std::int64_t>(planes_.size()) + facet; }
  FirstContact<Dim> meet_face(std::int32_t facet, const Point<Dim>& x, const Point<Dim>& d, double r) const;
  FirstContact<Dim> search_contact(const Point<Dim>& x, const Point<Dim>& d, double r, const FewFacets& few) const;
  void meet_planes(FirstContact<Dim>& first, const Point<Dim>& x, const Point<Dim>& d, double r) const;
  void meet_facet(FirstContact<Dim>& first, std::int32_t facet, const Point<Dim>& x, const Point<Dim>& d,
                  double r) const;
  void come_near(NearestWall<Dim>& best, std::int32_t facet, const Point<Dim>& x, double limit, bool past_rims) const;
  void come_near_planes(NearestWall<Dim>& best, const Point<Dim>& x, double limit) const;

  std::vector<Plane> planes_;
  WallSurface<Dim> surface_;
  double radius_, skin_;
  bool tree_alone_ = false;     // no grid
  double longest_in_grid_ = 0;  // m; longer paths go through the tree
  FacetGrid<Dim> grid_;
  std::vector<FacetSides<Dim>> sides_;  // with the grid
  double side_slack_ = 0;               // m
  mutable std::once_flag planted_;      // the tree grows when it is first wanted
  mutable std::unique_ptr<FacetTree<Dim>> tree_;
};

/// Over a facet's inside only its face can be met: what sweep_facet and meet_facet come to there, to the bit.
template <int Dim>
inline FirstContact<Dim> SurfaceSearch<Dim>::meet_face(std::int32_t facet, const Point<Dim>& x, const Point<Dim>& d,
                                                       double r) const {
  const Point<Dim>& normal = surface_.facets()[facet].normal;
  const double from = height(facet, x), descent = -normal.dot(d);
  if (misses_slab(from, descent, r) || is_behind_plate(from, r) || d.isZero(0)) return {};
  if (!(from > r) && !approaches<Dim>(d, normal)) return {};
  const double t = from > r ? std::min((from - r) / descent, 1.0) : 0;
  return {t, t, rank(facet), normal, surface_.wall(facet)};
}

}  // namespace molten
