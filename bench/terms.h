// The terms of the rates pass as a state's features ask for them (as core/rates.cpp fuses them).
#pragma once

#include "core/physics/artificial_viscosity.h"
#include "core/physics/continuity.h"
#include "core/physics/heat_conduction.h"
#include "core/physics/laminar_viscosity.h"
#include "core/physics/pressure.h"
#include "core/physics/viscous_stress.h"
#include "core/physics/xsph.h"
#include "core/state.h"

namespace molten::bench {

/// Calls f(terms...) with every term that the rates pass can have, on or off.
template <int Dim, class Real, class F> decltype(auto) with_rate_terms(const State<Dim, Real>& s, F&& f) {
  const Parameters<Dim>& p = s.parameters;
  const double rho0 = p.eos.rest_density;
  return f(Continuity{}, PressureForce{},
           ArtificialViscosity<Real>(p.artificial_viscosity, p.eos.sound_speed, p.smoothing_length, rho0),
           LaminarViscosity<Real>(s.features.laminar ? p.viscosity : 0, rho0),
           StressForce<Dim, Real>(s.features.stress, rho0, p.kernel_second_moment),
           HeatConduction<Real>(s.features.heat ? p.diffusivity : 0, rho0), XsphTerm<Real>(s.features.xsph, rho0));
}

}  // namespace molten::bench
