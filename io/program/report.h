// summary.json and manifest.json of a run.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/features.h"
#include "core/scene.h"

namespace molten {

/// What summary.json holds; counters are totals over threads and, after a resume, over the whole run.
struct Summary {
  std::string status;  // "done", "interrupted", "diverged"
  std::int64_t particles = 0, particles_asleep = 0, particles_lost = 0, steps = 0;
  std::optional<std::int64_t> boundary_particles;  // of the particles, those that are walls; or those that push
  std::optional<double> energy_taken_by_sleep;     // J
  std::vector<double> level_steps;                 // particle-steps by level; empty without time_step_levels
  double stages = 0;                               // of all steps
  double simulated_time_s = 0;
  double wall_time_s = 0;                                  // of the stepping loop, output not counted
  double particle_steps = 0, asleep_steps = 0, pairs = 0;  // particle_steps counts those asleep, too
  int threads = 0;
  std::size_t state_bytes = 0;
  std::map<std::string, double, std::less<>> passes;  // s
};
void write_summary(const std::filesystem::path& folder, const Summary& summary);

void write_manifest(const std::filesystem::path& folder, const Scene& scene, const Features& features,
                    const std::string& fingerprint);

/// The scene file that a run came from, for finding its meshes.
std::string scene_file_of(const std::filesystem::path& folder);

/// Peak resident memory of this process.
std::size_t peak_memory_bytes();
std::string cpu_name();
std::string compiler_name();

}  // namespace molten
