// Consistent Laplacians: their weights, in a pass of their own before the rates, and the rates with them.
#include "core/physics/consistent_laplacian.h"
#include "core/physics/density_coupling.h"
#include "core/physics/density_diffusion.h"
#include "core/physics/pairwise_stress.h"
#include "core/physics/shifting.h"
#include "core/physics/viscous_stress.h"
#include "core/physics/xsph.h"
#include "core/rates_pass.h"

namespace molten {

namespace {

template <int Dim, class Real> auto weights_finish(State<Dim, Real>& s) {
  return PlainFinish{[per_density = 1 / s.parameters.eos.rest_density, reach = s.parameters.support_radius,
                      tilt = s.particles[laplacian_tilt],
                      bend = s.particles[laplacian_bend]](std::size_t slot, const auto& sums) {
    const LaplacianWeights<Dim> found(sums, per_density, reach);
    for (int d = 0; d < Dim; ++d) tilt[d][slot] = static_cast<Real>(found.tilt[d]);
    for (int k = 0; k < found.bend.size; ++k) bend[k][slot] = static_cast<Real>(found.bend[k]);
  }};
}

}  // namespace

template <int Dim, class Real> void find_laplacian_weights(State<Dim, Real>& s) {
  const auto scope = s.timer.scope("corrections");
  with_run_kernel(s, [&](const auto& kernel) {
    pair_pass<native_lanes<Real>>(s.neighbours, s.particles, kernel, weights_finish(s), LaplacianMoments<Dim>{});
  });
}

template <int Dim, class Real> void consistent_rates_pass(State<Dim, Real>& s) {
  const Features& f = s.features;
  const Parameters<Dim>& p = s.parameters;
  const double rho0 = p.eos.rest_density;
  run_rates_pass(s, PressureForce{}, artificial_viscosity_of(s), CorrectedContinuity{f.shifting},
                 ShiftTransport<Real>(f.shifting, rho0), ConsistentViscosity<Real>(f.laminar ? p.viscosity : 0, rho0),
                 StressForce<Dim, Real>(f.stress && !f.pairwise_stress, rho0, p.kernel_second_moment),
                 PairwiseStress<Dim, Real>(f.pairwise_stress, !f.heat, rho0),
                 ConsistentConduction<Real>(f.heat ? p.diffusivity : 0, rho0),
                 DensityDiffusion<Dim, Real>(p.density_diffusion, p.smoothing_length, p.eos, p.gravity),
                 DensityCoupling{f.density_coupling}, XsphTerm<Real>(f.xsph, rho0, p.xsph_neighbour_density));
}

#define MOLTEN_INSTANTIATE(Dim, Real)                      \
  template void find_laplacian_weights(State<Dim, Real>&); \
  template void consistent_rates_pass(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
