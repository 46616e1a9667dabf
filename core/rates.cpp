// The two pair passes of a step: which terms they fuse, and what becomes of the sums.
#include "core/rates_pass.h"

#include <algorithm>

#include "core/physics/continuity.h"
#include "core/physics/density_diffusion.h"
#include "core/physics/laminar_viscosity.h"
#include "core/physics/pairwise_stress.h"
#include "core/physics/viscous_stress.h"
#include "core/physics/xsph.h"

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
    const double value = p.viscosity_at(magnitude, T ? T[slot] : 0.0);
    const Real density = rho0 * (1 + delta[slot]);
    eta[slot] = static_cast<Real>(value);
    stress_of.set(slot, stress_term(static_cast<Real>(value), density, strain));
  }};
}

/// −½ d ln η/d ln D, at most ½ for a fluid whose stress does not fall with its rate of strain.
template <int Dim> double thinning_at(const Parameters<Dim>& p, double strain, double temperature, double viscosity) {
  constexpr double step = 1e-3;
  const double further = p.viscosity_at((1 + step) * strain, temperature);
  return std::clamp(0.5 * (1 - further / viscosity) / step, -0.5, 0.5);
}

/// Velocity gradient → viscosity and how it varies with the rate of strain.
template <int Dim, class Real> auto pairwise_finish(State<Dim, Real>& s) {
  return PlainFinish{[&p = s.parameters, strain_of = s.particles[strain_rate], curl = s.particles[vorticity],
                      eta = s.particles[viscosity][0], thins = s.particles[thinning][0],
                      T = s.particles[temperature][0]](std::size_t slot, const auto& sums) {
    const Real volumes = static_cast<Real>(1 / p.eos.rest_density);
    const SymTensor<Dim, Real> strain = volumes * sums[strain_rate];
    strain_of.set(slot, strain);
    curl.set(slot, volumes * sums[vorticity]);
    const double magnitude = strain_magnitude(strain), there = T ? T[slot] : 0.0;
    const double value = p.viscosity_at(magnitude, there);
    eta[slot] = static_cast<Real>(value);
    thins[slot] = static_cast<Real>(thinning_at(p, magnitude, there, value));
  }};
}

}  // namespace

template <int Dim, class Real> void find_viscosity(State<Dim, Real>& s) {
  const auto scope = s.timer.scope("viscosity");
  const auto pass = [&](const auto& finish, const auto& term) {
    with_run_kernel(s, [&](const auto& kernel) {
      pair_pass<native_lanes<Real>>(s.neighbours, s.particles, kernel,
                                    WithWalls(s.wall_support, s.parameters, s.particles, finish, term), term);
    });
  };
  if (s.features.pairwise_stress) return pass(pairwise_finish(s), CorrectedVelocityGradient{});
  const auto finish = viscosity_finish(s);
  s.features.gradient_correction ? pass(finish, CorrectedStrainRateTerm{}) : pass(finish, StrainRateTerm{});
}

template <int Dim, class Real> void find_rates(State<Dim, Real>& s) {
  const auto scope = s.timer.scope(s.features.heat ? "forces and heat" : "forces");
  if (s.features.any_seldom()) return seldom_rates_pass(s);
  if (s.features.consistent_laplacian) return consistent_rates_pass(s);
  if (s.features.gradient_correction) return corrected_rates_pass(s);
  if (s.features.only_one_more_force()) return single_rates_pass(s);
  const Parameters<Dim>& p = s.parameters;
  const double rho0 = p.eos.rest_density;
  const auto pass = [&](const auto&... terms) { run_rates_pass_at_walls(s, Continuity{}, PressureForce{}, terms...); };
  // What most scenes have, without and with artificial viscosity; and all that a scene may have.
  const ArtificialViscosity<Real> artificial = artificial_viscosity_of(s);
  const DensityDiffusion<Dim, Real> diffusion(p.density_diffusion, p.smoothing_length, p.eos, p.gravity);
  if (s.features.only_basic_forces())
    diffusion.on ? pass(artificial, Always(diffusion)) : artificial.on ? pass(Always(artificial)) : pass();
  else
    pass(artificial, LaminarViscosity<Real>(s.features.morris_viscosity() ? p.viscosity : 0, rho0),
         MonaghanViscosity<Dim, Real>(s.features.monaghan_viscosity ? p.viscosity : 0, rho0),
         StressForce<Dim, Real>(s.features.stress, rho0, p.kernel_second_moment), heat_conduction_of<false>(s),
         diffusion, XsphTerm<Real>(s.features.xsph, rho0, p.xsph_neighbour_density));
}

#define MOLTEN_INSTANTIATE(Dim, Real)              \
  template void find_viscosity(State<Dim, Real>&); \
  template void find_rates(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
