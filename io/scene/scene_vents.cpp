// [[vent]] and [[outflow]] of a scene file.
#include <fmt/format.h>

#include <cmath>

#include "io/scene/scene_sections.h"
#include "io/scene/scene_shapes.h"

namespace molten {
namespace {

void read_direction(const TomlReader& keys, int dimensions, std::array<double, 3>& normal, std::string_view where) {
  normal = {};
  keys.require("normal", fmt::format("give the direction {}", where));
  keys.vector("normal", normal, dimensions, Range::any(""));
  if (std::hypot(normal[0], normal[1], normal[2]) < 1e-12)
    keys.fail("normal", fmt::format("has no length; give the direction {}", where));
}

void read_disc(const TomlReader& vent_keys, int dimensions, Vent& vent) {
  const TomlReader keys = *vent_keys.table("disc", {"centre", "normal", "radius"});
  read_point(keys, "centre", vent.centre, dimensions);
  read_direction(keys, dimensions, vent.normal, "that the fluid goes");
  keys.require("radius", "give it in m");
  keys.number("radius", vent.radius, Range::positive("m"));
}

/// `table` = [[t, rate], ...] or [[t, rate, temperature], ...], or `rate` and `temperature` alone.
void read_table(const TomlReader& keys, bool heat, int dimensions, Vent& vent) {
  const char* unit = dimensions == 3 ? "m³/s" : "m²/s";
  const std::size_t columns = heat ? 3 : 2;
  std::vector<std::vector<double>> rows;
  if (keys.rows("table", rows, {columns}, heat ? "[t, rate, temperature]" : "[t, rate]")) {
    if (keys.has("rate") || keys.has("temperature")) keys.fail("table", "stands beside rate or temperature; keep one");
    if (rows.empty()) keys.fail("table", "is empty; give at least one row");
  } else {
    keys.require("rate", fmt::format("give how much fluid enters in {}, or a table", unit));
    if (heat) keys.require("temperature", "give what the fluid enters with, or a table");
    auto& row = rows.emplace_back(columns, 0.0);
    keys.number("rate", row[1], Range::not_negative(unit));
    if (heat) keys.number("temperature", row[2], Range::any("the scene's temperature unit"));
  }
  if (!heat && keys.has("temperature")) keys.fail("temperature", "needs heat; add [fluid.heat]");
  for (const auto& row : rows) {
    if (row[1] < 0) keys.fail("table", fmt::format("has the rate {}; give 0 or more", row[1]));
    if (!vent.table.empty() && row[0] <= vent.table.back().time)
      keys.fail("table", fmt::format("the time {} is not later than the one before; order the rows by time", row[0]));
    vent.table.push_back({row[0], row[1], heat ? row[2] : 0.0});
  }
}

Vent read_vent(const TomlReader& keys, const Scene& scene) {
  Vent vent;
  vent.place = keys.place();
  if (keys.has("disc") == keys.has("mesh")) keys.fail("disc", "give either a disc or a mesh");
  if (keys.has("disc")) read_disc(keys, scene.dimensions, vent);
  if (keys.has("mesh")) vent.mesh = read_shape(keys, scene.dimensions, ShapeUse::boundary).mesh;
  read_table(keys, scene.fluid.heat.has_value(), scene.dimensions, vent);
  return vent;
}

Plane read_outflow(const TomlReader& outflow_keys, int dimensions) {
  outflow_keys.require("plane", "give { point, normal }");
  const TomlReader keys = *outflow_keys.table("plane", {"point", "normal"});
  Plane plane;
  read_point(keys, "point", plane.point, dimensions);
  read_direction(keys, dimensions, plane.normal, "to the side where fluid is removed");
  return plane;
}

}  // namespace

void read_vents(const TomlReader& root, Scene& scene) {
  const TomlReader::Keys vent_keys = {"disc", "mesh", "height", "position", "rotation", "rate", "temperature", "table"};
  for (const TomlReader& keys : root.tables("vent", vent_keys)) scene.vents.push_back(read_vent(keys, scene));
  for (const TomlReader& keys : root.tables("outflow", {"plane"}))
    scene.outflows.push_back(read_outflow(keys, scene.dimensions));
}

}  // namespace molten
