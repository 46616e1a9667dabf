// What the rates passes share: what becomes of the sums.
#pragma once

#include <cmath>
#include <vector>

#include "core/boundary/wall_terms.h"
#include "core/pair_pass.h"
#include "core/physics/artificial_viscosity.h"
#include "core/physics/heat_conduction.h"
#include "core/step.h"

namespace molten {

template <int Dim, class Real> Vec<Dim, Real> in_real(const std::array<double, Dim>& v) {
  Vec<Dim, Real> r;
  for (int d = 0; d < Dim; ++d) r[d] = static_cast<Real>(v[d]);
  return r;
}

/// Sums → columns of rates; keeps the extremes of its chunk.
template <int Dim, class Real> struct RatesFinish {
  State<Dim, Real>& s;
  std::vector<Extremes>& extremes;

  struct OfChunk {
    const State<Dim, Real>& s;
    Extremes& extremes;
    const Particles<Dim, Real>& p;
    const std::int64_t* ids = p[id][0];
    Column<Acceleration, Dim, Real> a = p[acceleration];
    Column<Velocity, Dim, Real> v = p[velocity];
    Column<XsphVelocity, Dim, Real> x = p[xsph_velocity];
    Real* compression_rates = p[compression_rate][0];
    Real* temperature_rates = p[temperature_rate][0];
    Real* energy_rates = p[internal_energy_rate][0];
    const Real* viscosities = p[viscosity][0];
    const Real* compressions = p[compression][0];
    const Real* held_by = p[held][0];  // null without boundary particles
    bool boundary_waits = held_by && (s.clock.step + 1) % s.parameters.boundary_every != 0;
    Vec<Dim, Real> gravity = in_real<Dim, Real>(s.parameters.gravity);
    Real inverse_rest_density = s.features.density_sum ? Real(0) : static_cast<Real>(1 / s.parameters.eos.rest_density);

    template <class Sums> void operator()(std::size_t slot, const Sums& sums) {
      using L = std::decay_t<decltype(sums[compression_rate])>;
      constexpr int I = sizeof(L) / sizeof(Real);
      L alive(Real(1)), a2(Real(0)), v2(Real(0));
      for (int n = 0; n < I; ++n) set_lane(alive, n, ids[slot + n] == padding_id ? Real(0) : Real(1));
      // Boundary particles keep their places, and their density waits for its turn.
      const L changing = boundary_waits ? free_lanes(slot, alive) : alive;
      alive = free_lanes(slot, alive);
      for (int d = 0; d < Dim; ++d) {
        const L total = alive * (sums[acceleration][d] + L(gravity[d]));
        const L speed = alive * load<I>(v[d] + slot);
        store(total, a[d] + slot);
        a2 += total * total;
        v2 += speed * speed;
      }
      store(changing * L(inverse_rest_density) * sums[compression_rate], compression_rates + slot);
      raise(extremes.acceleration2, a2);
      raise(extremes.speed2, v2);
      if constexpr (requires { sums[temperature_rate]; })
        if (s.features.heat) keep_heat(slot, L(alive * sums[temperature_rate]));
      if constexpr (requires { sums[internal_energy_rate]; })
        if (energy_rates) store(L(alive * sums[internal_energy_rate]), energy_rates + slot);
      if constexpr (requires { sums[xsph_velocity]; })
        if (s.features.xsph) keep_xsph(slot, alive * sums[xsph_velocity]);
      if (s.features.stress) {
        const L density = L(static_cast<Real>(s.parameters.eos.rest_density)) * (L(1) + load<I>(compressions + slot));
        raise(extremes.kinematic_viscosity, alive * load<I>(viscosities + slot) * reciprocal(density));
      }
    }

    /// Those that are not held.
    template <class L> L free_lanes(std::size_t slot, L lanes) const {
      if (!held_by) return lanes;
      for (int n = 0; n < static_cast<int>(sizeof(L) / sizeof(Real)); ++n)
        if (held_by[slot + n] > 0) set_lane(lanes, n, Real(0));
      return lanes;
    }

    template <class L> void keep_heat(std::size_t slot, const L& rate) {
      store(rate, temperature_rates + slot);
      double magnitude = 0;
      raise(magnitude, max(rate, -rate));
      extremes.finite &= magnitude < 1e30;
    }

    template <class L> void keep_xsph(std::size_t slot, const Vec<Dim, L>& correction) {
      for (int d = 0; d < Dim; ++d) store(correction[d], x[d] + slot);
      raise(extremes.xsph2, dot(correction, correction));
    }
  };
  OfChunk for_chunk(std::size_t k) const { return {s, extremes[k], s.particles}; }
};

inline Extremes joined(const std::vector<Extremes>& parts) {
  Extremes all;
  for (const Extremes& e : parts) {
    all.acceleration2 = std::max(all.acceleration2, e.acceleration2);
    all.speed2 = std::max(all.speed2, e.speed2);
    all.xsph2 = std::max(all.xsph2, e.xsph2);
    all.kinematic_viscosity = std::max(all.kinematic_viscosity, e.kinematic_viscosity);
    all.finite = all.finite && e.finite;
  }
  all.finite = all.finite && all.acceleration2 < INFINITY && all.speed2 < INFINITY;
  return all;
}

/// Calls f(kernel) with the run's kernel, weighted with the particle mass.
template <int Dim, class Real, class F> void with_run_kernel(const State<Dim, Real>& s, F&& f) {
  const Parameters<Dim>& p = s.parameters;
  with_kernel<Real>(p.kernel, Dim, p.smoothing_length, p.particle_mass, std::forward<F>(f));
}

/// The given terms fused → rates and extremes; with(finish) is what becomes of the sums.
template <int Dim, class Real, class With, class... Terms>
void run_rates_pass_with(State<Dim, Real>& s, const With& with, const Terms&... terms) {
  std::vector<Extremes> extremes(s.neighbours.chunks().size());
  const RatesFinish<Dim, Real> finish{s, extremes};
  with_run_kernel(s, [&](const auto& kernel) {
    pair_pass<native_lanes<Real>>(s.neighbours, s.particles, kernel, with(finish), terms...);
  });
  s.extremes = joined(extremes);
  if (s.features.laminar) s.extremes.kinematic_viscosity = s.parameters.viscosity / s.parameters.eos.rest_density;
  if (s.features.sleep) s.extremes.kinematic_viscosity = std::max(s.extremes.kinematic_viscosity, s.sleep.viscosity);
}

template <int Dim, class Real, class... Terms> void run_rates_pass(State<Dim, Real>& s, const Terms&... terms) {
  run_rates_pass_with(
      s, [](const auto& finish) -> const auto& { return finish; }, terms...);
}

/// The same with what walls add.
template <int Dim, class Real, class... Terms>
void run_rates_pass_at_walls(State<Dim, Real>& s, const Terms&... terms) {
  const bool moving = s.features.wall_support && s.features.bodies;
  std::vector<Kick<Dim>> given(moving ? s.neighbours.chunks().size() * s.bodies.count() : 0);
  const auto walls = [&](const auto& finish) {
    return WithWalls(s.wall_support, s.parameters, s.particles, finish, terms...).giving(given);
  };
  run_rates_pass_with(s, walls, terms...);
  if (moving) s.bodies.receive(given);
}

/// The artificial viscosity of the run.
template <int Dim, class Real> ArtificialViscosity<Real> artificial_viscosity_of(const State<Dim, Real>& s) {
  const Parameters<Dim>& p = s.parameters;
  return {p.artificial_viscosity, p.eos.sound_speed, p.smoothing_length, p.eos.rest_density};
}

/// The heat conduction of the run, in a pass that serves all scenes with heat.
template <bool corrected, int Dim, class Real>
HeatConduction<Real, corrected, true> heat_conduction_of(const State<Dim, Real>& s) {
  const Features& f = s.features;
  const Parameters<Dim>& p = s.parameters;
  return {f.heat ? p.diffusivity : 0, p.eos.rest_density, {f.varied_conduction, f.heat_at_walls()}};
}

/// The rates passes in files of their own: with one force beside the basic ones or with what melts, with corrected
/// gradients, with consistent Laplacians beside them, and with what few scenes ask for.
template <int Dim, class Real> void single_rates_pass(State<Dim, Real>& s);
template <int Dim, class Real> void corrected_rates_pass(State<Dim, Real>& s);
template <int Dim, class Real> void consistent_rates_pass(State<Dim, Real>& s);
template <int Dim, class Real> void seldom_rates_pass(State<Dim, Real>& s);

}  // namespace molten
