// The particle pass of a step: time integration and contact with walls.
//
// Leap-frog ([P] 6.4.3): v^{n+1/2} = v^{n-1/2} + dt a^n, x += dt v^{n+1/2}; v^{-1/2} = v^0 − ½ dt a^0 follows from a
// first half step. The passes need v and ρ at the full step, before the rates there are known: v^{n+1} ≈ v^{n+1/2} + ½
// dt a^n, and for ρ the rate extrapolated half a step. (With ρ'^n alone a sound wave grows by (ω dt)⁴/4 a step.)
// Symplectic Euler: v^{n+1} = v^n + dt a^n, x += dt v^{n+1}; the density follows the positions, so its rate is
// extrapolated to the velocity that moved them, ρ'^n + (1+β)(ρ'^n − ρ'^{n−1}) − β(ρ'^{n−1} − ρ'^{n−2}), which is stable
// for 0.6 ≤ β ≤ 1.
#include <algorithm>
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

/// Does a step move nothing but fluid particles with their velocities, and change nothing but those and densities?
template <int Dim, class Real> bool only_flows(const State<Dim, Real>& s) {
  const Features& f = s.features;
  return !(f.heat || f.internal_energy || f.sleep || f.xsph || s.particles.has(shift_velocity) ||
           s.particles.has(inlet) || s.particles.has(held));
}

