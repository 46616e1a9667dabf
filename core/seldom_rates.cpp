// The rates pass of scenes that ask for what few do: the tensile correction, Müller's viscosity, the particles' own
// sound speeds, internal energy, repulsive boundary particles. Everything else that a scene may have is in it as well.
#include "core/physics/continuity.h"
#include "core/physics/density_coupling.h"
#include "core/physics/laminar_viscosity.h"
#include "core/physics/muller_viscosity.h"
#include "core/physics/shifting.h"
#include "core/physics/tensile_correction.h"
#include "core/physics/viscous_stress.h"
#include "core/physics/work.h"
#include "core/physics/xsph.h"
#include "core/rates_pass.h"

namespace molten {

namespace {

/// The symmetric pressure force, or [Q]'s −Σ V_j (p_i + p_j)/2 ∇W_ij (4.3, its stray μ removed), which is half of −∇p.
struct OneOfPressures {
  using Reads = FieldList<PressureTerm, Compression>;
  using Sums = FieldList<Acceleration>;
  using Radial = FieldList<Acceleration>;
  static constexpr bool on = true;
  bool half = false;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    if (!half) return PressureForce{}(ij, i, j, out);
    const L rho_i = L(1) + i[compression], rho_j = L(1) + j[compression];  // over ρ0
    const L pressures = i[pressure_term] * rho_i * rho_i + j[pressure_term] * rho_j * rho_j;
    out.along(acceleration, L(-0.5) * pressures * reciprocal(rho_i * rho_j));
  }
};

/// m W(Δx), kg/m^d
template <int Dim, class Real> double kernel_at_spacing(const Parameters<Dim>& p) {
  return with_kernel<double>(p.kernel, Dim, p.smoothing_length, p.particle_mass,
                             [&](const auto& kernel) { return kernel(Lanes<double, 1>(p.spacing)).w.v; });
}

template <bool corrected, int Dim, class Real, class... Terms>
void seldom_pass(State<Dim, Real>& s, const Terms&... terms) {
  const Features& f = s.features;
  const Parameters<Dim>& p = s.parameters;
  const double rho0 = p.eos.rest_density;
  const auto pushed = [&](const auto& finish) { return WithRepulsion(s.repulsion, s.particles, finish); };
  run_rates_pass_with(
      s, pushed,
      WithWork(
          f.internal_energy, OneOfPressures{f.half_pressure},
          ArtificialViscosity<Real, true>(p.artificial_viscosity, p.eos.sound_speed, p.smoothing_length, rho0,
                                          f.particle_sound_speed),
          TensileCorrection<Real>(f.tensile_correction, kernel_at_spacing<Dim, Real>(p)),
          LaminarViscosity<Real, corrected>(f.morris_viscosity() ? p.viscosity : 0, rho0),
          MonaghanViscosity<Dim, Real, corrected>(f.monaghan_viscosity ? p.viscosity : 0, rho0),
          MullerViscosity<Dim, Real>(f.muller_viscosity ? p.viscosity : 0, p.particle_mass, rho0, p.support_radius),
          StressForce<Dim, Real>(f.stress, rho0, p.kernel_second_moment)),
      heat_conduction_of<corrected>(s), XsphTerm<Real>(f.xsph, rho0, p.xsph_neighbour_density), terms...);
}

}  // namespace

template <int Dim, class Real> void seldom_rates_pass(State<Dim, Real>& s) {
  if (s.features.gradient_correction)
    seldom_pass<true>(s, CorrectedContinuity{s.features.shifting}, DensityCoupling{s.features.density_coupling},
                      ShiftTransport<Real>(s.features.shifting, s.parameters.eos.rest_density));
  else
    seldom_pass<false>(s, Continuity{});
}

#define MOLTEN_INSTANTIATE(Dim, Real) template void seldom_rates_pass(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
