// info and compare: what files hold, and how two runs differ.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "io/geometry/mesh_file.h"
#include "io/hdf5/checkpoint.h"
#include "io/hdf5/frames.h"
#include "io/program/commands.h"
#include "io/program/say.h"

namespace molten {

namespace fs = std::filesystem;

namespace {

void print_range(const std::string& name, const std::string& unit, int components, const std::vector<double>& values) {
  double lowest = 1e300, highest = -1e300;
  for (std::size_t k = 0; k * components < values.size(); ++k) {
    double square = 0;
    for (int c = 0; c < components; ++c) square += values[k * components + c] * values[k * components + c];
    const double v = components == 1 ? values[k] : std::sqrt(square);
    lowest = std::min(lowest, v), highest = std::max(highest, v);
  }
  if (values.empty()) return fmt::print("  {:<14} empty\n", name);
  fmt::print("  {:<14} {:.6g} to {:.6g} {}{}\n", name, lowest, highest, unit, components == 1 ? "" : " (magnitude)");
}

void print_frame(const fs::path& file) {
  const Snapshot shot = read_frame(file);
  fmt::print("{}: frame, t = {:.6g} s, step {}, {} particles, {}-D, spacing {:.4g} m\n", file.string(), shot.time,
             shot.step, shot.count(), shot.dimensions, shot.spacing);
  for (const SnapshotField& f : shot.fields) print_range(f.name, f.unit, f.components, f.values);
}

void print_checkpoint(const fs::path& file) {
  const CheckpointHead head = read_checkpoint_head(file);
  fmt::print("{}: checkpoint, t = {:.6g} s, step {}, molten {}\n", file.string(), head.time, head.step, head.version);
}

/// One line a member; lists and nested members on the line of theirs.
void print_json(const fs::path& file) {
  std::ifstream in(file);
  if (!in) return;
  const auto json = nlohmann::ordered_json::parse(in, nullptr, false);
  if (!json.is_object()) return fmt::print("{}: damaged\n", file.filename().string());
  fmt::print("{}\n", file.filename().string());
  for (const auto& [key, value] : json.items())
    fmt::print("  {:<26} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
}

void print_run_folder(const fs::path& folder) {
  for (const char* name : {"manifest.json", "summary.json"}) print_json(folder / name);
  for (const fs::path& file : list_checkpoints(folder)) {
    try {
      print_checkpoint(file);
    } catch (const Error& e) {  // a run goes on from an older one
      say("warning: {}\n", e.what());
    }
  }
  const bool holds_run = fs::exists(folder / "manifest.json");  // which may well write no frames
  if (holds_run && (!fs::exists(folder / "frames") || fs::is_empty(folder / "frames")))
    return fmt::print("no frames\n");
  const auto frames = list_frames(folder);
  fmt::print("{} frames\n", frames.size());
  print_frame(frames.back().file);
}

bool has_extension(const fs::path& file, std::initializer_list<const char*> extensions) {
  return std::any_of(extensions.begin(), extensions.end(), [&](const char* e) { return file.extension() == e; });
}

}  // namespace

ExitCode show_info(const fs::path& file) {
  if (!fs::exists(file)) throw Error(ExitCode::files, file.string() + ": no such file or folder");
  if (fs::is_directory(file)) {
    print_run_folder(file);
  } else if (has_extension(file, {".hdf"})) {
    print_frame(file);
  } else if (has_extension(file, {".h5"})) {
    print_checkpoint(file);
  } else if (has_extension(file, {".obj", ".stl", ".ply", ".glb"})) {
    const TriangleMesh mesh = read_mesh(file);
    const MeshReport r = inspect(mesh);
    fmt::print(
        "{}: mesh, {} vertices, {} triangles, volume {:.6g} m3, {} open edges, {} flipped edges, {} degenerate\n",
        file.string(), mesh.vertices.size(), mesh.triangles.size(), r.volume, r.open_edges, r.flipped_edges,
        r.degenerate_triangles);
  } else {
    throw Error(ExitCode::usage,
                file.string() + ": not a run folder, frame (.hdf), checkpoint (.h5) or mesh (.obj, .stl, .ply, .glb)");
  }
  return ExitCode::done;
}

namespace {

Snapshot last_frame(const fs::path& file, std::size_t common) {
  return fs::is_directory(file) ? read_frame(list_frames(file)[common - 1].file) : read_frame(file);
}

void print_difference(const std::string& name, const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0, sum = 0, scale = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::max(largest, std::abs(a[k] - b[k]));
    sum += std::abs(a[k] - b[k]);
    scale = std::max(scale, std::abs(a[k]));
  }
  fmt::print("  {:<14} largest {:.6g}, mean {:.6g} (values up to {:.6g})\n", name, largest,
             a.empty() ? 0 : sum / static_cast<double>(a.size()), scale);
}

}  // namespace

ExitCode compare(const fs::path& a, const fs::path& b) {
  const auto frames = [](const fs::path& f) { return fs::is_directory(f) ? list_frames(f).size() : std::size_t(1e9); };
  const std::size_t common = std::min(frames(a), frames(b));
  const Snapshot first = last_frame(a, common), second = last_frame(b, common);
  fmt::print("{} (t = {:.6g} s) and {} (t = {:.6g} s)\n", a.string(), first.time, b.string(), second.time);
  if (std::abs(first.time - second.time) > 1e-6 * std::max(first.time, second.time))
    fmt::print("  note: at different times; name two frames of the same\n");
  if (first.id != second.id) {
    fmt::print("  different particles: {} and {}\n", first.count(), second.count());
    return ExitCode::done;
  }
  print_difference("position", first.position, second.position);
  for (const SnapshotField& f : first.fields)
    for (const SnapshotField& g : second.fields)
      if (f.name == g.name) print_difference(f.name, f.values, g.values);
  return ExitCode::done;
}

}  // namespace molten
