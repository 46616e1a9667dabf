// From a scene to what it needs: the terms, fields and passes of the run, fixed for its whole life. What a scene does
// not mention has no column and no pass.
#pragma once

#include <string>
#include <vector>

#include "core/particles.h"
#include "core/scene.h"

namespace molten {

struct Features {
  bool heat = false;     // temperature and its conduction
  bool stress = false;   // viscosity that varies: strain-rate pass and stress
  bool laminar = false;  // constant viscosity
  bool artificial_viscosity = false;
  bool xsph = false;
  bool contact = false;  // walls
  bool bodies = false;   // walls that move
  bool vents = false;    // fluid enters
  bool outflow = false;  // fluid is removed at planes
  IntegratorKind integrator = IntegratorKind::leap_frog;

  /// No forces but pressure and artificial viscosity, no heat, no XSPH: the shortest instantiation of the forces pass
  /// serves.
  bool only_basic_forces() const { return !heat && !stress && !laminar && !xsph; }

  FieldSet columns() const;
  /// The passes of one step in their order.
  std::vector<std::string> passes() const;
  /// One word a feature, for `check` and the manifest.
  std::vector<std::string> names() const;
};

/// Throws Error(usage) with the reason for combinations that make no sense.
Features features_of(const Scene& scene);

}  // namespace molten
