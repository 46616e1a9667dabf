#include "io/scene/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "core/error.h"
#include "core/features.h"
#include "io/scene/scene_motion.h"
#include "io/scene/scene_sections.h"
#include "io/scene/scene_shapes.h"

namespace molten {
namespace {

constexpr std::size_t largest_file = 16U << 20U;

std::string read_text(const std::filesystem::path& file) {
  const Place place{file.string(), 0, 0};
  std::error_code error;
  if (!std::filesystem::exists(file, error)) fail_at(place, "no such scene file; check the path");
  if (std::filesystem::is_directory(file, error)) fail_at(place, "is a folder; name the scene file in it");
  std::ifstream in(file, std::ios::binary);
  if (!in) fail_at(place, "cannot be read; check its permissions");
  std::string text(largest_file + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad()) fail_at(place, "reading failed; check the disk");
  if (text.size() > largest_file) fail_at(place, "is larger than 16 MB; this is no scene file");
  return text;
}

// ---- [scene] ----

void read_periodic(const TomlReader& keys, Scene& scene) {
  std::vector<std::string> axes;
  keys.texts("periodic", axes);
  for (const std::string& axis : axes) {
    const std::size_t index = axis.size() == 1 ? std::string_view("xyz").find(axis[0]) : std::string_view::npos;
    if (index >= static_cast<std::size_t>(scene.dimensions)) {
      keys.fail("periodic", fmt::format("\"{}\" is no axis; this scene has {}", shown(axis),
                                        scene.dimensions == 3 ? "x, y, z" : "x, y"));
    }
    scene.periodic[index] = true;
  }
}

void read_head(const TomlReader& root, Scene& scene) {
  scene.title = std::filesystem::path(scene.file).stem().string();
  const auto keys = root.table("scene", {"title", "dimensions", "gravity", "periodic", "domain"});
  if (keys) {
    keys->text("title", scene.title);
    long long dimensions = scene.dimensions;
    keys->whole("dimensions", dimensions, 2, 3);
    scene.dimensions = static_cast<int>(dimensions);
  }
  if (scene.dimensions == 2) scene.gravity = {0, -9.81, 0};
  if (!keys) return;
  keys->vector("gravity", scene.gravity, scene.dimensions, Range::any("m/s²"));
  if (keys->has("domain")) scene.domain = read_box(*keys, "domain", scene.dimensions);
  read_periodic(*keys, scene);
}

// ---- [[boundary]] ----

void read_ground(const TomlReader& keys, Boundary& boundary) {
  const auto ground = keys.table("ground", {"diffusivity", "thickness"});
  if (!ground) return;
  if (!boundary.temperature) keys.fail("ground", "leads to no temperature; add temperature, that below the layer");
  GroundLayer layer;
  ground->require("diffusivity", "give conductivity / (density × heat capacity of the fluid) in m²/s");
  ground->number("diffusivity", layer.diffusivity, Range::positive("m²/s"));
  ground->require("thickness", "give the depth in m at which the ground has the temperature");
  ground->number("thickness", layer.thickness, Range::positive("m"));
  boundary.ground = layer;
}

/// What walls do with support alone, and what only without it.
void check_support(const TomlReader& keys, const Boundary& boundary, const Scene& scene) {
  if (boundary.temperature && !scene.numerics.wall_support)
    keys.fail("temperature", "has no effect without wall support; add numerics.wall_support = true");
  if (boundary.temperature && !scene.fluid.heat) keys.fail("temperature", "needs heat; add [fluid.heat]");
}

TomlReader::Keys boundary_keys() {
  return with_shape_keys({"inside", "two_sided", "slip", "restitution", "friction", "yield_stress", "velocity",
                          "temperature", "ground", "motion", "body"});
}

Boundary read_boundary(const TomlReader& keys, int dimensions) {
  Boundary boundary;
  boundary.shape = read_shape(keys, dimensions, ShapeUse::boundary);
  keys.flag("inside", boundary.inside);
  if (keys.has("inside") && (boundary.shape.plane || boundary.shape.terrain)) {
    keys.fail("inside", "is for closed shapes; the fluid is on the side of the normal here");
  }
  keys.flag("two_sided", boundary.two_sided);
  if (keys.has("two_sided") && boundary.shape.plane) {
    keys.fail("two_sided", "is for surfaces that end; give two planes back to back");
  }
  keys.number("slip", boundary.slip, Range::fraction());
  keys.number("restitution", boundary.restitution, Range::fraction());
  keys.number("friction", boundary.friction, Range::not_negative(""));
  keys.number("yield_stress", boundary.yield_stress, Range::not_negative("Pa"));
  if (keys.has("slip") && (boundary.friction || boundary.yield_stress)) {
    keys.fail("slip", "stands beside friction or yield_stress, which say how it slips; keep one of them");
  }
  keys.vector("velocity", boundary.velocity, dimensions, Range::any("m/s"));
  keys.number("temperature", boundary.temperature, Range::any("the scene's temperature unit"));
  read_ground(keys, boundary);
  read_motion(keys, dimensions, boundary);
  if (keys.has("velocity") && (boundary.motion || boundary.body)) {
    keys.fail("velocity", "is for walls that stay in place; give it as motion.velocity or body.velocity");
  }
  return boundary;
}

// ---- [run] and [output] ----

Run read_run(const TomlReader& root) {
  root.require("run", "add [run] with end_time in s");
  const TomlReader keys = *root.table("run", {"end_time", "max_steps"});
  Run run;
  keys.require("end_time", "give the simulated time to stop at, in s");
  keys.number("end_time", run.end_time, Range::positive("s"));
  long long steps = 0;
  if (keys.whole("max_steps", steps, 1, 1'000'000'000'000)) run.max_steps = steps;
  return run;
}

/// Seconds of "90", "90 s", "5 min" or "1 h"; negative when it is none of these.
double parse_duration(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !(value >= 0 && value <= 1e30)) return -1;
  std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  unit.remove_prefix(std::min(unit.find_first_not_of(' '), unit.size()));
  if (unit.empty() || unit == "s") return value;
  if (unit == "min") return 60 * value;
  if (unit == "h") return 3600 * value;
  return -1;
}

void read_duration(const TomlReader& keys, std::string_view key, double& seconds) {
  const toml::node* node = keys.node(key);
  if (node == nullptr) return;
  if (!node->is_string()) {
    keys.number(key, seconds, Range::not_negative("s, or a string such as \"5 min\""));
    return;
  }
  std::string text;
  keys.text(key, text);
  seconds = parse_duration(text);
  if (seconds < 0)
    keys.fail(key, fmt::format("\"{}\" is no duration; write \"30 s\", \"5 min\" or \"1 h\"", shown(text)));
}

void check_field_names(const TomlReader& keys, const std::vector<std::string>& fields) {
  const auto is_name = [](const std::string& name) {
    return name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
  };
  for (const std::string& field : fields) {
    if (!is_name(field)) keys.fail("fields", fmt::format("\"{}\" is no field; write names like density", shown(field)));
  }
}

constexpr double most_frames = 1e7;

Output read_output(const TomlReader& root) {
  const auto keys =
      root.table("output", {"frames_per_second", "fields", "series_every", "checkpoint_every", "checkpoints_kept"});
  Output output;
  if (!keys) return output;
  keys->number("frames_per_second", output.frames_per_second, Range::not_negative("1/s"));
  keys->texts("fields", output.fields);
  check_field_names(*keys, output.fields);
  keys->number("series_every", output.series_every, Range::not_negative("s"));
  read_duration(*keys, "checkpoint_every", output.checkpoint_every);
  long long kept = output.checkpoints_kept;
  keys->whole("checkpoints_kept", kept, 1, 1000);
  output.checkpoints_kept = static_cast<int>(kept);
  return output;
}

/// Where each key stands.
void note_places(const TomlDocument& document, const toml::node& node, const std::string& name, Scene& scene) {
  if (!name.empty()) scene.places[name] = document.place(node.source());
  const auto note = [&](std::string_view key, const toml::node& inner) {
    note_places(document, inner, name.empty() ? std::string(key) : fmt::format("{}.{}", name, key), scene);
  };
  if (const toml::table* table = node.as_table())
    for (const auto& [key, inner] : *table) note(key.str(), inner);
  if (node.is_array_of_tables())
    for (std::size_t k = 0; k < node.as_array()->size(); ++k) note(std::to_string(k), *node.as_array()->get(k));
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& file, const std::vector<std::string>& overrides) {
  const TomlDocument document = parse_toml(text, file, overrides);
  const TomlReader root(document, document.root, "",
                        {"scene", "fluid", "boundary", "vent", "outflow", "run", "output", "numerics"});
  Scene scene;
  scene.file = file;
  scene.text = document.text;
  read_head(root, scene);
  scene.fluid = read_fluid(root, scene.dimensions);
  scene.numerics = read_numerics(root, scene);
  for (const TomlReader& keys : root.tables("boundary", boundary_keys())) {
    scene.boundaries.push_back(read_boundary(keys, scene.dimensions));
    check_support(keys, scene.boundaries.back(), scene);
  }
  read_vents(root, scene);
  scene.run = read_run(root);
  scene.output = read_output(root);
  note_places(document, document.root, "", scene);
  if (scene.run.end_time * scene.output.frames_per_second > most_frames)
    refuse(scene, "output.frames_per_second", "makes more than ten million frames until run.end_time; lower it");
  features_of(scene);  // refuses what does not go together
  return scene;
}

Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_scene(read_text(file), file.string(), overrides);
}

std::filesystem::path locate(const Scene& scene, const std::string& path) {
  const std::filesystem::path asked(path);
  if (asked.is_absolute()) return asked;
  const std::filesystem::path folder = std::filesystem::path(scene.file).parent_path();
  const std::filesystem::path beside = folder / asked, above = folder / ".." / asked;
  std::error_code error;
  if (!std::filesystem::exists(beside, error) && std::filesystem::exists(above, error)) return above.lexically_normal();
  return beside;
}

std::filesystem::path find_file(const Scene& scene, const std::string& path, const Place& place) {
  const std::filesystem::path file = locate(scene, path);
  std::error_code error;
  if (std::filesystem::exists(file, error)) return file;
  const bool fetched = path.find("models/") != std::string::npos;
  throw Error(ExitCode::geometry,
              one_line(fmt::format("{}: no such file as {}: {}", text_of(place), file.string(),
                                   fetched ? "run scripts/models to fetch the models" : "check the path")));
}

}  // namespace molten
