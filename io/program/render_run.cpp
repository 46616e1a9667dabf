// render: pictures of a run's frames, all with one camera and one colour range.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/geometry/bodies.h"
#include "io/geometry/mesh_file.h"
#include "io/hdf5/frames.h"
#include "io/picture/camera.h"
#include "io/picture/colour_field.h"
#include "io/program/commands.h"

namespace molten {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void bad_choice(const std::string& text) {
  throw Error(ExitCode::usage, "--frames " + text + ": give all, last, numbers (0,10,20) or a range (0:100:10)");
}

int number(const std::string& text, const std::string& whole) {
  std::size_t used = 0;
  int value = -1;
  try {
    value = std::stoi(text, &used);
  } catch (const std::exception&) {
    bad_choice(whole);
  }
  if (used != text.size() || value < 0) bad_choice(whole);
  return value;
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts{""};
  for (const char c : text) {
    if (c == at)
      parts.emplace_back();
    else
      parts.back().push_back(c);
  }
  return parts;
}

std::vector<int> chosen_frames(const std::string& text, int count) {
  std::vector<int> chosen;
  if (text == "last") return {count - 1};
  if (text == "all") {
    for (int k = 0; k < count; ++k) chosen.push_back(k);
  } else if (text.find(':') != std::string::npos) {
    const auto parts = split(text, ':');
    if (parts.size() > 3) bad_choice(text);
    const int by = parts.size() == 3 ? number(parts[2], text) : 1;
    if (by == 0) bad_choice(text);
    for (int k = number(parts[0], text); k < std::min(count, number(parts[1], text) + 1); k += by) chosen.push_back(k);
  } else {
    for (const std::string& part : split(text, ',')) chosen.push_back(number(part, text));
  }
  for (const int k : chosen)
    if (k >= count)
      throw Error(ExitCode::usage, fmt::format("--frames {}: the run has frames 0 to {}", text, count - 1));
  if (chosen.empty()) bad_choice(text);
  return chosen;
}

/// The field's range over all the pictures, so that a colour means the same in each.
std::optional<std::array<double, 2>> common_range(const std::vector<Snapshot>& shots, const std::string& field) {
  std::optional<std::array<double, 2>> common;
  for (const Snapshot& shot : shots) {
    const auto colours = colour_field(shot, field);
    const auto range = colours ? colours->range() : std::nullopt;
    if (!range) continue;
    if (!common) common = range;
    common = std::array{std::min((*common)[0], (*range)[0]), std::max((*common)[1], (*range)[1])};
  }
  return common;
}

std::vector<TriangleMesh> read_bodies(const fs::path& run) {
  std::vector<TriangleMesh> bodies;
  while (true) {
    const fs::path file = run / "bodies" / fmt::format("{}.obj", bodies.size());
    if (!fs::exists(file)) return bodies;
    bodies.push_back(read_mesh(file));
  }
}

/// The fixed walls, and the bodies where they are in the frame.
TriangleMesh with_bodies(TriangleMesh walls, const std::vector<TriangleMesh>& bodies, const Snapshot& shot) {
  for (std::size_t k = 0; k < std::min(bodies.size(), shot.bodies.size()); ++k) {
    const TriangleMesh body = placed(bodies[k], shot.bodies[k]);
    const auto first = static_cast<std::int32_t>(walls.vertices.size());
    walls.vertices.insert(walls.vertices.end(), body.vertices.begin(), body.vertices.end());
    for (const auto& t : body.triangles) walls.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return walls;
}

void require_range(const PictureOptions& picture) {
  if (!picture.range) return;
  const auto [lowest, highest] = *picture.range;
  if (!(std::isfinite(lowest) && std::isfinite(highest) && lowest < highest))
    throw Error(ExitCode::usage,
                fmt::format("--range {} {}: give the lowest value of the colours and a higher one", lowest, highest));
}

}  // namespace

ExitCode render_run(const RenderChoice& choice) {
  require_range(choice.picture);
  const auto frames = list_frames(choice.run);
  const std::vector<int> chosen = chosen_frames(choice.frames, static_cast<int>(frames.size()));
  const fs::path walls = choice.run / "walls.obj";
  TriangleMesh boundary;
  if (choice.picture.boundaries && fs::exists(walls) && fs::file_size(walls) > 64) boundary = read_mesh(walls);
  const fs::path folder = choice.output.empty() ? choice.run / "pictures" : choice.output;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Error(ExitCode::files, folder.string() + ": cannot create the folder for the pictures: " + error.message());

  const std::vector<TriangleMesh> bodies =
      choice.picture.boundaries ? read_bodies(choice.run) : std::vector<TriangleMesh>();
  std::vector<Snapshot> shots;
  for (const int k : chosen) shots.push_back(read_frame(frames[k].file));
  PictureOptions options = picture::with_fixed_view(choice.picture, shots, with_bodies(boundary, bodies, shots[0]));
  if (!options.range) options.range = common_range(shots, options.field);
  for (std::size_t k = 0; k < shots.size(); ++k) {
    const fs::path file = folder / fmt::format("{:06}.png", chosen[k]);
    write_png(draw(shots[k], with_bodies(boundary, bodies, shots[k]), options), file);
    fmt::print("{}\n", file.string());
  }
  return ExitCode::done;
}

}  // namespace molten
