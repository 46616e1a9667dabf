// A step that has nothing compiled in but what one scene needs: what the solver's own step is held against, to see that
// what a scene doesn't ask for costs nothing. Rates by a pair pass of exactly the terms given; the rest of the step is
// the solver's, or, without contact, an integrator that has no walls.
#pragma once

#include <algorithm>
#include <cmath>

#include "bench/naive.h"
#include "bench/terms.h"
#include "core/rates_pass.h"
#include "core/step.h"

namespace molten::bench {

template <int Dim, class Real, class... Terms> void minimal_rates(State<Dim, Real>& s, const Terms&... terms) {
  const auto scope = s.timer.scope(s.features.heat ? "forces and heat" : "forces");
  run_rates_pass(s, terms...);
}

/// Leap-frog of position, velocity and compression (core/integrate.cpp's head), nothing else.
template <int Dim, class Real> void minimal_integrate(State<Dim, Real>& s) {
  const auto scope = s.timer.scope("integrate");
  Particles<Dim, Real>& p = s.particles;
  const double dt = s.clock.dt, previous_dt = s.clock.previous_dt, kick = (previous_dt + dt) / 2;
  const double stretch = previous_dt > 0 ? dt / previous_dt : 0;
  const auto x = p[position];
  const auto v = p[velocity];
  const auto half_v = p[half_velocity];
  const auto a = p[acceleration];
  Real *half_c = p[half_compression][0], *previous = p[previous_compression_rate][0], *c = p[compression][0];
  using Wide = Lanes<double, cluster_size>;
  const auto read = [](const Real* from) { return load_double<cluster_size>(from); };
  const auto advance = [&](std::size_t cluster, double& furthest) {
    const std::size_t slot = cluster * cluster_size;
    Wide way2(0.0);
    for (int d = 0; d < Dim; ++d) {
      const Wide rate = read(a[d] + slot), w = read(half_v[d] + slot) + Wide(kick) * rate;
      store_rounded(w, half_v[d] + slot);
      store_rounded(w + Wide(dt / 2) * rate, v[d] + slot);
      store(load<cluster_size>(x[d] + slot) + Wide(dt) * w, x[d] + slot);
      way2 += Wide(dt * dt) * w * w;
    }
    const Wide rate = read(p[compression_rate][0] + slot), rise = Wide(stretch) * (rate - read(previous + slot));
    const Wide half = read(half_c + slot) + Wide(kick) * rate;
    store_rounded(half, half_c + slot);
    store_rounded(half + Wide(dt / 2) * (rate + rise), c + slot);
    store_rounded(rate, previous + slot);
    raise(furthest, way2);
    s.neighbours.localise(p, cluster);
    store_rounded(s.parameters.eos.term(read(c + slot)), p[pressure_term][0] + slot);
  };
  s.neighbours.moved(std::sqrt(reduce_slots(
      s.neighbours.clusters(), 0.0, advance, [](double& m, double n) { m = std::max(m, n); },
      block_size / cluster_size)));
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
