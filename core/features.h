// From a scene to what it needs: the terms, fields and passes of the run, fixed for its whole life. What a scene does
// not mention has no column and no pass.
#pragma once

#include <string>
#include <vector>

#include "core/particles.h"
#include "core/scene.h"

namespace molten {

struct Features {
  bool heat = false;               // temperature and its conduction
  bool varied_conduction = false;  // bodies differ in it
  bool stress = false;             // viscosity that varies: strain-rate pass and stress
  bool pairwise_stress = false;    // its form for corrected gradients
  bool smd = false;                // that of de Souza Mendes and Dutra
  bool laminar = false;            // constant viscosity
  bool artificial_viscosity = false;
  bool particle_sound_speed = false;
  bool tensile_correction = false;
  bool monaghan_viscosity = false;  // forms of a constant viscosity other than Morris'
  bool muller_viscosity = false;
  bool half_pressure = false;
  bool internal_energy = false;
  bool xsph = false;
  bool density_sum = false;     // density by summation
  bool density_filter = false;  // every so many steps
  bool gradient_correction = false;
  bool consistent_laplacian = false;
  bool shifting = false;
  bool density_coupling = false;    // of shifted particles, to that of their places
  bool contact = false;             // walls
  bool wall_support = false;        // walls make up for what they cut off a particle's support
  bool boundary_particles = false;  // walls of particles that take part in density and pressure
  bool repulsion = false;           // walls of particles that push
  bool bodies = false;              // walls that move
  bool vents = false;               // fluid enters
  bool outflow = false;             // fluid is removed at planes
  bool density_diffusion = false;
  bool sleep = false;   // what is at rest
  bool levels = false;  // time steps by region
  IntegratorKind integrator = IntegratorKind::leap_frog;

  /// No forces but pressure and artificial viscosity, no heat, no XSPH: the shortest instantiation of the forces pass
  /// serves.
  bool only_basic_forces() const { return !heat && !stress && !laminar && !xsph; }

  /// Beside the basic ones, one force only, XSPH or heat, or both that melting takes: passes with nothing else serve.
  bool only_one_more_force() const {
    const int more = stress + heat + (laminar && !monaghan_viscosity) + xsph;
    return !density_diffusion && !monaghan_viscosity && !varied_conduction && !heat_at_walls() &&
           (more == 1 || (more == 2 && stress && heat));
  }

  /// Insulating walls hide some of the support from heat.
  bool heat_at_walls() const { return heat && wall_support; }
  /// More than one pass asks what is near walls.
  bool twice_at_walls() const { return wall_support && (stress || heat); }

  /// How often a step finds rates: once, or once a stage of a Runge-Kutta method.
  int stages() const;
  /// The first stage of a step takes the rates of the last one of the step before.
  bool reuses_rates() const { return integrator == IntegratorKind::predictor_corrector; }

  /// Something that only the rates pass with every term has.
  bool any_seldom() const {
    return particle_sound_speed || tensile_correction || muller_viscosity || half_pressure || internal_energy ||
           repulsion;
  }

  bool morris_viscosity() const { return laminar && !monaghan_viscosity && !muller_viscosity; }

  FieldSet columns() const;
  /// The passes of one step in their order.
  std::vector<std::string> passes() const;
  /// One word a feature, for `check` and the manifest.
  std::vector<std::string> names() const;
};

const char* name_of(IntegratorKind kind);

/// Throws Error(usage) with the reason for combinations that make no sense.
Features features_of(const Scene& scene);

}  // namespace molten
