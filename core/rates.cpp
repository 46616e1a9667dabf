// The two pair passes of a step: which terms they fuse, and what becomes of the sums.
#include <cmath>
#include <vector>

#include "core/boundary/wall_terms.h"
#include "core/pair_pass.h"
#include "core/physics/artificial_viscosity.h"
#include "core/physics/continuity.h"
#include "core/physics/density_diffusion.h"
#include "core/physics/heat_conduction.h"
#include "core/physics/laminar_viscosity.h"
#include "core/physics/viscous_stress.h"
#include "core/physics/xsph.h"
#include "core/step.h"

namespace molten {

namespace {

/// Strain rate → viscosity → stress, particle by particle.
template <int Dim, class Real> auto viscosity_finish(State<Dim, Real>& s) {
  return PlainFinish{[&p = s.parameters, stress_of = s.particles[stress], eta = s.particles[viscosity][0],
                      delta = s.particles[compression][0],
                      T = s.particles[temperature][0]](std::size_t slot, const auto& sums) {
    const Real rho0 = static_cast<Real>(p.eos.rest_density);
    const SymTensor<Dim, Real> strain = (Real(1) / rho0) * sums[strain_rate];
    const double magnitude = strain_magnitude(strain);
    const double value = p.smd.viscosity(magnitude, T ? T[slot] : 0.0);
    const Real density = rho0 * (1 + delta[slot]);
    eta[slot] = static_cast<Real>(value);
    stress_of.set(slot, (static_cast<Real>(value) / (density * density)) * strain);
  }};
}

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
    const Real* viscosities = p[viscosity][0];
    const Real* compressions = p[compression][0];
    Vec<Dim, Real> gravity = in_real<Dim, Real>(s.parameters.gravity);
    Real inverse_rest_density = static_cast<Real>(1 / s.parameters.eos.rest_density);

    template <class Sums> void operator()(std::size_t slot, const Sums& sums) {
      using L = std::decay_t<decltype(sums[compression_rate])>;
      constexpr int I = sizeof(L) / sizeof(Real);
      L alive(Real(1)), a2(Real(0)), v2(Real(0));
      for (int n = 0; n < I; ++n) set_lane(alive, n, ids[slot + n] == padding_id ? Real(0) : Real(1));
      for (int d = 0; d < Dim; ++d) {
        const L total = alive * (sums[acceleration][d] + L(gravity[d]));
        const L speed = alive * load<I>(v[d] + slot);
        store(total, a[d] + slot);
        a2 += total * total;
        v2 += speed * speed;
      }
      store(alive * L(inverse_rest_density) * sums[compression_rate], compression_rates + slot);
      raise(extremes.acceleration2, a2);
      raise(extremes.speed2, v2);
      if constexpr (requires { sums[temperature_rate]; })
        if (s.features.heat) keep_heat(slot, L(alive * sums[temperature_rate]));
      if constexpr (requires { sums[xsph_velocity]; })
        if (s.features.xsph) keep_xsph(slot, alive * sums[xsph_velocity]);
      if (s.features.stress) {
        const L density = L(static_cast<Real>(s.parameters.eos.rest_density)) * (L(1) + load<I>(compressions + slot));
        raise(extremes.kinematic_viscosity, alive * load<I>(viscosities + slot) * reciprocal(density));
      }
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

    /// Infinity stands for what is not a number, too.
    template <class L> void raise(double& extreme, const L& value) const {
      using Number = std::decay_t<decltype(lane(value, 0))>;
      if (!all_at_most(value, static_cast<Number>(extreme))) extreme = largest(value);
    }
  };
  OfChunk for_chunk(std::size_t k) const { return {s, extremes[k], s.particles}; }
};

Extremes joined(const std::vector<Extremes>& parts) {
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

}  // namespace

template <int Dim, class Real> void find_viscosity(State<Dim, Real>& s) {
  const auto scope = s.timer.scope("viscosity");
  const auto finish = viscosity_finish(s);
  const StrainRateTerm term;
  with_run_kernel(s, [&](const auto& kernel) {
    pair_pass<native_lanes<Real>>(s.neighbours, s.particles, kernel,
                                  WithWalls(s.wall_support, s.parameters, s.particles, finish, term), term);
  });
}

template <int Dim, class Real> void find_rates(State<Dim, Real>& s) {
  const auto scope = s.timer.scope(s.features.heat ? "forces and heat" : "forces");
  const Parameters<Dim>& p = s.parameters;
  const double rho0 = p.eos.rest_density;
  std::vector<Extremes> extremes(s.neighbours.chunks().size());
  const RatesFinish<Dim, Real> finish{s, extremes};
  const Continuity continuity;
  const PressureForce pressure;
  const ArtificialViscosity<Real> artificial(p.artificial_viscosity, p.eos.sound_speed, p.smoothing_length, rho0);
  const DensityDiffusion<Dim, Real> diffusion(p.density_diffusion, p.smoothing_length, p.eos, p.gravity);
  with_run_kernel(s, [&](const auto& kernel) {
    const auto pass = [&](const auto&... terms) {
      const WithWalls walls(s.wall_support, p, s.particles, finish, continuity, pressure, terms...);
      pair_pass<native_lanes<Real>>(s.neighbours, s.particles, kernel, walls, continuity, pressure, terms...);
    };
    // What most scenes have, without and with artificial viscosity; what melts; and all that a scene may have.
    const StressForce<Dim, Real> stress_force(s.features.stress, rho0);
    const HeatConduction<Real> conduction(s.features.heat ? p.diffusivity : 0, rho0);
    if (s.features.only_basic_forces())
      diffusion.on ? pass(artificial, Always(diffusion)) : artificial.on ? pass(Always(artificial)) : pass();
    else if (stress_force.on && conduction.on && !s.features.xsph && !diffusion.on)
      pass(artificial, Always(stress_force), Always(conduction));
    else
      pass(artificial, LaminarViscosity<Real>(s.features.laminar ? p.viscosity : 0, rho0), stress_force, conduction,
           diffusion, XsphTerm<Real>(s.features.xsph, rho0));
  });
  s.extremes = joined(extremes);
  if (s.features.laminar) s.extremes.kinematic_viscosity = p.viscosity / rho0;
}

#define MOLTEN_INSTANTIATE(Dim, Real)              \
  template void find_viscosity(State<Dim, Real>&); \
  template void find_rates(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
