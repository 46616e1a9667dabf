// A step that has nothing compiled in but what one scene needs: what the solver's own step is held against, to see that
// what a scene doesn't ask for costs nothing. Rates by a pair pass of exactly the terms given, with a finish that knows
// only their sums; the rest of the step is the solver's, or, without contact, an integrator that has no walls.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/naive.h"
#include "bench/terms.h"
#include "core/pair_pass.h"
#include "core/step.h"

namespace molten::bench {

template <int Dim, class Real> struct MinimalFinish {
  State<Dim, Real>& s;
  std::vector<Extremes>& extremes;

  auto for_chunk(std::size_t chunk) const {
    return [this, chunk](std::size_t slot, const auto& sums) {
      using Sums = std::decay_t<decltype(sums)>;
      const Particles<Dim, Real>& p = s.particles;
      if (p.is_padding(slot)) {
        for (int d = 0; d < Dim; ++d) p[acceleration][d][slot] = 0;
        p[compression_rate][0][slot] = 0;
        return;
      }
      Extremes& e = extremes[chunk];
      double a2 = 0, v2 = 0;
      for (int d = 0; d < Dim; ++d) {
        const Real total = sums[acceleration][d] + static_cast<Real>(s.parameters.gravity[d]);
        p[acceleration][d][slot] = total;
        a2 += double(total) * total;
        v2 += double(p[velocity][d][slot]) * p[velocity][d][slot];
      }
      p[compression_rate][0][slot] = sums[compression_rate] * static_cast<Real>(1 / s.parameters.eos.rest_density);
      e.acceleration2 = std::max(e.acceleration2, a2);
      e.speed2 = std::max(e.speed2, v2);
      e.finite &= a2 < 1e60 && v2 < 1e60;
      if constexpr (requires(Sums sum) { sum[temperature_rate]; }) {
        p[temperature_rate][0][slot] = sums[temperature_rate];
        e.finite &= std::abs(sums[temperature_rate]) < 1e30;
      }
      if constexpr (requires(Sums sum) { sum[xsph_velocity]; }) {
        double x2 = 0;
        for (int d = 0; d < Dim; ++d) {
          p[xsph_velocity][d][slot] = sums[xsph_velocity][d];
          x2 += double(sums[xsph_velocity][d]) * sums[xsph_velocity][d];
        }
        e.xsph2 = std::max(e.xsph2, x2);
      }
      if (const Real* eta = p[viscosity][0]) {
        const double density = s.parameters.eos.rest_density * (1 + p[compression][0][slot]);
        e.kinematic_viscosity = std::max(e.kinematic_viscosity, eta[slot] / density);
      }
    };
  }
};

template <int Dim, class Real, class... Terms> void minimal_rates(State<Dim, Real>& s, const Terms&... terms) {
  const auto scope = s.timer.scope(s.features.heat ? "forces and heat" : "forces");
  const Parameters<Dim>& p = s.parameters;
  std::vector<Extremes> extremes(s.neighbours.chunks().size());
  const MinimalFinish<Dim, Real> finish{s, extremes};
  const Kernel<KernelChoice::wendland_c2, Real> kernel(p.kernel, Dim, p.smoothing_length, p.particle_mass);
  pair_pass<native_lanes<Real>>(s.neighbours, s.particles, kernel, finish, terms...);
  s.extremes = {};
  for (const Extremes& e : extremes) {
    s.extremes.acceleration2 = std::max(s.extremes.acceleration2, e.acceleration2);
    s.extremes.speed2 = std::max(s.extremes.speed2, e.speed2);
    s.extremes.xsph2 = std::max(s.extremes.xsph2, e.xsph2);
    s.extremes.kinematic_viscosity = std::max(s.extremes.kinematic_viscosity, e.kinematic_viscosity);
    s.extremes.finite &= e.finite;
  }
  if (s.features.laminar) s.extremes.kinematic_viscosity = p.viscosity / p.eos.rest_density;
}

/// Leap-frog of position, velocity and compression (core/integrate.cpp's head), nothing else.
template <int Dim, class Real> void minimal_integrate(State<Dim, Real>& s) {
  const auto scope = s.timer.scope("integrate");
  Particles<Dim, Real>& p = s.particles;
  const double dt = s.clock.dt, previous_dt = s.clock.previous_dt, kick = (previous_dt + dt) / 2;
  const double stretch = previous_dt > 0 ? dt / previous_dt : 0;
  const auto x = p[position];
  const auto v = p[velocity], half_v = p[half_velocity];
  const auto a = p[acceleration];
  Real *half_c = p[half_compression][0], *previous = p[previous_compression_rate][0], *c = p[compression][0];
  const auto advance = [&](std::size_t slot, double& largest) {
    double way2 = 0;
    if (!p.is_padding(slot)) {
      for (int d = 0; d < Dim; ++d) {
        const double w = half_v[d][slot] + kick * a[d][slot];
        half_v[d][slot] = static_cast<Real>(w);
        v[d][slot] = static_cast<Real>(w + dt / 2 * a[d][slot]);
        x[d][slot] += dt * w;
        way2 += dt * w * dt * w;
      }
      const double rate = p[compression_rate][0][slot], rise = stretch * (rate - previous[slot]);
      const double half = half_c[slot] + kick * rate;
      half_c[slot] = static_cast<Real>(half);
      c[slot] = static_cast<Real>(half + dt / 2 * (rate + rise));
      previous[slot] = static_cast<Real>(rate);
    }
    largest = std::max(largest, way2);
    s.neighbours.localise(p, slot);
    p[pressure_term][0][slot] = static_cast<Real>(s.parameters.eos.term(c[slot]));
  };
  s.neighbours.moved(std::sqrt(reduce_slots(p.slots(), 0.0, advance, [](double& m, double n) { m = std::max(m, n); })));
}

/// One step; `own_integrator`: the one above instead of the solver's.
template <int Dim, class Real, class... Terms>
void minimal_step(State<Dim, Real>& s, bool own_integrator, const Terms&... terms) {
  if (s.neighbours.is_due()) sort_and_list(s);
  if (s.features.stress) find_viscosity(s);
  minimal_rates(s, terms...);
  require_sane(s);
  choose_time_step(s);
  if (own_integrator)
    minimal_integrate(s);
  else
    integrate_and_collide(s);
  s.clock.time += s.clock.dt;
  ++s.clock.step;
}

}  // namespace molten::bench
