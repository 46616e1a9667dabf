// The numbers of a run, worked out once from the scene and the filling.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/features.h"
#include "core/kernel.h"
#include "core/neighbours.h"
#include "core/physics/flow_curve.h"
#include "core/physics/pressure.h"
#include "core/physics/rheology.h"
#include "core/scene.h"
#include "core/sleep.h"

namespace molten {

template <int Dim> struct Parameters {
  double spacing = 0, smoothing_length = 0, support_radius = 0, skin = 0;  // m
  double particle_mass = 0;                                                // kg (2-D: kg per m of depth)
  double contact_radius = 0;                                               // m, of particles that meet walls
  long long boundary_every = 1;       // steps; how often dynamic boundary particles' density follows its rate
  std::array<double, Dim> gravity{};  // m/s²
  KernelKind kernel = KernelKind::wendland_c2;
  double kernel_second_moment = 0;  // ∫ W r² dV, m²
  EquationOfState eos;
  std::optional<double> surface_potential;  // m²/s², −g·x of the surface that the fluid is at rest below, at the start
  double viscosity = 0;                     // Pa s, Newtonian
  Smd smd;
  Rheology rheology;
  double viscosity_at(double strain, double temperature) const {
    return rheology.model == Rheology::Model::smd ? smd.viscosity(strain, temperature)
                                                  : viscosity_of(rheology, strain, temperature);
  }
  double diffusivity = 0, reference_temperature = 0;  // m²/s; T that local temperatures refer to
  double largest_conductivity = 1;                    // that there is, over the scene's
  double artificial_viscosity = 0;                    // α
  double density_diffusion = 0;                       // δ
  double xsph = 0;                                    // ε
  Xsph::Form xsph_form = Xsph::Form::position;
  bool xsph_neighbour_density = false;
  double shifting = 0, density_coupling = 0;            // C, κ
  double lattice_concentration = 1;                     // of density_coupling.h
  KernelKind density_kernel = KernelKind::wendland_c2;  // of the summation
  bool energy_surplus = true;
  DensityFilter density_filter;
  double courant_sound = 0, courant_viscous = 0, courant_force = 0, courant_conduction = 0;
  std::optional<double> fixed_dt;  // s
  int time_step_levels = 0;        // powers of two by which a step may exceed the smallest stable viscous one
  bool sort_each_step = false;
  std::optional<RestBounds> rest;  // within which particles fall asleep
  Domain<Dim> domain;
  std::vector<Plane> outflows;
};

/// The largest time step (s) of a diffusion (m²/s): conduction, or δ-SPH's, whose diffusivity is δ h c.
template <int Dim> double diffusion_limit(const Parameters<Dim>& p, double diffusivity) {
  constexpr double diffusion_constant = 3.5;  // h² ∫|W'|/r of the Wendland kernel, the largest of the common ones
  return p.courant_conduction * p.smoothing_length * p.smoothing_length / (2 * diffusion_constant * diffusivity);
}

/// The largest time step of conduction (s).
template <int Dim> double conduction_limit(const Parameters<Dim>& p) {
  return diffusion_limit(p, p.largest_conductivity * p.diffusivity);
}

/// What the start of a run is made of: the filled bodies, one entry a particle.
struct Start {
  double spacing = 0;                                     // m
  double measure = 0;                                     // m³ (2-D: m²) of all bodies
  std::vector<std::array<double, 3>> position, velocity;  // m, m/s
  std::vector<double> temperature;                        // empty without heat
  std::vector<double> conductivity;                       // over the scene's; empty: that everywhere
  std::vector<std::array<double, 3>> vents;               // m; where fluid will enter
  double vent_speed = 0;                                  // m/s; the fastest that it will
};

/// The volume that a particle stands for, m³ (2-D: m²).
double measure_of_particle(const Scene& scene, const Start& start);

template <int Dim> Parameters<Dim> parameters_of(const Scene& scene, const Start& start);

}  // namespace molten
