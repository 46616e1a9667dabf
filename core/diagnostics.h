// What a run reports of its state: energies, momentum, extents; and snapshots for frames.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/snapshot.h"
#include "core/state.h"

namespace molten {

struct Diagnostics {
  std::int64_t particles = 0, asleep = 0;           // of the fluid, as all that follows
  double kinetic_energy = 0, potential_energy = 0;  // J (2-D: J per m of depth); potential −m g·x
  double least_energy_share = 1, mean_energy_share = 1, largest_energy_share = 1;  // of energy_bounded_euler
  double energy_taken_by_sleep = 0;                                                // J, from the start on
  double internal_energy = 0;                                                      // J, from the start on
  double heat = 0;                                                                 // Σ m T, kg K
  std::array<double, 3> momentum{};                                                // kg m/s
  std::array<double, 3> lower{}, upper{};                                          // m; extent of the particles
  double max_speed = 0;                                                            // m/s
  double max_compression = 0;                                                      // largest |ρ/ρ0 − 1|
  std::vector<std::array<double, 3>> bodies;                                       // m; centres of those that move
};

/// The same bits for any thread count.
template <int Dim, class Real> Diagnostics diagnose(const State<Dim, Real>& s);

/// The fluid's particles in id order with the named fields (empty: all that the run has).
template <int Dim, class Real>
Snapshot take_snapshot(const State<Dim, Real>& s, const std::vector<std::string>& fields);

/// Where the bodies are.
template <int Dim> std::vector<SnapshotBody> snapshots_of(const Bodies<Dim>& bodies);

/// Names of what a snapshot of this run can hold.
std::vector<std::string> available_fields(const Features& features);
/// Throws Error(usage) for one of output.fields that is none of them.
void require_fields(const Scene& scene, const Features& features);

/// Directed pairs within the support, self excluded.
template <int Dim, class Real> std::int64_t count_pairs(const State<Dim, Real>& s);

/// The id of the fastest particle.
template <int Dim, class Real> std::int64_t fastest_particle(const State<Dim, Real>& s);

/// One line on the first particle whose state is not finite: its id, the field, the likely cause. Empty: all finite.
template <int Dim, class Real> std::string find_non_finite(const State<Dim, Real>& s);

}  // namespace molten