/// By leap-frog or symplectic Euler. Four particles at once: the pass is bound by memory, and one by one by
/// instructions. What is padding has no rates, so it stays at zero. `plain`: for a state that only flows.
template <bool leap_frog, bool plain, int Dim, class Real> class Integrator {
  using Wide = ClusterLanes;

 public:
  explicit Integrator(State<Dim, Real>& s)
      : s_(s),
        p_(s.particles),
        dt_(s.clock.dt),
        kick_(kick_time(s)),
        stretch_(s.clock.previous_dt > 0 ? dt_ / s.clock.previous_dt : 0),
        drift_(s),
        mover_(s) {}

  /// Moves the particles of a cluster.
  void advance(std::size_t cluster, Moved<Dim>& all) const {
    const std::size_t slot = cluster * cluster_size;
    if ((!plain && driven_) || mover_.may_collide(cluster))
      guide(cluster, all);
    else
      let_go(slot, all);
    advance_compression(slot);
    if constexpr (plain) return;
    if (s_.features.internal_energy) add(internal_energy_ + slot, kick_, internal_energy_rate_ + slot);
    if (s_.features.heat) add(temperature_ + slot, dt_, temperature_rate_ + slot);
    if (s_.features.sleep) count_rest(slot);
  }

 private:
  static Wide read(const Real* from) { return load_double<cluster_size>(from); }
  static void write(const Wide& value, Real* to) { store_rounded(value, to); }
  static void add(double* quantity, double time, const Real* rate) {
    store(load<cluster_size>(quantity) + Wide(time) * read(rate), quantity);
  }

  /// How long motion, and heat, have been within the bounds of rest.
  void count_rest(std::size_t first) const {
    for (std::size_t slot = first; slot < first + cluster_size; ++slot)
      if (!p_.is_padding(slot) && !(inlet_ && inlet_[slot] >= 0)) count_rest_of(slot);
  }
  void count_rest_of(std::size_t slot) const {
    const RestBounds& bounds = *s_.parameters.rest;
    const auto count = [this](Real& time, bool at_rest) { time = at_rest ? time + static_cast<Real>(dt_) : 0; };
    double v2 = 0;
    for (int d = 0; d < Dim; ++d) v2 += double(velocity_[d][slot]) * velocity_[d][slot];
    count(rest_time_[slot],
          v2 <= bounds.speed * bounds.speed && std::abs(compression_rate_[slot]) <= bounds.density_rate);
    if (s_.features.heat) count(heat_rest_time_[slot], std::abs(temperature_rate_[slot]) <= bounds.temperature_rate);
    if (rest_temperature_) rest_temperature_[slot] = static_cast<Real>(temperature_[slot]);
  }

  /// With nothing in the way. Axis by axis: it all stays in registers.
  void let_go(std::size_t slot, Moved<Dim>& all) const {
    Wide way2(0.0);
    for (int d = 0; d < Dim; ++d) {
      const Kicked to = kicked(d, slot);
      const Wide way = Wide(dt_) * to.rate;
      store(load<cluster_size>(position_[d] + slot) + way, position_[d] + slot);
      keep_velocity(d, slot, to.velocity, Wide(dt_ / 2));
      way2 += way * way;
    }
    raise(all.way2, way2);
  }

  /// Where walls, vents and bodies have a say.
  [[gnu::noinline]] void guide(std::size_t cluster, Moved<Dim>& all) const {
    const std::size_t slot = cluster * cluster_size;
    ClusterMotion<Dim> motion;
    for (int d = 0; d < Dim; ++d) {
      const Kicked to = kicked(d, slot);
      motion.position[d] = load<cluster_size>(position_[d] + slot);
      motion.velocity[d] = to.velocity;
      motion.rate[d] = to.rate;
    }
    const Vec<Dim, Wide> before = motion.position;
    Wide bounced = mover_.move_cluster(cluster, motion, all.kicks);
    if (inlet_) push(slot, before, motion, bounced);
    if (held_ && s_.features.bodies) carry(slot, before, motion);
    // The wall has already had its say on a particle that bounced.
    const Wide ahead = Wide(dt_ / 2) * (Wide(1.0) - bounced);
    for (int d = 0; d < Dim; ++d) {
      store(motion.position[d], position_[d] + slot);
      keep_velocity(d, slot, motion.velocity[d], ahead);
    }
    const Vec<Dim, Wide> way = motion.position - before;
    raise(all.way2, dot(way, way));
  }

  struct Kicked {
    Wide velocity, rate;  // m/s; after the kick, and that of the place
  };
  Kicked kicked(int d, std::size_t slot) const {
    const auto& v = leap_frog ? half_velocity_.c : velocity_.c;
    const Wide velocity = read(v[d] + slot) + Wide(kick_) * read(acceleration_[d] + slot);
    if constexpr (plain) return {velocity, velocity};
    return {drift_.overwritten(velocity, d, slot), drift_.rate(velocity, d, slot)};
  }

  /// By leap-frog the velocity at the full step is `ahead` (s) of the half step's.
  void keep_velocity(int d, std::size_t slot, const Wide& value, const Wide& ahead) const {
    if constexpr (leap_frog) {
      write(value, half_velocity_[d] + slot);
      write(value + ahead * read(acceleration_[d] + slot), velocity_[d] + slot);
    } else {
      write(value, velocity_[d] + slot);
    }
  }

  /// A vent moves what is in it like a piston; walls do not concern it, and its temperature stays what it entered with.
  void push(std::size_t first, const Vec<Dim, Wide>& before, ClusterMotion<Dim>& m, Wide& bounced) const {
    for (int n = 0; n < cluster_size; ++n) {
      const std::size_t slot = first + n;
      if (inlet_[slot] < 0) continue;
      const auto vent = static_cast<std::size_t>(inlet_[slot]);
      const Point<Dim> way = s_.vents.way(vent, s_.clock.time, dt_);
      Point<Dim> after;
      for (int d = 0; d < Dim; ++d) {
        after[d] = lane(before[d], n) + way[d];
        set_lane(m.position[d], n, after[d]);
        set_lane(m.velocity[d], n, way[d] / dt_);
      }
      set_lane(bounced, n, 1.0);
      if (temperature_rate_) temperature_rate_[slot] = 0;
      if (s_.vents.has_left(vent, after)) inlet_[slot] = -1;
    }
  }

  /// Boundary particles of a wall that moves go with it.
  void carry(std::size_t first, const Vec<Dim, Wide>& before, ClusterMotion<Dim>& m) const {
    for (int n = 0; n < cluster_size; ++n) {
      if (held_[first + n] < 2) continue;
      const RigidMotion<Dim>& motion = s_.bodies.motion(static_cast<std::size_t>(held_[first + n]) - 2);
      Point<Dim> at;
      for (int d = 0; d < Dim; ++d) at[d] = lane(before[d], n);
      const Point<Dim> after = motion.after(dt_).to_world(motion.start.to_body(at));
      for (int d = 0; d < Dim; ++d) {
        set_lane(m.position[d], n, after[d]);
        set_lane(m.velocity[d], n, (after[d] - at[d]) / dt_);
      }
    }
  }

  void advance_compression(std::size_t slot) const {
    const Wide rate = read(compression_rate_ + slot), previous = read(previous_rate_ + slot), dt(dt_);
    const Wide rise = Wide(stretch_) * (rate - previous);  // of the rate, from this step to the next
    if constexpr (leap_frog) {
      const Wide half = read(half_compression_ + slot) + Wide(kick_) * rate;
      write(half, half_compression_ + slot);
      write(half + Wide(dt_ / 2) * (rate + rise), compression_ + slot);
    } else {
      const Wide beta(0.8);
      const Wide earlier_rise = s_.clock.step > 1 ? previous - read(older_rate_ + slot) : rise;
      write(read(compression_ + slot) + dt * (rate + (Wide(1.0) + beta) * rise - beta * earlier_rise),
            compression_ + slot);
      write(previous, older_rate_ + slot);
    }
    write(rate, previous_rate_ + slot);
  }

  State<Dim, Real>& s_;
  Particles<Dim, Real>& p_;
  double dt_, kick_;
  double stretch_;  // dt over the one before; 0 at the first step
  Drift<Dim, Real> drift_;
  Mover<Dim, Real> mover_;
  Column<Position, Dim, double> position_ = p_[position];
  Column<Velocity, Dim, Real> velocity_ = p_[velocity];
  Column<HalfVelocity, Dim, Real> half_velocity_ = p_[half_velocity];
  Column<Acceleration, Dim, Real> acceleration_ = p_[acceleration];
  Real* compression_ = p_[compression][0];
  Real* half_compression_ = p_[half_compression][0];
  Real* previous_rate_ = p_[previous_compression_rate][0];
  Real* older_rate_ = p_[older_compression_rate][0];
  const Real* compression_rate_ = p_[compression_rate][0];
  double* temperature_ = p_[temperature][0];
  Real* temperature_rate_ = p_[temperature_rate][0];
  double* internal_energy_ = p_[internal_energy][0];
  const Real* internal_energy_rate_ = p_[internal_energy_rate][0];
  Real* rest_time_ = p_[rest_time][0];
  Real* heat_rest_time_ = p_[heat_rest_time][0];
  Real* rest_temperature_ = p_[rest_temperature][0];
  std::int64_t* inlet_ = p_[inlet][0];  // null without vents
  const Real* held_ = p_[held][0];      // null without boundary particles
  bool driven_ = inlet_ || held_;
};

