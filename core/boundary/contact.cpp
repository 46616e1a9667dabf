#include "core/boundary/contact.h"

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <tuple>

#include "core/boundary/facet_grid.h"
#include "core/boundary/wall_surface.h"
#include "core/error.h"

namespace molten {
namespace {

constexpr int most_bounces = 8;    // a step; then the motion stops at the last contact
constexpr int most_pushes = 8;     // a step, out of an overlap
constexpr int most_responses = 8;  // to walls touched at once, before the velocity is led along the crease between them

/// The gap that a contact leaves, relative to the radius: much more than round-off, so that neither 1e6 steps at rest
/// nor the edges inside a flat wall are felt, and much less than anything physical.
constexpr double skin_ratio = 1e-8;
constexpr double skin_round_off = 1e-14;  // the least gap, relative to the largest coordinate

constexpr double absurd = 1e150;  // m: a longer path, or one that is not a number, has diverged; its square overflows

/// The walls that a particle touches at the same moment.
template <int Dim> struct Touching {
  std::array<Point<Dim>, most_bounces> normal;
  std::array<double, most_bounces> restitution;
  int count = 0;
};

template <int Dim> bool approaches(const Point<Dim>& u, const Point<Dim>& normal) {
  return u.dot(normal) < -sliding_tolerance * u.norm();
}

template <int Dim> int approached(const Point<Dim>& u, const Touching<Dim>& touching, int from = 0) {
  for (int k = from; k < touching.count; ++k)
    if (approaches<Dim>(u, touching.normal[k])) return k;
  return touching.count;
}

/// What is left of u when it may approach none of the walls: along one wall, along the crease of two, or nothing.
template <int Dim> Point<Dim> along_crease(Point<Dim> u, const Touching<Dim>& touching) {
  const int a = approached<Dim>(u, touching);
  if (a == touching.count) return u;
  const Point<Dim> n = touching.normal[a];
  const Point<Dim> slide = u - u.dot(n) * n;
  if (approached<Dim>(slide, touching) == touching.count) return slide;
  if constexpr (Dim == 3) {
    for (int b = 0; b < touching.count; ++b) {
      const Point<3> crease = n.cross(touching.normal[b]);
      if (crease.squaredNorm() < 1e-20) continue;
      const Point<3> along = crease * (crease.dot(u) / crease.squaredNorm());
      if (approached<3>(along, touching) == touching.count) return along;
    }
  }
  return Point<Dim>::Zero();
}

/// [P] 6.3.1 at the wall that was touched last; then the normal part alone at walls still touched that it now
/// approaches.
template <int Dim> void respond(Point<Dim>& u, const Touching<Dim>& touching, double slip) {
  const int last = touching.count - 1;
  const Point<Dim>& n = touching.normal[last];
  const double normal_part = u.dot(n);
  u = slip * (u - normal_part * n) + (normal_part < 0 ? -touching.restitution[last] : 1.0) * normal_part * n;
  for (int i = 0; i < most_responses; ++i) {
    const int k = approached<Dim>(u, touching);
    if (k == touching.count) return;
    u -= (1 + touching.restitution[k]) * u.dot(touching.normal[k]) * touching.normal[k];
  }
  u = along_crease<Dim>(u, touching);
}

}  // namespace

template <int Dim> struct Contact<Dim>::Impl {
  /// The first wall met, by the fraction t of the path. `rank` breaks ties: planes, then facets, in the order given.
  struct First {
    double key = HUGE_VAL, t = 0;
    std::int64_t rank = -1;
    Point<Dim> normal = Point<Dim>::Zero();
    std::int32_t wall = 0;
  };

  /// The nearest point of a wall; `normal` points to its front side.
  struct Near {
    double key = HUGE_VAL, distance = 0;
    bool behind = false;
    std::int64_t rank = -1;
    Point<Dim> point = Point<Dim>::Zero(), normal = Point<Dim>::Zero();
  };

  Impl(std::vector<Wall<Dim>> all, double r, double cell);
  bool near_wall(const Point<Dim>& x, double reach) const;
  int move(Motion<Dim>& motion, double dt) const;
  First first_contact(const Point<Dim>& x, const Point<Dim>& d, double r) const;
  void meet_facet(First& first, std::int32_t facet, const Point<Dim>& x, const Point<Dim>& d, double r) const;
  Near nearest_held(const Point<Dim>& x) const;
  Near nearest_any(const Point<Dim>& x, double limit) const;
  void come_near(Near& best, std::int32_t facet, const Point<Dim>& x, double limit, bool past_rims) const;
  void come_near_planes(Near& best, const Point<Dim>& x, double limit) const;
  double settle(Point<Dim>& x) const;
  bool push_out(Point<Dim>& x, const Near& near) const;

  std::vector<Wall<Dim>> walls;    // without their vertices and facets
  std::vector<Response> response;  // by wall
  struct Plane {
    Point<Dim> point, normal;
    std::int32_t wall;
  };
  std::vector<Plane> planes;
  WallSurface<Dim> surface;
  FacetGrid<Dim> grid;
  double radius, skin;
};

template <int Dim>
Contact<Dim>::Impl::Impl(std::vector<Wall<Dim>> all, double r, double cell)
    : walls(std::move(all)), surface(walls), radius(r) {
  double extent = surface.extent();
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const Wall<Dim>& wall = walls[w];
    response.push_back(wall.response);
    if (!wall.is_plane) continue;
    if (!wall.plane_point.allFinite() || !(std::abs(wall.plane_normal.norm() - 1) < 1e-6))
      throw Error(ExitCode::geometry, "wall " + std::to_string(w) + ": a plane needs a point and a unit normal");
    planes.push_back({wall.plane_point, wall.plane_normal.normalized(), static_cast<std::int32_t>(w)});
    extent = std::max(extent, wall.plane_point.template lpNorm<Eigen::Infinity>());
  }
  if (!(r > 0) || !(cell > 0)) throw Error(ExitCode::geometry, "contact: the radius and the cell must be positive");
  skin = std::max(skin_ratio * r, skin_round_off * extent);
  grid = FacetGrid<Dim>(surface.facets(), r + 4 * skin, cell);
  for (Wall<Dim>& wall : walls) wall.vertices = {}, wall.facets = {};
}

