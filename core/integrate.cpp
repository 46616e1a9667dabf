// The particle pass of a step: time integration and contact with walls.
//
// Leap-frog ([P] 6.4.3): v^{n+1/2} = v^{n-1/2} + dt a^n, x += dt v^{n+1/2}; v^{-1/2} = v^0 − ½ dt a^0 follows from a
// first half step. The passes need v and ρ at the full step, before the rates there are known: v^{n+1} ≈ v^{n+1/2} + ½
// dt a^n, and for ρ the rate extrapolated half a step. (With ρ'^n alone a sound wave grows by (ω dt)⁴/4 a step.)
// Symplectic Euler: v^{n+1} = v^n + dt a^n, x += dt v^{n+1}; the density follows the positions, so its rate is
// extrapolated to the velocity that moved them, ρ'^n + (1+β)(ρ'^n − ρ'^{n−1}) − β(ρ'^{n−1} − ρ'^{n−2}), which is stable
// for 0.6 ≤ β ≤ 1.
#include <cmath>
#include <span>
#include <vector>

#include "core/energy_bound.h"
#include "core/mover.h"
#include "core/particle_pass.h"
#include "core/runge_kutta.h"
#include "core/step.h"

namespace molten {

namespace {

template <int Dim, class Real> class Integrator {
 public:
  explicit Integrator(State<Dim, Real>& s, double previous_dt)
      : s_(s),
        p_(s.particles),
        dt_(s.clock.dt),
        kick_(s.features.integrator == IntegratorKind::leap_frog ? (previous_dt + dt_) / 2 : dt_),
        stretch_(previous_dt > 0 ? dt_ / previous_dt : 0),
        mover_(s) {}

  /// Moves one particle; returns the square of its displacement (m²). `kicks`: what bodies give to it is added.
  double advance(std::size_t slot, std::span<Kick<Dim>> kicks) const {
    if (ids_[slot] == padding_id) return 0;
    if (inlet_ && inlet_[slot] >= 0) return advance_in_vent(slot);
    Motion<Dim> motion = kicked(slot);
    const Point<Dim> before = motion.position;
    const bool bounced = mover_.move(slot, motion, kicks);
    store(slot, motion, bounced);
    advance_compression(slot);
    if (s_.features.internal_energy) internal_energy_[slot] += kick_ * internal_energy_rate_[slot];
    if (s_.features.heat) temperature_[slot] += dt_ * temperature_rate_[slot];
    if (s_.features.sleep) count_rest(slot);
    return (motion.position - before).squaredNorm();
  }

 private:
  /// How long motion, and heat, have been within the bounds of rest.
  void count_rest(std::size_t slot) const {
    const RestBounds& bounds = *s_.parameters.rest;
    const auto count = [this](Real& time, bool at_rest) { time = at_rest ? time + static_cast<Real>(dt_) : 0; };
    double v2 = 0;
    for (int d = 0; d < Dim; ++d) v2 += double(velocity_[d][slot]) * velocity_[d][slot];
    count(rest_time_[slot],
          v2 <= bounds.speed * bounds.speed && std::abs(compression_rate_[slot]) <= bounds.density_rate);
    if (s_.features.heat) count(heat_rest_time_[slot], std::abs(temperature_rate_[slot]) <= bounds.temperature_rate);
    if (rest_temperature_) rest_temperature_[slot] = static_cast<Real>(temperature_[slot]);
  }

  Motion<Dim> kicked(std::size_t slot) const {
    Motion<Dim> m;
    const auto& v = s_.features.integrator == IntegratorKind::leap_frog ? half_velocity_.c : velocity_.c;
    for (int d = 0; d < Dim; ++d) {
      m.position[d] = position_[d][slot];
      m.velocity[d] = v[d][slot] + kick_ * acceleration_[d][slot];
      m.rate[d] = m.velocity[d];
      if (s_.features.shifting) m.rate[d] += shift_velocity_[d][slot];
      if (!s_.features.xsph) continue;
      const double correction = s_.parameters.xsph * xsph_[d][slot];
      m.rate[d] += correction;
      if (s_.parameters.xsph_form == Xsph::Form::velocity) m.velocity[d] += correction;
    }
    return m;
  }

  /// The vent moves it like a piston; walls do not concern it, and its temperature stays what it entered with.
  double advance_in_vent(std::size_t slot) const {
    const Point<Dim> way = s_.vents.way(static_cast<std::size_t>(inlet_[slot]), s_.clock.time, dt_);
    Motion<Dim> m;
    for (int d = 0; d < Dim; ++d) m.position[d] = position_[d][slot] + way[d];
    m.velocity = way / dt_;
    store(slot, m, true);
    advance_compression(slot);
    if (s_.vents.has_left(static_cast<std::size_t>(inlet_[slot]), m.position)) inlet_[slot] = -1;
    return way.squaredNorm();
  }

  void store(std::size_t slot, const Motion<Dim>& m, bool bounced) const {
    const bool leap_frog = s_.features.integrator == IntegratorKind::leap_frog;
    for (int d = 0; d < Dim; ++d) {
      position_[d][slot] = m.position[d];
      if (leap_frog) half_velocity_[d][slot] = static_cast<Real>(m.velocity[d]);
      // The wall has already had its say on a particle that bounced.
      const double ahead = leap_frog && !bounced ? dt_ / 2 * acceleration_[d][slot] : 0;
      velocity_[d][slot] = static_cast<Real>(m.velocity[d] + ahead);
    }
  }

  void advance_compression(std::size_t slot) const {
    const double rate = compression_rate_[slot];
    const double rise = stretch_ * (rate - previous_rate_[slot]);  // of the rate, from this step to the next
    if (s_.features.integrator == IntegratorKind::leap_frog) {
      const double half = half_compression_[slot] + kick_ * rate;
      half_compression_[slot] = static_cast<Real>(half);
      compression_[slot] = static_cast<Real>(half + dt_ / 2 * (rate + rise));
    } else {
      constexpr double beta = 0.8;
      const double earlier_rise = s_.clock.step > 1 ? double(previous_rate_[slot]) - older_rate_[slot] : rise;
      compression_[slot] =
          static_cast<Real>(compression_[slot] + dt_ * (rate + (1 + beta) * rise - beta * earlier_rise));
      older_rate_[slot] = previous_rate_[slot];
    }
    previous_rate_[slot] = static_cast<Real>(rate);
  }

  State<Dim, Real>& s_;
  Particles<Dim, Real>& p_;
  double dt_, kick_;
  double stretch_;  // dt over the one before; 0 at the first step
  Mover<Dim, Real> mover_;
  const std::int64_t* ids_ = p_[id][0];
  Column<Position, Dim, double> position_ = p_[position];
  Column<Velocity, Dim, Real> velocity_ = p_[velocity];
  Column<HalfVelocity, Dim, Real> half_velocity_ = p_[half_velocity];
  Column<Acceleration, Dim, Real> acceleration_ = p_[acceleration];
  Column<XsphVelocity, Dim, Real> xsph_ = p_[xsph_velocity];
  Column<ShiftVelocity, Dim, Real> shift_velocity_ = p_[shift_velocity];
  Real* compression_ = p_[compression][0];
  Real* half_compression_ = p_[half_compression][0];
  Real* previous_rate_ = p_[previous_compression_rate][0];
  Real* older_rate_ = p_[older_compression_rate][0];
  const Real* compression_rate_ = p_[compression_rate][0];
  double* temperature_ = p_[temperature][0];
  const Real* temperature_rate_ = p_[temperature_rate][0];
  double* internal_energy_ = p_[internal_energy][0];
  const Real* internal_energy_rate_ = p_[internal_energy_rate][0];
  Real* rest_time_ = p_[rest_time][0];
  Real* heat_rest_time_ = p_[heat_rest_time][0];
  Real* rest_temperature_ = p_[rest_temperature][0];
  std::int64_t* inlet_ = p_[inlet][0];  // null without vents
};

/// What a step has done: the square of the largest displacement (m²), and what bodies have given to particles.
template <int Dim> struct Moved {
  double way2 = 0;
  std::vector<Kick<Dim>> kicks;  // by body

  void join(const Moved& m) {
    way2 = std::max(way2, m.way2);
    for (std::size_t k = 0; k < kicks.size(); ++k) {
      kicks[k].linear += m.kicks[k].linear;
      kicks[k].angular += m.kicks[k].angular;
    }
  }
};

/// What the pair passes read of one particle, from its state.
template <int Dim, class Real> class Preparation {
 public:
  explicit Preparation(State<Dim, Real>& s) : s_(s) {}

  void of(std::size_t slot) const {
    s_.neighbours.localise(s_.particles, slot);
    pressure_term_[slot] = static_cast<Real>(s_.parameters.eos.term(compression_[slot]));
    if (s_.features.heat)
      local_temperature_[slot] = static_cast<Real>(temperature_[slot] - s_.parameters.reference_temperature);
  }

 private:
  State<Dim, Real>& s_;
  Real* pressure_term_ = s_.particles[pressure_term][0];
  const Real* compression_ = s_.particles[compression][0];
  const double* temperature_ = s_.particles[temperature][0];
  Real* local_temperature_ = s_.particles[local_temperature][0];
};

}  // namespace

template <int Dim, class Real> void integrate_and_collide(State<Dim, Real>& s) {
  const auto scope = s.timer.scope(s.features.contact ? "integrate and collide" : "integrate");
  const IntegratorKind kind = s.features.integrator;
  if (kind == IntegratorKind::energy_bounded_euler) return integrate_energy_bounded(s);
  if (kind != IntegratorKind::leap_frog && kind != IntegratorKind::symplectic_euler) return finish_stages(s);
  if (s.features.bodies) s.bodies.begin_step(s.contact, s.clock.time, s.clock.dt, s.parameters.gravity);
  const Integrator<Dim, Real> integrator(s, s.clock.previous_dt);
  const Preparation<Dim, Real> preparation(s);
  const std::size_t first = s.neighbours.first_slot(Block::active);
  const Moved<Dim> moved = reduce_slots(
      s.particles.slots() - first, Moved<Dim>{0, std::vector<Kick<Dim>>(s.bodies.count())},
      [&](std::size_t k, Moved<Dim>& all) {
        all.way2 = std::max(all.way2, integrator.advance(first + k, all.kicks));
        preparation.of(first + k);
      },
      [](Moved<Dim>& a, const Moved<Dim>& b) { a.join(b); });
  s.neighbours.moved(std::sqrt(moved.way2));
  s.sleep.warm_time += s.clock.dt;
  s.sleep.travel +=
      (s.parameters.eos.sound_speed + std::max(std::sqrt(s.extremes.speed2), s.bodies.fastest())) * s.clock.dt;
  if (s.features.vents) s.vents.advance(s.clock.time, s.clock.dt);
  if (s.features.bodies) s.bodies.end_step(moved.kicks, s.parameters.particle_mass);
}

template <int Dim, class Real> void prepare(State<Dim, Real>& s, std::size_t first) {
  const Preparation<Dim, Real> preparation(s);
  for_each_slot(s.particles.slots() - first, [&](std::size_t k) { preparation.of(first + k); });
}

#define MOLTEN_INSTANTIATE(Dim, Real)                     \
  template void integrate_and_collide(State<Dim, Real>&); \
  template void prepare(State<Dim, Real>&, std::size_t);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
