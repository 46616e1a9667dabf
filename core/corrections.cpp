// Corrected gradients and shifting: a pass of their own before the rates, and the rates with what it found.
#include "core/particle_pass.h"
#include "core/physics/density_coupling.h"
#include "core/physics/density_diffusion.h"
#include "core/physics/gradient_correction.h"
#include "core/physics/laminar_viscosity.h"
#include "core/physics/pairwise_stress.h"
#include "core/physics/shifting.h"
#include "core/physics/viscous_stress.h"
#include "core/physics/xsph.h"
#include "core/rates_pass.h"

namespace molten {

namespace {

/// U of core/physics/shifting.h, m/s
template <int Dim, class Real> double speed_of_shifting(const State<Dim, Real>& s) {
  const auto v = s.particles[velocity];
  const double speed2 = reduce_slots(
      s.particles.slots(), 0.0,
      [&](std::size_t slot, double& largest) {
        double v2 = 0;
        for (int d = 0; d < Dim; ++d) v2 += double(v[d][slot]) * v[d][slot];
        largest = std::max(largest, s.particles.is_padding(slot) ? 0.0 : v2);
      },
      [](double& a, double b) { a = std::max(a, b); });
  return std::min(std::sqrt(speed2), s.parameters.eos.sound_speed / 10);
}

/// Moments → correction and shift velocity, particle by particle; `fastest` (m/s) is U.
template <int Dim, class Real> auto correction_finish(State<Dim, Real>& s, double fastest) {
  return PlainFinish{[&p = s.parameters, to = s.particles[correction], laplacian = s.particles[laplacian_correction][0],
                      depth = s.particles[inner][0], shift = s.particles[shift_velocity],
                      shifting = s.features.shifting, coupling = s.particles[coupling_rate][0],
                      delta = s.particles[compression][0], fastest](std::size_t slot, const auto& sums) {
    const double volumes = 1 / p.eos.rest_density;
    SymTensor<Dim, double> m;
    for (int k = 0; k < m.size; ++k) m[k] = -volumes * sums[moment][k];
    const GradientCorrection<Dim> found(m);
    for (int k = 0; k < m.size; ++k) to[k][slot] = static_cast<Real>(found.inverse[k]);
    if (laplacian) laplacian[slot] = static_cast<Real>(found.laplacian);
    if (depth) depth[slot] = static_cast<Real>(found.inner);
    if (!shifting) return;
    if constexpr (requires { sums[kernel_sum]; }) {
      double trace = 0;
      for (int d = 0; d < Dim; ++d) trace += m(d, d);
      const double lacking =
          concentration_of<Dim>(volumes * sums[kernel_sum], trace) / p.lattice_concentration - 1 - delta[slot];
      coupling[slot] =
          static_cast<Real>(p.density_coupling * fastest / p.smoothing_length * coupling_share(found.inner) * lacking);
    }
    Vec<Dim, double> way;
    for (int d = 0; d < Dim; ++d) way[d] = volumes * found.inner * sums[crowding_gradient][d];
    if constexpr (requires { sums[parting]; })
      for (int d = 0; d < Dim; ++d) way[d] += volumes * (1 - found.inner) * sums[parting][d];
    const double wanted = p.shifting * p.smoothing_length * fastest;
    const double most = fastest / 2 / (std::sqrt(dot(way, way)) + 1e-300);
    for (int d = 0; d < Dim; ++d) shift[d][slot] = static_cast<Real>(-std::min(wanted, most) * way[d]);
  }};
}

}  // namespace

template <int Dim, class Real> void find_corrections(State<Dim, Real>& s) {
  const auto scope = s.timer.scope("corrections");
  const auto finish = correction_finish(s, s.features.shifting ? speed_of_shifting(s) : 0);
  const GradientMoment moments;
  const Crowding crowding{s.features.shifting};
  const auto pass = [&](const auto&... more) {
    with_run_kernel(s, [&](const auto& kernel) {
      pair_pass<native_lanes<Real>>(
          s.neighbours, s.particles, kernel,
          WithWalls(s.wall_support, s.parameters, s.particles, finish, moments, crowding, more...), moments, crowding,
          more...);
    });
  };
  s.features.density_coupling ? pass(Concentration{}, PartingOfClose<Real>(s.parameters.spacing)) : pass();
}

template <int Dim, class Real> void corrected_rates_pass(State<Dim, Real>& s) {
  const Features& f = s.features;
  const Parameters<Dim>& p = s.parameters;
  const double rho0 = p.eos.rest_density;
  constexpr bool corrected = true;
  const auto pass = [&](const auto&... more) {
    run_rates_pass_at_walls(s, PressureForce{}, artificial_viscosity_of(s), CorrectedContinuity{f.shifting},
                            ShiftTransport<Real>(f.shifting, rho0),
                            LaminarViscosity<Real, corrected>(f.morris_viscosity() ? p.viscosity : 0, rho0), more...);
  };
  const DensityCoupling coupling{f.density_coupling};
  const DensityDiffusion<Dim, Real> diffusion(p.density_diffusion, p.smoothing_length, p.eos, p.gravity);
  // Newtonian flows in a space of their own, between walls and with a surface; and all that a scene may have.
  if (f.stress || f.heat || f.xsph || f.monaghan_viscosity)
    pass(MonaghanViscosity<Dim, Real, corrected>(f.monaghan_viscosity ? p.viscosity : 0, rho0),
         StressForce<Dim, Real>(f.stress && !f.pairwise_stress, rho0, p.kernel_second_moment),
         PairwiseStress<Dim, Real>(f.pairwise_stress, !f.heat, rho0), heat_conduction_of<corrected>(s), diffusion,
         coupling, XsphTerm<Real>(f.xsph, rho0, p.xsph_neighbour_density));
  else if (coupling.on || diffusion.on)
    pass(diffusion, coupling);
  else
    pass();
}

#define MOLTEN_INSTANTIATE(Dim, Real)                \
  template void find_corrections(State<Dim, Real>&); \
  template void corrected_rates_pass(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
