#include "core/runge_kutta.h"

#include <cmath>

#include "core/mover.h"
#include "core/particle_pass.h"
#include "core/step.h"

namespace molten {

namespace {

/// What is integrated, or its rate, of one particle.
template <int Dim> struct Quantities {
  std::array<double, Dim> position{}, velocity{};
  double compression = 0, temperature = 0;

  void add(double factor, const Quantities& other) {
    for (int d = 0; d < Dim; ++d) position[d] += factor * other.position[d], velocity[d] += factor * other.velocity[d];
    compression += factor * other.compression;
    temperature += factor * other.temperature;
  }
};

/// The columns that hold them.
template <int Dim, class Real> struct Place {
  std::array<double*, Dim> position;
  std::array<Real*, Dim> velocity;
  Real* compression;
  double* temperature;  // null without heat

  Quantities<Dim> at(std::size_t slot) const {
    Quantities<Dim> q;
    for (int d = 0; d < Dim; ++d) q.position[d] = position[d][slot], q.velocity[d] = velocity[d][slot];
    q.compression = compression[slot];
    if (temperature) q.temperature = temperature[slot];
    return q;
  }
  void set(std::size_t slot, const Quantities<Dim>& q) const {
    for (int d = 0; d < Dim; ++d) {
      position[d][slot] = q.position[d];
      velocity[d][slot] = static_cast<Real>(q.velocity[d]);
    }
    compression[slot] = static_cast<Real>(q.compression);
    if (temperature) temperature[slot] = q.temperature;
  }
};

template <int Dim, class Real, class X, class V, class C, class T>
Place<Dim, Real> place(const Particles<Dim, Real>& p, X x, V v, C c, T t) {
  return {p[x].c, p[v].c, p[c][0], p[t][0]};
}

template <int Dim, class Real> class Stages {
 public:
  explicit Stages(State<Dim, Real>& s)
      : s_(s),
        p_(s.particles),
        tableau_(tableau_of(s.features.integrator)),
        now_(place(p_, position, velocity, compression, temperature)),
        base_(place(p_, base_position, base_velocity, base_compression, base_temperature)),
        slope_(place(p_, position_slope, velocity_slope, compression_slope, temperature_slope)),
        drift_(s),
        mover_(s) {}

  /// Takes one particle to a stage; returns the square of its way (m²).
  double go_to(int stage, std::size_t slot) const {
    if (p_.is_padding(slot)) return 0;
    const Quantities<Dim> before = now_.at(slot), rates = rates_at(slot);
    if (stage == 1) base_.set(slot, before);
    add_work(slot, tableau_.b[stage - 1]);
    if (slope_.position[0]) add_to_slope(stage - 1, slot, rates);
    Quantities<Dim> after = base_.at(slot);
    after.add(tableau_.a[stage] * s_.clock.dt, rates);
    now_.set(slot, after);
    return way2(before, after);
  }

  /// Ends the step of one particle; returns the square of its way from the last stage (m²).
  double finish(std::size_t slot) const {
    if (p_.is_padding(slot)) return 0;
    const Quantities<Dim> before = now_.at(slot);
    Quantities<Dim> rates, after = tableau_.stages > 1 ? base_.at(slot) : before;
    if (slope_.position[0]) rates = slope_.at(slot);
    const double last = tableau_.b[tableau_.stages - 1];
    rates.add(last, rates_at(slot));
    add_work(slot, last);
    Motion<Dim> m;
    for (int d = 0; d < Dim; ++d) {
      m.position[d] = after.position[d];
      m.rate[d] = rates.position[d];
    }
    after.add(s_.clock.dt, rates);
    for (int d = 0; d < Dim; ++d) m.velocity[d] = drift_.overwritten(after.velocity[d], d, slot);
    mover_.move(slot, m);
    for (int d = 0; d < Dim; ++d) after.position[d] = m.position[d], after.velocity[d] = m.velocity[d];
    now_.set(slot, after);
    return way2(before, after);
  }

 private:
  Quantities<Dim> rates_at(std::size_t slot) const {
    Quantities<Dim> r;
    for (int d = 0; d < Dim; ++d) {
      r.position[d] = drift_.rate(double(now_.velocity[d][slot]), d, slot);
      r.velocity[d] = acceleration_[d][slot];
    }
    r.compression = compression_rate_[slot];
    if (s_.features.heat) r.temperature = temperature_rate_[slot];
    return r;
  }

  void add_to_slope(int stage, std::size_t slot, const Quantities<Dim>& rates) const {
    Quantities<Dim> sum = stage == 0 ? Quantities<Dim>{} : slope_.at(slot);
    sum.add(tableau_.b[stage], rates);
    slope_.set(slot, sum);
  }

  /// Internal energy acts on nothing, so that it needs no value at the stages.
  void add_work(std::size_t slot, double weight) const {
    if (s_.features.internal_energy) internal_energy_[slot] += s_.clock.dt * weight * internal_energy_rate_[slot];
  }

  static double way2(const Quantities<Dim>& a, const Quantities<Dim>& b) {
    double sum = 0;
    for (int d = 0; d < Dim; ++d) sum += std::pow(a.position[d] - b.position[d], 2);
    return sum;
  }

  State<Dim, Real>& s_;
  Particles<Dim, Real>& p_;
  Tableau tableau_;
  Place<Dim, Real> now_, base_, slope_;
  Drift<Dim, Real> drift_;
  Mover<Dim, Real> mover_;
  Column<Acceleration, Dim, Real> acceleration_ = p_[acceleration];
  const Real* compression_rate_ = p_[compression_rate][0];
  const Real* temperature_rate_ = p_[temperature_rate][0];
  double* internal_energy_ = p_[internal_energy][0];
  const Real* internal_energy_rate_ = p_[internal_energy_rate][0];
};

/// way2_of(slot) for all particles, then what passes read of where they are.
template <int Dim, class Real, class F> void move_all(State<Dim, Real>& s, F&& way2_of) {
  const double way2 = reduce_slots(
      s.particles.slots(), 0.0, [&](std::size_t slot, double& largest) { largest = std::max(largest, way2_of(slot)); },
      [](double& a, double b) { a = std::max(a, b); });
  s.neighbours.moved(std::sqrt(way2));
  prepare(s);
}

}  // namespace

template <int Dim, class Real> void go_to_stage(State<Dim, Real>& s, int stage) {
  const Stages<Dim, Real> stages(s);
  move_all(s, [&](std::size_t slot) { return stages.go_to(stage, slot); });
}

template <int Dim, class Real> void finish_stages(State<Dim, Real>& s) {
  const Stages<Dim, Real> stages(s);
  move_all(s, [&](std::size_t slot) { return stages.finish(slot); });
}

#define MOLTEN_INSTANTIATE(Dim, Real)                      \
  template void go_to_stage(State<Dim, Real>&, int stage); \
  template void finish_stages(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
