#include "core/boundary/surface_search.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "core/error.h"

namespace molten {
namespace {

// The rule that picks grid or tree looks at the walls and the path alone, so runs repeat. bench/contact shows the
// crossover of path lengths.
constexpr std::size_t huge_mesh = 1000000;  // facets; the grid's lists would take more room than the mesh
constexpr double crowded_list = 64;         // facets in the mean list: the grid's cells are far larger than the facets
constexpr double long_path = 0.5;           // cells
constexpr double round_off = 1e-14;         // relative to the largest coordinate

}  // namespace

template <int Dim>
SurfaceSearch<Dim>::SurfaceSearch(const std::vector<Wall<Dim>>& walls, double radius, double skin, double cell,
                                  SearchMethod method)
    : surface_(walls), radius_(radius), skin_(skin) {
  for (std::size_t w = 0; w < walls.size(); ++w)
    if (walls[w].is_plane)
      planes_.push_back({walls[w].plane_point, walls[w].plane_normal.normalized(), static_cast<std::int32_t>(w)});
  tree_alone_ =
      method == SearchMethod::tree || (method == SearchMethod::by_rule && surface_.facets().size() >= huge_mesh);
  if (!tree_alone_) grid_ = FacetGrid<Dim>(surface_.facets(), radius + 4 * skin, cell);
  if (method == SearchMethod::by_rule && grid_.mean_list() > crowded_list) {
    tree_alone_ = true;
    grid_ = {};
  }
  if (surface_.facets().empty()) tree_alone_ = false;
  if (!tree_alone_) {
    sides_.reserve(surface_.facets().size());
    for (const auto& facet : surface_.facets()) sides_.emplace_back(facet);
  }
  side_slack_ = round_off * surface_.extent();
  longest_in_grid_ = method == SearchMethod::grid ? HUGE_VAL : long_path * grid_.cell();
}

template <int Dim> const FacetTree<Dim>& SurfaceSearch<Dim>::tree() const {
  std::call_once(planted_,
                 [this] { tree_ = std::make_unique<FacetTree<Dim>>(surface_.facets(), radius_ + 4 * skin_); });
  return *tree_;
}

template <int Dim> bool SurfaceSearch<Dim>::is_long(const Point<Dim>& d) const {
  return !surface_.facets().empty() && d.norm() > longest_in_grid_;
}

template <int Dim> double SurfaceSearch<Dim>::extent() const {
  double furthest2 = 0;
  for (const auto& f : surface_.facets())
    for (const auto& c : f.corner) furthest2 = std::max(furthest2, c.squaredNorm());
  return std::sqrt(furthest2);
}

template <int Dim> bool SurfaceSearch<Dim>::any_within(const Point<Dim>& x, double reach) const {
  for (const Plane& p : planes_)
    if (std::abs(p.normal.dot(x - p.point)) <= reach + radius_ + 4 * skin_) return true;
  if (!tree_alone_) return grid_.any_within(x, reach);
  bool any = false;
  tree().near(x, reach, [&](std::int32_t) { return !(any = true); });
  return any;
}

template <int Dim>
bool SurfaceSearch<Dim>::any_within(const Point<Dim>& lower, const Point<Dim>& upper, double reach) const {
  const Point<Dim> middle = (lower + upper) / 2, half = (upper - lower) / 2;
  for (const Plane& p : planes_) {
    const double away = std::abs(p.normal.dot(middle - p.point)) - p.normal.cwiseAbs().dot(half);
    if (away <= reach + radius_ + 4 * skin_) return true;
  }
  const Point<Dim> around = Point<Dim>::Constant(reach);
  if (!tree_alone_) return grid_.any_in_box(lower - around, upper + around);
  bool any = false;
  tree().near(middle, reach + half.norm(), [&](std::int32_t) { return !(any = true); });
  return any;
}

// ---- the first contact ----------------------------------------------------------------------------------------------

template <int Dim>
void SurfaceSearch<Dim>::meet_facet(FirstContact<Dim>& first, std::int32_t facet, const Point<Dim>& x,
                                    const Point<Dim>& d, double r) const {
  const Facet<Dim>& f = surface_.facets()[facet];
  const double from = height(facet, x);
  if (misses_slab(from, -f.normal.dot(d), r)) return;
  const auto hit = sweep_facet(f, x, d, r);
  if (!hit) return;
  if (hit->feature == Feature::face && is_behind_plate(from, r)) return;
  FirstContact<Dim> found{hit->t, hit->t, rank(facet), hit->normal, surface_.wall(facet)};
  if (hit->feature != Feature::face) {
    const Crease crease = surface_.crease(facet, hit->feature, hit->index);
    if (crease != Crease::rim &&
        hit->normal.dot(surface_.pseudo_normal(facet, hit->feature, hit->index)) < -side_tolerance)
      return;
    if (crease == Crease::smooth) {  // the face decides: no bumps at edges inside a flat wall
      if (!approaches<Dim>(d, f.normal)) return;
      found.normal = f.normal;
    }
    found.key += skin_ / d.norm();  // faces win ties
  }
  if (std::tie(found.key, found.rank) < std::tie(first.key, first.rank)) first = found;
}

template <int Dim>
void SurfaceSearch<Dim>::meet_planes(FirstContact<Dim>& first, const Point<Dim>& x, const Point<Dim>& d,
                                     double r) const {
  for (std::size_t p = 0; p < planes_.size(); ++p) {
    const auto hit = sweep_plane<Dim>(planes_[p].point, planes_[p].normal, x, d, r);
    if (hit && hit->t < first.key) first = {hit->t, hit->t, static_cast<std::int64_t>(p), hit->normal, planes_[p].wall};
  }
}

template <int Dim> FewFacets SurfaceSearch<Dim>::few_within(const Point<Dim>& x, double reach) const {
  FewFacets few;
  if (tree_alone_) return few;
  const auto near = grid_.near_all(x, reach);
  if (!near) return few;
  few.count = 0;
  for (const std::int32_t facet : *near) {
    const auto at = sides_[facet].at(x);
    if (at.further_than(radius_ + reach + side_slack_)) continue;
    if (few.count == FewFacets::most) return {};
    few.facet[few.count++] = facet;
    few.inside = few.count == 1 && at.inside > reach + side_slack_ && planes_.empty();
  }
  return few;
}

template <int Dim> std::int32_t SurfaceSearch<Dim>::only_face(const Point<Dim>& x, double reach) const {
  if (tree_alone_ || has_planes()) return -1;
  const Point<Dim> around = Point<Dim>::Constant(reach);
  std::int32_t face = -1;
  bool alone = true;
  grid_.visit_box(x - around, x + around, [&](std::span<const std::int32_t> facets) {
    for (const std::int32_t facet : facets) {
      const auto at = sides_[facet].at(x);
      if (facet == face || at.further_than(radius_ + reach + side_slack_)) continue;
      alone = face < 0 && at.inside > reach + side_slack_;
      face = facet;
      if (!alone) return;
    }
  });
  return alone ? face : -1;
}

template <int Dim>
FirstContact<Dim> SurfaceSearch<Dim>::search_contact(const Point<Dim>& x, const Point<Dim>& d, double r,
                                                     const FewFacets& few) const {
  FirstContact<Dim> first;
  meet_planes(first, x, d, r);
  if (few.known())
    for (const std::int32_t facet : few.list()) meet_facet(first, facet, x, d, r);
  else if (tree_alone_ || is_long(d))
    tree().sweep(x, d, [&](std::int32_t facet) {
      meet_facet(first, facet, x, d, r);
      return first.key;
    });
  else
    grid_.walk(x, d, [&](std::span<const std::int32_t> facets, double end) {
      for (const std::int32_t facet : facets) meet_facet(first, facet, x, d, r);
      return first.key > end;
    });
  return first;
}

// ---- the nearest ----------------------------------------------------------------------------------------------------

template <int Dim>
void SurfaceSearch<Dim>::come_near(NearestWall<Dim>& best, std::int32_t facet, const Point<Dim>& x, double limit,
                                   bool past_rims) const {
  const Facet<Dim>& f = surface_.facets()[facet];
  if (further_than<Dim>(f, x, std::min(limit, (1 + 1e-9) * best.key))) return;
  const auto near = nearest_point(f, x);
  if (!(near.distance < limit)) return;
  const Point<Dim> away = x - near.point;
  const bool rim = surface_.crease(facet, near.feature, near.index) == Crease::rim;
  const Point<Dim> front = rim ? f.normal : surface_.pseudo_normal(facet, near.feature, near.index);
  const bool face = near.feature == Feature::face;
  const bool behind = face ? height(facet, x) < 0 : away.dot(front) < -side_tolerance * near.distance;
  if (behind && rim && !past_rims) return;
  NearestWall<Dim> found{near.distance, near.distance, behind, rank(facet), near.point, f.normal};
  if (behind) found.key += skin_;  // of two sides equally near, the front counts
  if (!face) found.normal = behind || near.distance < skin_ ? front.normalized() : Point<Dim>(away / near.distance);
  if (std::tie(found.key, found.rank) < std::tie(best.key, best.rank)) best = found;
}

template <int Dim>
void SurfaceSearch<Dim>::come_near_planes(NearestWall<Dim>& best, const Point<Dim>& x, double limit) const {
  for (std::size_t p = 0; p < planes_.size(); ++p) {
    const Point<Dim>& n = planes_[p].normal;
    const double height = n.dot(x - planes_[p].point), key = height < 0 ? skin_ - height : height;
    if (std::abs(height) < limit && key < best.key)
      best = {key, std::abs(height), height < 0, static_cast<std::int64_t>(p), x - height * n, n};
  }
}

template <int Dim> NearestWall<Dim> SurfaceSearch<Dim>::nearest_held(const Point<Dim>& x, const FewFacets& few) const {
  NearestWall<Dim> best;
  come_near_planes(best, x, radius_);
  if (few.known())
    for (const std::int32_t facet : few.list()) come_near(best, facet, x, radius_, false);
  else if (tree_alone_)
    tree().near(x, 0, [&](std::int32_t facet) {
      come_near(best, facet, x, radius_, false);
      return true;
    });
  else
    for (const std::int32_t facet : grid_.near(x)) come_near(best, facet, x, radius_, false);
  return best;
}

template <int Dim> void SurfaceSearch<Dim>::visit_faces(const Point<Dim>& x, double limit, const OnFace& f) const {
  for (const Plane& p : planes_) {
    const double at = p.normal.dot(x - p.point);
    if (std::abs(at) <= limit) f(p.wall, p.normal, at);
  }
  const auto face = [&](std::int32_t facet) {
    const auto near = nearest_point(surface_.facets()[facet], x);
    if (near.feature == Feature::face && near.distance <= limit)
      f(surface_.wall(facet), surface_.facets()[facet].normal, height(facet, x));
  };
  if (tree_alone_)
    tree().near(x, limit, [&](std::int32_t facet) {
      face(facet);
      return true;
    });
  else
    grid_.visit_box(x - Point<Dim>::Constant(limit), x + Point<Dim>::Constant(limit),
                    [&](std::span<const std::int32_t> facets) { std::for_each(facets.begin(), facets.end(), face); });
}

template <int Dim> NearestWall<Dim> SurfaceSearch<Dim>::nearest_any(const Point<Dim>& x, double limit) const {
  NearestWall<Dim> best;
  come_near_planes(best, x, limit);
  const Point<Dim> reach = Point<Dim>::Constant(std::max(0.0, limit - radius_));  // a cell lists what is a radius away
  if (tree_alone_)
    tree().near(x, limit, [&](std::int32_t facet) {
      come_near(best, facet, x, limit, true);
      return true;
    });
  else if (limit < 16 * grid_.cell())
    grid_.visit_box(x - reach, x + reach, [&](std::span<const std::int32_t> facets) {
      for (const std::int32_t facet : facets) come_near(best, facet, x, limit, true);
    });
  else
    for (std::size_t f = 0; f < surface_.facets().size(); ++f)
      come_near(best, static_cast<std::int32_t>(f), x, limit, true);
  return best;
}

template class SurfaceSearch<2>;
template class SurfaceSearch<3>;

}  // namespace molten
