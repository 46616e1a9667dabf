#include "core/bodies.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/body_walls.h"

namespace molten {

namespace {

/// A turn that many products have left slightly askew.
Turn<2> upright(const Turn<2>& turn) { return turn_by(angle_of(turn)); }
Turn<3> upright(const Turn<3>& turn) { return Eigen::Quaterniond(turn).normalized().toRotationMatrix(); }

Spin<2> spin_from(const Inertia<2>& inertia, const Turn<2>&, const Spin<2>& momentum) {
  return momentum / inertia.moment(0, 0);
}
Spin<3> spin_from(const Inertia<3>& inertia, const Turn<3>& turn, const Spin<3>& momentum) {
  return turn * inertia.moment.ldlt().solve(turn.transpose() * momentum);
}

}  // namespace

template <int Dim> Pose<Dim> PrescribedMotion<Dim>::at(const Point<Dim>& centre, double time) const {
  if (key_frames.empty()) return {centre + time * velocity, turn_by(Spin<Dim>(time * spin))};
  const auto after = std::find_if(key_frames.begin(), key_frames.end(), [&](const auto& k) { return k.time > time; });
  if (after == key_frames.begin()) return {centre + after->shift, turn_by(after->angle)};
  const KeyFrame& a = *(after - 1);
  if (after == key_frames.end()) return {centre + a.shift, turn_by(a.angle)};
  const double u = (time - a.time) / (after->time - a.time);
  return {centre + (1 - u) * a.shift + u * after->shift, turn_by(Spin<Dim>((1 - u) * a.angle + u * after->angle))};
}

template <int Dim> Bodies<Dim>::Bodies(std::vector<RigidBody<Dim>> bodies) : bodies_(std::move(bodies)) {
  for (const RigidBody<Dim>& b : bodies_) {
    const Pose<Dim> pose = b.inertia ? Pose<Dim>{b.centre, Turn<Dim>::Identity()} : b.prescribed.at(b.centre, 0);
    motion_.push_back({pose, b.prescribed.velocity, b.prescribed.spin});
    angular_momentum_.push_back(b.inertia ? Spin<Dim>(b.inertia->moment * b.prescribed.spin) : Spin<Dim>::Zero());
  }
}

template <int Dim> Spin<Dim> Bodies<Dim>::spin_of(std::size_t k) const {
  return spin_from(*bodies_[k].inertia, motion_[k].start.turn, angular_momentum_[k]);
}

template <int Dim> void Bodies<Dim>::place(Contact<Dim>& contact) {
  for (std::size_t k = 0; k < count(); ++k)
    contact.set_motion(k, {motion_[k].start, Point<Dim>::Zero(), Spin<Dim>::Zero()});
  way_ = 0;
}

template <int Dim>
void Bodies<Dim>::begin_step(Contact<Dim>& contact, double time, double dt, const std::array<double, Dim>& gravity) {
  time_ = time;
  dt_ = dt;
  for (std::size_t k = 0; k < count(); ++k) {
    RigidMotion<Dim>& m = motion_[k];
    if (bodies_[k].inertia) {
      for (int d = 0; d < Dim; ++d) m.velocity[d] += dt * gravity[d];
      m.spin = spin_of(k);
      hold(contact, k, Eigen::Map<const Point<Dim>>(gravity.data()).norm());
    } else {
      const RigidBody<Dim>& b = bodies_[k];
      const Pose<Dim> end = b.prescribed.at(b.centre, time + dt);
      m.start = b.prescribed.at(b.centre, time);
      m.velocity = (end.centre - m.start.centre) / dt;
      m.spin = angle_of(Turn<Dim>(end.turn * m.start.turn.transpose())) / dt;
    }
    contact.set_motion(k, m);
  }
  way_ += fastest() * dt;
}

/// By walls, in the step that has begun.
template <int Dim> void Bodies<Dim>::hold(const Contact<Dim>& contact, std::size_t k, double gravity) {
  corners_.resize(count());
  if (corners_[k].empty()) corners_[k] = corners_of(contact, k);
  hold_at_walls<Dim>(contact, {bodies_[k], corners_[k], motion_[k], angular_momentum_[k]}, dt_, gravity);
}

template <int Dim> void Bodies<Dim>::receive(std::span<const Kick<Dim>> sets) {
  given_.assign(count(), Kick<Dim>{});
  for (std::size_t k = 0; k < sets.size(); ++k) {
    given_[k % count()].linear += sets[k].linear;
    given_[k % count()].angular += sets[k].angular;
  }
}

template <int Dim> void Bodies<Dim>::answer(double time, double particle_mass) {
  for (std::size_t k = 0; k < given_.size(); ++k) {
    if (!bodies_[k].inertia) continue;
    motion_[k].velocity -= time * particle_mass / bodies_[k].inertia->mass * given_[k].linear;
    angular_momentum_[k] -= time * particle_mass * given_[k].angular;
  }
}

template <int Dim> void Bodies<Dim>::end_step(std::span<const Kick<Dim>> kicks, double particle_mass) {
  for (std::size_t k = 0; k < count(); ++k) {
    RigidMotion<Dim>& m = motion_[k];
    if (!bodies_[k].inertia) {
      m.start = bodies_[k].prescribed.at(bodies_[k].centre, time_ + dt_);
      continue;
    }
    m.start = m.after(dt_);
    m.start.turn = upright(m.start.turn);
    m.velocity -= particle_mass / bodies_[k].inertia->mass * kicks[k].linear;
    angular_momentum_[k] -= particle_mass * kicks[k].angular;
    m.spin = spin_of(k);
  }
}

template <int Dim> double Bodies<Dim>::speed(std::size_t k) const {
  const double turning = motion_[k].spin.isZero(0) ? 0 : motion_[k].spin.norm() * bodies_[k].extent;
  return motion_[k].velocity.norm() + turning;
}

template <int Dim> double Bodies<Dim>::fastest() const {
  double fastest = 0;
  for (std::size_t k = 0; k < count(); ++k) fastest = std::max(fastest, speed(k));
  return fastest;
}

template <int Dim> void Bodies<Dim>::archive(Archive& a) {
  for (std::size_t k = 0; k < count(); ++k) {
    const std::string name = "bodies/" + std::to_string(k) + "/";
    const auto numbers = [&](const std::string& what, double* data, std::size_t size) {
      a.array(name + what, NumberType::f64, data, size);
    };
    RigidMotion<Dim>& m = motion_[k];
    numbers("centre", m.start.centre.data(), Dim);
    numbers("turn", m.start.turn.data(), Dim * Dim);
    numbers("velocity", m.velocity.data(), Dim);
    numbers("spin", m.spin.data(), static_cast<std::size_t>(m.spin.size()));
    numbers("angular_momentum", angular_momentum_[k].data(), static_cast<std::size_t>(m.spin.size()));
  }
  if (count() > 0) a.value("bodies/way", way_);
}

template struct PrescribedMotion<2>;
template struct PrescribedMotion<3>;
template class Bodies<2>;
template class Bodies<3>;

}  // namespace molten
