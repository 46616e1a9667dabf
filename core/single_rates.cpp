// The rates passes of scenes with one force beside the basic ones, or with the two of what melts: nothing else is
// compiled into them.
#include "core/physics/continuity.h"
#include "core/physics/heat_conduction.h"
#include "core/physics/laminar_viscosity.h"
#include "core/physics/viscous_stress.h"
#include "core/physics/xsph.h"
#include "core/rates_pass.h"

namespace molten {

template <int Dim, class Real> void single_rates_pass(State<Dim, Real>& s) {
  const Features& f = s.features;
  const Parameters<Dim>& p = s.parameters;
  const double rho0 = p.eos.rest_density;
  const auto pass = [&](const auto&... terms) {
    run_rates_pass_at_walls(s, Continuity{}, PressureForce{}, artificial_viscosity_of(s), terms...);
  };
  const StressForce<Dim, Real> stress_force(true, rho0, p.kernel_second_moment);
  const HeatConduction<Real> conduction(p.diffusivity, rho0);
  if (f.stress && f.heat)
    pass(Always(stress_force), Always(conduction));
  else if (f.stress)
    pass(stress_force);
  else if (f.heat)
    pass(Always(conduction));
  else if (f.xsph)
    pass(Always(XsphTerm<Real>(true, rho0, p.xsph_neighbour_density)));
  else
    pass(Always(LaminarViscosity<Real>(p.viscosity, rho0)));
}

#define MOLTEN_INSTANTIATE(Dim, Real) template void single_rates_pass(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