template <int Dim> bool Contact<Dim>::Impl::near_wall(const Point<Dim>& x, double reach) const {
  for (const Plane& p : planes)
    if (std::abs(p.normal.dot(x - p.point)) <= reach + radius + 4 * skin) return true;
  return grid.any_within(x, reach);
}

template <int Dim>
void Contact<Dim>::Impl::meet_facet(First& first, std::int32_t facet, const Point<Dim>& x, const Point<Dim>& d,
                                    double r) const {
  const Facet<Dim>& f = surface.facets()[facet];
  const double height = f.normal.dot(x - f.corner[0]);
  if (misses_slab(height, -f.normal.dot(d), r)) return;
  const auto hit = sweep_facet(f, x, d, r);
  if (!hit) return;
  // The centre has settled in front of all walls, so a face that holds from behind is the back of a thin plate.
  if (hit->feature == Feature::face && height < -r / 2) return;
  First found{hit->t, hit->t, static_cast<std::int64_t>(planes.size()) + facet, hit->normal, surface.wall(facet)};
  if (hit->feature != Feature::face) {
    const Crease crease = surface.crease(facet, hit->feature, hit->index);
    if (crease != Crease::rim &&
        hit->normal.dot(surface.pseudo_normal(facet, hit->feature, hit->index)) < -side_tolerance)
      return;
    if (crease == Crease::smooth) {  // the face decides: no bumps at edges inside a flat wall
      if (!approaches<Dim>(d, f.normal)) return;
      found.normal = f.normal;
    }
    found.key += skin / d.norm();  // faces win ties
  }
  if (std::tie(found.key, found.rank) < std::tie(first.key, first.rank)) first = found;
}

template <int Dim>
typename Contact<Dim>::Impl::First Contact<Dim>::Impl::first_contact(const Point<Dim>& x, const Point<Dim>& d,
                                                                     double r) const {
  First first;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const auto hit = sweep_plane<Dim>(planes[p].point, planes[p].normal, x, d, r);
    if (hit && hit->t < first.key) first = {hit->t, hit->t, static_cast<std::int64_t>(p), hit->normal, planes[p].wall};
  }
  grid.walk(x, d, [&](std::span<const std::int32_t> facets, double end) {
    for (const std::int32_t facet : facets) meet_facet(first, facet, x, d, r);
    return first.key > end;
  });
  return first;
}

template <int Dim>
void Contact<Dim>::Impl::come_near(Near& best, std::int32_t facet, const Point<Dim>& x, double limit,
                                   bool past_rims) const {
  const Facet<Dim>& f = surface.facets()[facet];
  const double height = f.normal.dot(x - f.corner[0]);
  if (further_than<Dim>(f, x, limit)) return;
  const auto near = nearest_point(f, x);
  if (!(near.distance < limit)) return;
  const Point<Dim> away = x - near.point;
  const bool rim = surface.crease(facet, near.feature, near.index) == Crease::rim;
  const Point<Dim> front = rim ? f.normal : surface.pseudo_normal(facet, near.feature, near.index);
  const bool face = near.feature == Feature::face;
  const bool behind = face ? height < 0 : away.dot(front) < -side_tolerance * near.distance;
  if (behind && rim && !past_rims) return;
  Near found{near.distance, near.distance, behind, static_cast<std::int64_t>(planes.size()) + facet,
             near.point,    f.normal};
  if (behind) found.key += skin;  // of two sides equally near, the front counts
  if (!face) found.normal = behind || near.distance < skin ? front.normalized() : Point<Dim>(away / near.distance);
  if (std::tie(found.key, found.rank) < std::tie(best.key, best.rank)) best = found;
}

template <int Dim> void Contact<Dim>::Impl::come_near_planes(Near& best, const Point<Dim>& x, double limit) const {
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const Point<Dim>& n = planes[p].normal;
    const double height = n.dot(x - planes[p].point), key = height < 0 ? skin - height : height;
    if (std::abs(height) < limit && key < best.key)
      best = {key, std::abs(height), height < 0, static_cast<std::int64_t>(p), x - height * n, n};
  }
}

