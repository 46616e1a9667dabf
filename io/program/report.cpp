#include "io/program/report.h"

#include <omp.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/error.h"
#include "io/geometry/text.h"
#include "io/hash.h"
#include "io/scene/scene_file.h"
#include "version.h"

namespace molten {

namespace {

void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json) {
  const std::filesystem::path part = file.string() + ".tmp";
  {
    std::ofstream out(part);
    out << json.dump(2) << '\n';
    if (!out.flush())
      throw Error(ExitCode::files, file.string() + ": cannot write; check the disk and the folder's rights");
  }
  std::filesystem::rename(part, file);
}

std::string hash_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return "";
  Hash hash;
  std::vector<char> block(1 << 16);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())), in.gcount() > 0)
    hash.add(block.data(), static_cast<std::size_t>(in.gcount()));
  return hash.text();
}

nlohmann::ordered_json files_of(const Scene& scene) {
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  const auto add = [&](const Shape& shape) {
    if (shape.text)
      files.push_back({{"path", shape.text->font}, {"hash", hash_of(find_font(scene, *shape.text, shape.place))}});
    const std::string path = shape.mesh ? shape.mesh->path : shape.terrain ? shape.terrain->path : "";
    if (!path.empty()) files.push_back({{"path", path}, {"hash", hash_of(locate(scene, path))}});
  };
  for (const Body& body : scene.fluid.bodies) add(body.shape);
  for (const Boundary& boundary : scene.boundaries) add(boundary.shape);
  return files;
}

}  // namespace

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

std::string compiler_name() {
#if defined(__clang__)
  return std::string("clang ") + __clang_version__;
#else
  return std::string("g++ ") + __VERSION__;
#endif
}

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

namespace {

/// Of the particle-steps, by level up to the last that was needed.
std::vector<double> shares(const std::vector<double>& level_steps) {
  const double all = std::max(std::accumulate(level_steps.begin(), level_steps.end(), 0.0), 1.0);
  std::vector<double> of;
  for (const double steps : level_steps) of.push_back(steps / all);
  while (of.size() > 1 && of.back() == 0) of.pop_back();
  return of;
}

}  // namespace

void write_summary(const std::filesystem::path& folder, const Summary& s) {
  const double per_second = s.wall_time_s > 0 ? 1 / s.wall_time_s : 0;
  nlohmann::ordered_json json = {{"status", s.status},
                                 {"particles", s.particles},
                                 {"particles_moving", s.particles - s.particles_asleep},
                                 {"particles_asleep", s.particles_asleep},
                                 {"particles_lost", s.particles_lost},
                                 {"steps", s.steps},
                                 {"simulated_time_s", s.simulated_time_s},
                                 {"wall_time_s", s.wall_time_s},
                                 {"particle_steps_per_second", s.particle_steps * per_second},
                                 {"share_asleep", s.particle_steps > 0 ? s.asleep_steps / s.particle_steps : 0},
                                 {"pairs_per_second", s.pairs * per_second},
                                 {"threads", s.threads},
                                 {"state_bytes", s.state_bytes},
                                 {"peak_memory_bytes", peak_memory_bytes()},
                                 {"passes", s.passes}};
  if (s.boundary_particles) json["boundary_particles"] = *s.boundary_particles;
  if (s.energy_taken_by_sleep) json["energy_taken_by_sleep_J"] = *s.energy_taken_by_sleep;
  if (!s.level_steps.empty()) {
    json["share_by_level"] = shares(s.level_steps);
    json["stages_a_step"] = s.stages / static_cast<double>(std::max<std::int64_t>(s.steps, 1));
  }
  write_json(folder / "summary.json", json);
}

void write_manifest(const std::filesystem::path& folder, const Scene& scene, const Features& features,
                    const std::string& fingerprint) {
  write_json(folder / "manifest.json",
             {{"title", scene.title},
              {"scene", std::filesystem::absolute(scene.file).string()},
              {"files", files_of(scene)},
              {"fingerprint", fingerprint},
              {"dimensions", scene.dimensions},
              {"precision", scene.numerics.precision == Precision::single ? "single" : "double"},
              {"features", features.names()},
              {"passes", features.passes()},
              {"version", MOLTEN_VERSION},
              {"commit", MOLTEN_COMMIT},
              {"build", MOLTEN_FLAGS},
              {"compiler", compiler_name()},
              {"cpu", cpu_name()},
              {"threads", omp_get_max_threads()}});
}

std::string scene_file_of(const std::filesystem::path& folder) {
  std::ifstream in(folder / "manifest.json");
  const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  const auto fallback = (folder / "scene.toml").string();
  return json.is_object() ? json.value("scene", fallback) : fallback;
}

}  // namespace molten
