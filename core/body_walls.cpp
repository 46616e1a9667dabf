#include "core/body_walls.h"

#include <algorithm>
#include <cmath>

#include "core/boundary/wall_surface.h"

namespace molten {

namespace {

constexpr int sweeps = 16;           // over all contacts
constexpr double return_part = 0.1;  // of the depth behind a wall that a step may make up for

template <int Dim> using MomentMatrix = Eigen::Matrix<double, Dim == 2 ? 1 : 3, Dim == 2 ? 1 : 3>;

MomentMatrix<2> turned(const MomentMatrix<2>& moment, const Turn<2>&) { return moment; }
MomentMatrix<3> turned(const MomentMatrix<3>& moment, const Turn<3>& turn) { return turn * moment * turn.transpose(); }

/// What an impulse (kg m/s) at an arm (m) from the centre does.
template <int Dim> class Pushed {
 public:
  explicit Pushed(const HeldBody<Dim>& held)
      : held_(held),
        inverse_mass_(1 / held.body.inertia->mass),
        inverse_moment_(turned(held.body.inertia->moment, held.motion.start.turn).inverse()) {}

  void add(const Point<Dim>& arm, const Point<Dim>& impulse) {
    const Spin<Dim> moment = moment_of(arm, impulse);
    held_.motion.velocity += inverse_mass_ * impulse;
    held_.motion.spin += inverse_moment_ * moment;
    held_.angular_momentum += moment;
  }
  Point<Dim> velocity(const Point<Dim>& arm) const { return held_.motion.velocity + cross(held_.motion.spin, arm); }
  /// The change of velocity along a direction by a unit of impulse along it, 1/kg.
  double softness(const Point<Dim>& arm, const Point<Dim>& along) const {
    const Spin<Dim> moment = moment_of(arm, along);
    return inverse_mass_ + moment.dot(Spin<Dim>(inverse_moment_ * moment));
  }

 private:
  HeldBody<Dim> held_;
  double inverse_mass_;
  MomentMatrix<Dim> inverse_moment_;
};

template <int Dim> struct Hold {
  Point<Dim> arm, normal;
  const Wall<Dim>* wall;
  double least = 0;                      // m/s; the velocity along the normal that the wall asks for
  double impulse = 0;                    // kg m/s, so far; walls do not pull
  Point<Dim> drag = Point<Dim>::Zero();  // kg m/s, by friction along the wall, so far
};

/// Of a velocity, m/s.
template <int Dim> Point<Dim> over_wall(const Hold<Dim>& hold, const Point<Dim>& velocity) {
  const Point<Dim> relative = velocity - hold.wall->skin.velocity_along(hold.normal);
  return relative - hold.normal.dot(relative) * hold.normal;
}

template <int Dim>
std::vector<Hold<Dim>> holds_of(const Contact<Dim>& contact, const HeldBody<Dim>& held, double dt, double gravity) {
  std::vector<Hold<Dim>> holds;
  const RigidMotion<Dim>& m = held.motion;
  const double skin = contact.skin();
  const double way = dt * (m.velocity.norm() + m.spin.norm() * held.body.extent), reach = 2 * (way + skin);
  if (!contact.may_touch_fixed(m.start.centre, held.body.extent + reach)) return holds;
  for (const Point<Dim>& corner : held.corners) {
    const Point<Dim> x = m.start.to_world(corner), arm = x - m.start.centre;
    contact.visit_fixed_walls(x, reach, [&](const OverFace<Dim>& touch) {
      const double gap = touch.gap - skin, speed = touch.normal.dot(m.velocity + cross(m.spin, arm));
      Hold<Dim> hold{arm, touch.normal, touch.wall};
      hold.least = gap > 0 ? -gap / dt : std::min(-return_part * gap / dt, std::sqrt(-2 * gravity * gap));
      if (speed < hold.least) hold.least = std::max(hold.least, -touch.wall->response.restitution * speed);
      holds.push_back(hold);
    });
  }
  return holds;
}

template <int Dim> void push(Pushed<Dim>& body, Hold<Dim>& hold) {
  const double lack = hold.least - hold.normal.dot(body.velocity(hold.arm));
  const double impulse = std::max(lack / body.softness(hold.arm, hold.normal), -hold.impulse);
  hold.impulse += impulse;
  body.add(hold.arm, impulse * hold.normal);
}

/// The impulse that would stop it along the wall.
template <int Dim> Point<Dim> stopping(const Pushed<Dim>& body, const Hold<Dim>& hold) {
  const Point<Dim> velocity = over_wall(hold, body.velocity(hold.arm));
  const double speed = velocity.norm();
  if (!(speed > 0)) return Point<Dim>::Zero();
  return -velocity / body.softness(hold.arm, velocity / speed);
}

template <int Dim> void rub(Pushed<Dim>& body, Hold<Dim>& hold) {
  Point<Dim> drag = hold.drag + stopping(body, hold);
  const double most = hold.wall->response.grip->friction * hold.impulse;
  if (drag.norm() > most) drag *= most / drag.norm();
  body.add(hold.arm, drag - hold.drag);
  hold.drag = drag;
}

}  // namespace

template <int Dim> std::vector<Point<Dim>> corners_of(const Contact<Dim>& contact, std::size_t body) {
  std::vector<Point<Dim>> corners;
  for (const auto& facet : contact.surface_of(static_cast<std::int32_t>(body)).facets())
    corners.insert(corners.end(), facet.corner.begin(), facet.corner.end());
  const auto before = [](const Point<Dim>& a, const Point<Dim>& b) {
    return std::lexicographical_compare(a.data(), a.data() + Dim, b.data(), b.data() + Dim);
  };
  std::sort(corners.begin(), corners.end(), before);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

template <int Dim>
void hold_at_walls(const Contact<Dim>& contact, const HeldBody<Dim>& held, double dt, double gravity) {
  std::vector<Hold<Dim>> holds = holds_of(contact, held, dt, gravity);
  if (holds.empty()) return;
  Pushed<Dim> body(held);
  for (int k = 0; k < sweeps; ++k)
    for (Hold<Dim>& hold : holds) {
      push(body, hold);
      if (hold.wall->response.grip) rub(body, hold);
    }
  for (Hold<Dim>& hold : holds)
    if (hold.impulse > 0 && !hold.wall->response.grip)
      body.add(hold.arm, (1 - hold.wall->response.slip) * stopping(body, hold));
  for (Hold<Dim>& hold : holds) push(body, hold);
}

#define MOLTEN_INSTANTIATE(Dim)                                                  \
  template std::vector<Point<Dim>> corners_of(const Contact<Dim>&, std::size_t); \
  template void hold_at_walls(const Contact<Dim>&, const HeldBody<Dim>&, double, double);
MOLTEN_INSTANTIATE(2)
MOLTEN_INSTANTIATE(3)

}  // namespace molten