/// The nearest wall within a radius that holds a particle at x: behind an open wall's rim there is nothing to hold it.
template <int Dim> typename Contact<Dim>::Impl::Near Contact<Dim>::Impl::nearest_held(const Point<Dim>& x) const {
  Near best;
  come_near_planes(best, x, radius);
  for (const std::int32_t facet : grid.near(x)) come_near(best, facet, x, radius, false);
  return best;
}

template <int Dim>
typename Contact<Dim>::Impl::Near Contact<Dim>::Impl::nearest_any(const Point<Dim>& x, double limit) const {
  Near best;
  come_near_planes(best, x, limit);
  const Point<Dim> reach = Point<Dim>::Constant(limit);
  if (limit < 16 * grid.cell())
    grid.visit_box(x - reach, x + reach, [&](std::span<const std::int32_t> facets) {
      for (const std::int32_t facet : facets) come_near(best, facet, x, limit, true);
    });
  else
    for (std::size_t f = 0; f < surface.facets().size(); ++f)
      come_near(best, static_cast<std::int32_t>(f), x, limit, true);
  return best;
}

/// One step out of an overlap. A wall in the way stops it half-way, so that a gap too narrow centres the particle.
template <int Dim> bool Contact<Dim>::Impl::push_out(Point<Dim>& x, const Near& near) const {
  const Point<Dim> d = (radius + skin - near.distance) * near.normal;
  const First blocked = first_contact(x, d, near.distance);
  const bool free = blocked.rank < 0;
  x += free ? d : Point<Dim>(0.5 * blocked.t * d);
  return free || blocked.t * d.norm() > skin;
}

/// Pushes x out of overlaps and to the front of walls; returns the radius that then fits: less than the particle's own
/// only where it is squeezed. The sweeps use that, so they never start with an overlap.
template <int Dim> double Contact<Dim>::Impl::settle(Point<Dim>& x) const {
  for (int i = 0; i < most_pushes; ++i) {
    const Near near = nearest_held(x);
    if (near.rank < 0) return radius;
    if (near.behind)
      x = near.point + skin * near.normal;
    else if (!push_out(x, near))
      break;
  }
  const Near near = nearest_held(x);
  if (near.rank < 0) return radius;
  return near.behind ? skin : std::max(skin, near.distance);
}

template <int Dim> int Contact<Dim>::Impl::move(Motion<Dim>& m, double dt) const {
  const Point<Dim> whole = dt * m.rate;
  const double reach = whole.norm();
  if (!(reach < absurd) || !m.position.allFinite() || !near_wall(m.position, reach)) {
    m.position += whole;
    return 0;
  }
  const double r = settle(m.position);
  Touching<Dim> touching;
  for (int bounces = 0; bounces < most_bounces; ++bounces) {
    const Point<Dim> d = dt * m.rate;
    if (d.isZero(0)) return bounces;
    const First hit = first_contact(m.position, d, r);
    if (hit.rank < 0) {
      m.position += d;
      return bounces;
    }
    m.position += hit.t * d + skin * hit.normal;
    dt *= 1 - hit.t;
    if (hit.t * d.norm() > 4 * skin) touching.count = 0;
    touching.normal[touching.count] = hit.normal;
    touching.restitution[touching.count++] = response[hit.wall].restitution;
    respond<Dim>(m.velocity, touching, response[hit.wall].slip);
    respond<Dim>(m.rate, touching, response[hit.wall].slip);
  }
  return most_bounces;
}

template <int Dim>
Contact<Dim>::Contact(std::vector<Wall<Dim>> walls, double radius, double cell)
    : impl_(std::make_unique<Impl>(std::move(walls), radius, cell)) {}
template <int Dim> Contact<Dim>::~Contact() = default;
template <int Dim> Contact<Dim>::Contact(Contact&&) noexcept = default;
template <int Dim> Contact<Dim>& Contact<Dim>::operator=(Contact&&) noexcept = default;

template <int Dim> bool Contact<Dim>::empty() const { return impl_->planes.empty() && impl_->surface.facets().empty(); }

template <int Dim> const std::vector<Wall<Dim>>& Contact<Dim>::walls() const { return impl_->walls; }
template <int Dim> const WallSurface<Dim>& Contact<Dim>::surface() const { return impl_->surface; }

template <int Dim> int Contact<Dim>::move(Motion<Dim>& motion, double dt) const { return impl_->move(motion, dt); }

template <int Dim> bool Contact<Dim>::may_touch(const Point<Dim>& x, double reach) const {
  return impl_->near_wall(x, reach);
}

template <int Dim> double Contact<Dim>::signed_distance(const Point<Dim>& x, double limit) const {
  const auto near = impl_->nearest_any(x, limit);
  if (near.rank < 0) return limit;
  return near.behind ? -near.distance : near.distance;
}

template class Contact<2>;
template class Contact<3>;

}  // namespace molten