/// What the pair passes read of a cluster's particles, from their state. `plain`: of one that only flows.
template <bool plain, int Dim, class Real> class Preparation {
 public:
  explicit Preparation(State<Dim, Real>& s) : s_(s) {}

  void of(std::size_t cluster) const {
    const std::size_t slot = cluster * cluster_size;
    s_.neighbours.localise(s_.particles, cluster);
    if (!plain && held_) press(slot);
    store_rounded(s_.parameters.eos.term(load_double<cluster_size>(compression_ + slot)), pressure_term_ + slot);
    if constexpr (plain) return;
    if (s_.features.heat)
      store_rounded(load<cluster_size>(temperature_ + slot) - ClusterLanes(s_.parameters.reference_temperature),
                    local_temperature_ + slot);
  }

 private:
  /// Boundary particles do not pull.
  void press(std::size_t first) const {
    for (std::size_t slot = first; slot < first + cluster_size; ++slot) {
      if (held_[slot] == 0) continue;
      compression_[slot] = std::max(compression_[slot], Real(0));
      if (half_compression_) half_compression_[slot] = std::max(half_compression_[slot], Real(0));
    }
  }

  State<Dim, Real>& s_;
  Real* pressure_term_ = s_.particles[pressure_term][0];
  Real* compression_ = s_.particles[compression][0];
  Real* half_compression_ = s_.particles[half_compression][0];
  const Real* held_ = s_.particles[held][0];  // null without boundary particles
  const double* temperature_ = s_.particles[temperature][0];
  Real* local_temperature_ = s_.particles[local_temperature][0];
};

