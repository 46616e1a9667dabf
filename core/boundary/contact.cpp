#include "core/boundary/contact.h"

#include <cmath>
#include <string>
#include <utility>

#include "core/boundary/face_bounce.h"
#include "core/boundary/surface_search.h"
#include "core/boundary/touching.h"
#include "core/error.h"

namespace molten {
namespace {

constexpr int most_bounces = 8;  // a step; then the motion stops at the last contact
constexpr int most_pushes = 8;   // a step, out of an overlap

/// The gap that a contact leaves, relative to the radius: much more than round-off, so that neither 1e6 steps at rest
/// nor the edges inside a flat wall are felt, and much less than anything physical.
constexpr double skin_ratio = 1e-8;
constexpr double skin_round_off = 1e-14;  // the least gap, relative to the largest coordinate

constexpr double absurd = 1e150;  // m: a longer path, or one that is not a number, has diverged; its square overflows

template <int Dim> double largest_coordinate(const std::vector<Wall<Dim>>& walls) {
  double extent = 0;
  for (const Wall<Dim>& wall : walls) {
    for (const auto& v : wall.vertices) extent = std::max(extent, v.template lpNorm<Eigen::Infinity>());
    if (wall.is_plane) extent = std::max(extent, wall.plane_point.template lpNorm<Eigen::Infinity>());
  }
  return extent;
}

template <int Dim> void require_planes(const std::vector<Wall<Dim>>& walls) {
  for (std::size_t w = 0; w < walls.size(); ++w)
    if (walls[w].is_plane &&
        (!walls[w].plane_point.allFinite() || !(std::abs(walls[w].plane_normal.norm() - 1) < 1e-6)))
      throw Error(ExitCode::geometry, "wall " + std::to_string(w) + ": a plane needs a point and a unit normal");
}

/// A turning body has set a particle aside, by the bend of its way during the step: the moment of that, too, is shared.
template <int Dim>
void set_aside(const Motion<Dim>& m, const Point<Dim>& by, std::int32_t body, std::span<Kick<Dim>> kicks) {
  if (!kicks.empty()) kicks[body].angular += moment_of(by, m.velocity);
}

}  // namespace

template <int Dim> struct Contact<Dim>::Impl {
  /// Walls that move together: the fixed ones, or one body's.
  struct Group {
    std::unique_ptr<SurfaceSearch<Dim>> search;
    std::vector<Wall<Dim>> walls;  // without their vertices and facets
    std::int32_t body = -1;
    double extent = 0;  // m, from the body's centre; infinite with planes
    RigidMotion<Dim> motion;
  };

  /// The first contact of a path that takes the times `from` to `to` (s) of the step.
  struct Meeting {
    FirstContact<Dim> contact;
    const Group* group = nullptr;
    Point<Dim> path = Point<Dim>::Zero(), start = Point<Dim>::Zero();  // m; in the group's frame
  };
  Impl(std::vector<Wall<Dim>> walls, double r, double cell, SearchMethod method);
  const Group& group(std::int32_t body) const { return body < 0 ? fixed : bodies[static_cast<std::size_t>(body)]; }
  bool near_body(const Group& group, const Point<Dim>& x, double reach, double dt) const;
  bool near_wall(const Point<Dim>& x, double reach, double dt) const;
  int move(Motion<Dim>& motion, double dt, std::span<Kick<Dim>> kicks) const;
  Meeting first_contact(const Point<Dim>& x, const Point<Dim>& d, double r, double from, double to,
                        const FewFacets& few = {}) const;
  NearestWall<Dim> nearest_held(const Point<Dim>& x) const;
  NearestWall<Dim> nearest_any(const Point<Dim>& x, double limit) const;
  double settle(Point<Dim>& x) const;
  bool push_out(Point<Dim>& x, const NearestWall<Dim>& near) const;

  Group fixed;
  std::vector<Group> bodies;
  double radius, skin;
};

template <int Dim>
Contact<Dim>::Impl::Impl(std::vector<Wall<Dim>> walls, double r, double cell, SearchMethod method) : radius(r) {
  require_planes(walls);
  if (!(r > 0) || !(cell > 0)) throw Error(ExitCode::geometry, "contact: the radius and the cell must be positive");
  skin = std::max(skin_ratio * r, skin_round_off * largest_coordinate(walls));
  std::int32_t last = -1;
  for (const Wall<Dim>& wall : walls) last = std::max(last, wall.body);
  const auto fill = [&](Group& group, std::int32_t body) {
    for (Wall<Dim>& wall : walls)
      if (wall.body == body) group.walls.push_back(std::move(wall));
    group.search = std::make_unique<SurfaceSearch<Dim>>(group.walls, r, skin, cell, method);
    group.body = body;
    group.extent = group.search->has_planes() ? HUGE_VAL : group.search->extent();
    for (Wall<Dim>& wall : group.walls) wall.vertices = {}, wall.facets = {};
  };
  fill(fixed, -1);
  bodies.resize(static_cast<std::size_t>(last + 1));
  for (std::size_t b = 0; b < bodies.size(); ++b) fill(bodies[b], static_cast<std::int32_t>(b));
}

/// `reach`: the particle's own way.
template <int Dim>
bool Contact<Dim>::Impl::near_body(const Group& group, const Point<Dim>& x, double reach, double dt) const {
  const RigidMotion<Dim>& m = group.motion;
  const double apart = (x - m.start.centre).norm(), all = radius + 4 * skin + reach + dt * m.velocity.norm();
  if (apart > group.extent + all) return false;
  const double turning = m.spin.norm() * dt * std::min(apart + all, group.extent);
  return group.search->any_within(m.start.to_body(x), reach + dt * m.velocity.norm() + turning);
}

template <int Dim> bool Contact<Dim>::Impl::near_wall(const Point<Dim>& x, double reach, double dt) const {
  if (fixed.search->any_within(x, reach)) return true;
  for (const Group& group : bodies)
    if (near_body(group, x, reach, dt)) return true;
  return false;
}

template <int Dim>
typename Contact<Dim>::Impl::Meeting Contact<Dim>::Impl::first_contact(const Point<Dim>& x, const Point<Dim>& d,
                                                                       double r, double from, double to,
                                                                       const FewFacets& few) const {
  Meeting first{fixed.search->first_contact(x, d, r, few), &fixed, d, x};
  for (const Group& group : bodies) {
    if (!near_body(group, x, d.norm(), to)) continue;
    const Point<Dim> start = group.motion.after(from).to_body(x), end = group.motion.after(to).to_body(x + d);
    const auto contact = group.search->first_contact(start, end - start, r);
    if (contact.rank >= 0 && contact.key < first.contact.key) first = {contact, &group, end - start, start};
  }
  return first;
}

/// The nearest wall within a radius that holds a particle at x when the step starts.
template <int Dim> NearestWall<Dim> Contact<Dim>::Impl::nearest_held(const Point<Dim>& x) const {
  NearestWall<Dim> best = fixed.search->nearest_held(x);
  for (const Group& group : bodies) {
    if (!near_body(group, x, 0, 0)) continue;
    const Pose<Dim>& pose = group.motion.start;
    NearestWall<Dim> near = group.search->nearest_held(pose.to_body(x));
    if (near.rank < 0 || near.key >= best.key) continue;
    near.point = pose.to_world(near.point);
    near.normal = pose.turn * near.normal;
    best = near;
  }
  return best;
}

template <int Dim> NearestWall<Dim> Contact<Dim>::Impl::nearest_any(const Point<Dim>& x, double limit) const {
  NearestWall<Dim> best = fixed.search->nearest_any(x, limit);
  for (const Group& group : bodies) {
    const NearestWall<Dim> near = group.search->nearest_any(group.motion.start.to_body(x), limit);
    if (near.rank >= 0 && near.key < best.key) best = near;
  }
  return best;
}

/// One step out of an overlap. A wall in the way stops it half-way, so that a gap too narrow centres the particle.
template <int Dim> bool Contact<Dim>::Impl::push_out(Point<Dim>& x, const NearestWall<Dim>& near) const {
  const Point<Dim> d = (radius + skin - near.distance) * near.normal;
  const FirstContact<Dim> blocked = first_contact(x, d, near.distance, 0, 0).contact;
  const bool free = blocked.rank < 0;
  x += free ? d : Point<Dim>(0.5 * blocked.t * d);
  return free || blocked.t * d.norm() > skin;
}

/// Pushes x out of overlaps and to the front of walls; returns the radius that then fits: less than the particle's own
/// only where it is squeezed. The sweeps use that, so they never start with an overlap.
template <int Dim> double Contact<Dim>::Impl::settle(Point<Dim>& x) const {
  for (int i = 0; i < most_pushes; ++i) {
    const NearestWall<Dim> near = nearest_held(x);
    if (near.rank < 0) return radius;
    if (near.behind)
      x = near.point + skin * near.normal;
    else if (!push_out(x, near))
      break;
  }
  const NearestWall<Dim> near = nearest_held(x);
  if (near.rank < 0) return radius;
  return near.behind ? skin : std::max(skin, near.distance);
}

template <int Dim> int Contact<Dim>::Impl::move(Motion<Dim>& m, double dt, std::span<Kick<Dim>> kicks) const {
  const Point<Dim> whole = dt * m.rate;
  const double reach = whole.norm();
  if (!(reach < absurd) || !m.position.allFinite()) {
    m.position += whole;
    return 0;
  }
  // Its way and the gaps that contacts leave; bounces do not make it longer, unless it gets faster.
  const double all = (1 + 1e-9) * reach + (most_bounces + 1) * skin, speed2 = m.rate.squaredNorm();
  FewFacets few = bodies.empty() ? fixed.search->few_within(m.position, all) : FewFacets();
  if (!few.known() && !near_wall(m.position, reach, dt)) {
    m.position += whole;
    return 0;
  }
  double r = radius;
  if (!few.known() || fixed.search->is_held(m.position, few)) few.forget(), r = settle(m.position);
  Touching<Dim> touching;
  double now = 0;  // s since the start of the step
  for (int bounces = 0; bounces < most_bounces; ++bounces) {
    const Point<Dim> d = (dt - now) * m.rate;
    if (d.isZero(0) && bodies.empty()) return bounces;
    const Meeting hit = first_contact(m.position, d, r, now, dt, few);
    if (hit.contact.rank < 0) {
      m.position += d;
      return bounces;
    }
    const RigidMotion<Dim>& motion = hit.group->motion;
    const double before = std::exchange(now, now + hit.contact.t * (dt - now));
    // Within the gap that the last contact left the particle has touched the wall all the time.
    const bool resting = -hit.contact.t * hit.path.dot(hit.contact.normal) <= 4 * skin;
    const double held = dt - (resting ? before : now);  // s
    const Wall<Dim>& wall = hit.group->walls[hit.contact.wall];
    Touch<Dim> touch{hit.contact.normal, Point<Dim>::Zero(), &wall.response, hit.group->body};
    if (hit.group == &fixed) {
      m.position += hit.contact.t * d + skin * hit.contact.normal;
      touch.velocity = wall.skin.velocity_along(touch.normal);
    } else {
      const Pose<Dim> pose = motion.after(now);
      touch.normal = pose.turn * hit.contact.normal;
      const Point<Dim> straight = m.position + hit.contact.t * d;
      m.position = pose.to_world(hit.start + hit.contact.t * hit.path + skin * hit.contact.normal);
      set_aside<Dim>(m, m.position - straight, touch.body, kicks);
      touch.velocity = motion.velocity_at(m.position, pose.centre);
    }
    if (hit.contact.t * hit.path.norm() > 4 * skin) touching.clear();
    touching.add(touch);
    touching.respond(m.velocity, held, [&](const Touch<Dim>& by, const Point<Dim>& gain) {
      if (by.body < 0 || kicks.empty()) return;
      const Point<Dim> arm = m.position - bodies[by.body].motion.after(dt).centre;
      kicks[by.body].linear += gain;
      kicks[by.body].angular += moment_of(arm, gain);
    });
    touching.respond(m.rate, held, [](const Touch<Dim>&, const Point<Dim>&) {});
    if (m.rate.squaredNorm() > (1 + 1e-9) * speed2) few.forget();
  }
  // A body goes on and takes along what it touched last.
  if (const std::int32_t body = touching.last().body; body >= 0) {
    const RigidMotion<Dim>& motion = bodies[body].motion;
    const Point<Dim> before = m.position;
    m.position = motion.after(dt).to_world(motion.after(now).to_body(m.position));
    set_aside<Dim>(m, m.position - before, body, kicks);
  }
  return most_bounces;
}

template <int Dim>
Contact<Dim>::Contact(std::vector<Wall<Dim>> walls, double radius, double cell, SearchMethod method)
    : impl_(std::make_unique<Impl>(std::move(walls), radius, cell, method)) {}
template <int Dim> Contact<Dim>::~Contact() = default;
template <int Dim> Contact<Dim>::Contact(Contact&&) noexcept = default;
template <int Dim> Contact<Dim>& Contact<Dim>::operator=(Contact&&) noexcept = default;

template <int Dim> bool Contact<Dim>::empty() const { return impl_->bodies.empty() && impl_->fixed.search->empty(); }
template <int Dim> std::size_t Contact<Dim>::bodies() const { return impl_->bodies.size(); }

template <int Dim> const std::vector<Wall<Dim>>& Contact<Dim>::walls_of(std::int32_t body) const {
  return impl_->group(body).walls;
}
template <int Dim> const WallSurface<Dim>& Contact<Dim>::surface_of(std::int32_t body) const {
  return impl_->group(body).search->surface();
}

template <int Dim> void Contact<Dim>::set_motion(std::size_t body, const RigidMotion<Dim>& motion) {
  impl_->bodies[body].motion = motion;
}

template <int Dim> int Contact<Dim>::move(Motion<Dim>& motion, double dt, std::span<Kick<Dim>> kicks) const {
  return impl_->move(motion, dt, kicks);
}

template <int Dim> bool Contact<Dim>::may_touch(const Point<Dim>& x, double reach) const {
  return impl_->near_wall(x, reach, 0);
}

template <int Dim>
bool Contact<Dim>::may_touch_in(const Point<Dim>& lower, const Point<Dim>& upper, double reach) const {
  if (impl_->fixed.search->any_within(lower, upper, reach)) return true;
  const Point<Dim> middle = (lower + upper) / 2;
  const double all = reach + (upper - lower).norm() / 2;
  for (const auto& group : impl_->bodies)
    if (impl_->near_body(group, middle, all, 0)) return true;
  return false;
}

template <int Dim> double Contact<Dim>::free_way(const Point<Dim>& x, double limit) const {
  if (!impl_->near_wall(x, limit, 0)) return limit;
  const double touching = impl_->radius + 4 * impl_->skin;
  const auto near = impl_->nearest_any(x, limit + touching);
  return near.rank < 0 ? limit : std::max(0.0, near.distance - touching);
}

template <int Dim>
std::optional<ClusterLanes> Contact<Dim>::bounce_off(std::int32_t face, ClusterMotion<Dim>& motion, double dt) const {
  const WallSurface<Dim>& surface = impl_->fixed.search->surface();
  const Wall<Dim>& wall = impl_->fixed.walls[surface.wall(face)];
  return FaceBounce<Dim>(surface.facets()[face], wall, impl_->radius, impl_->skin).move(motion, dt);
}

template <int Dim> std::int32_t Contact<Dim>::only_face(const Point<Dim>& x, double reach) const {
  return impl_->bodies.empty() ? impl_->fixed.search->only_face(x, reach) : -1;
}

template <int Dim>
bool Contact<Dim>::may_touch_body(std::size_t body, const Pose<Dim>& pose, const Point<Dim>& x, double reach) const {
  const auto& group = impl_->bodies[body];
  if ((x - pose.centre).norm() > group.extent + impl_->radius + 4 * impl_->skin + reach) return false;
  return group.search->any_within(pose.to_body(x), reach);
}

template <int Dim>
void Contact<Dim>::visit_fixed_walls(const Point<Dim>& x, double limit,
                                     const std::function<void(const OverFace<Dim>&)>& f) const {
  impl_->fixed.search->visit_faces(x, limit, [&](std::int32_t wall, const Point<Dim>& normal, double height) {
    const Wall<Dim>& w = impl_->fixed.walls[static_cast<std::size_t>(wall)];
    if (height < 0 && w.two_sided) return;  // its other side is there, too
    f({normal, height, &w});
  });
}

template <int Dim> bool Contact<Dim>::may_touch_fixed(const Point<Dim>& x, double reach) const {
  return impl_->fixed.search->any_within(x, reach);
}

template <int Dim> double Contact<Dim>::skin() const { return impl_->skin; }

template <int Dim> double Contact<Dim>::signed_distance(const Point<Dim>& x, double limit) const {
  const auto near = impl_->nearest_any(x, limit);
  if (near.rank < 0) return limit;
  return near.behind ? -near.distance : near.distance;
}

template class Contact<2>;
template class Contact<3>;

}  // namespace molten