/// Moves all active clusters and prepares them for the next step's passes.
template <bool leap_frog, bool plain, int Dim, class Real> Moved<Dim> move_all(State<Dim, Real>& s) {
  const Integrator<leap_frog, plain, Dim, Real> integrator(s);
  const Preparation<plain, Dim, Real> preparation(s);
  const std::size_t first = s.neighbours.first_slot(Block::active) / cluster_size;
  return reduce_slots(
      s.neighbours.clusters() - first, Moved<Dim>{0, std::vector<Kick<Dim>>(s.bodies.count())},
      [&](std::size_t k, Moved<Dim>& all) {
        integrator.advance(first + k, all);
        preparation.of(first + k);
      },
      [](Moved<Dim>& a, const Moved<Dim>& b) { a.join(b); }, block_size / cluster_size);
}

}  // namespace

template <int Dim, class Real> double kick_time(const State<Dim, Real>& s) {
  const double dt = s.clock.dt;
  return s.features.integrator == IntegratorKind::leap_frog ? (s.clock.previous_dt + dt) / 2 : dt;
}

template <int Dim, class Real> void integrate_and_collide(State<Dim, Real>& s) {
  const auto scope = s.timer.scope(s.features.contact ? "integrate and collide" : "integrate");
  const IntegratorKind kind = s.features.integrator;
  if (kind == IntegratorKind::energy_bounded_euler) return integrate_energy_bounded(s);
  if (kind != IntegratorKind::leap_frog && kind != IntegratorKind::symplectic_euler) return finish_stages(s);
  if (s.features.bodies) {
    s.bodies.answer(kick_time(s), s.parameters.particle_mass);
    s.bodies.begin_step(s.contact, s.clock.time, s.clock.dt, s.parameters.gravity);
  }
  const Moved<Dim> moved = kind != IntegratorKind::leap_frog ? move_all<false, false>(s)
                           : only_flows(s)                   ? move_all<true, true>(s)
                                                             : move_all<true, false>(s);
  s.neighbours.moved(std::sqrt(moved.way2));
  s.sleep.warm_time += s.clock.dt;
  s.sleep.travel +=
      (s.parameters.eos.sound_speed + std::max(std::sqrt(s.extremes.speed2), s.bodies.fastest())) * s.clock.dt;
  if (s.features.vents) s.vents.advance(s.clock.time, s.clock.dt);
  if (s.features.bodies) s.bodies.end_step(moved.kicks, s.parameters.particle_mass);
}

template <int Dim, class Real> void prepare(State<Dim, Real>& s, std::size_t first_slot) {
  const Preparation<false, Dim, Real> preparation(s);
  const std::size_t first = first_slot / cluster_size;
  for_each_slot(s.neighbours.clusters() - first, [&](std::size_t k) { preparation.of(first + k); });
}

#define MOLTEN_INSTANTIATE(Dim, Real)                     \
  template double kick_time(const State<Dim, Real>&);     \
  template void integrate_and_collide(State<Dim, Real>&); \
  template void prepare(State<Dim, Real>&, std::size_t);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
