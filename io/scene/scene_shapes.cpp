#include "io/scene/scene_shapes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace molten {
namespace {

using Point = std::array<double, 2>;

constexpr std::array<std::string_view, 9> shape_keys = {"mesh",    "sphere", "box",   "cylinder", "cone",
                                                        "polygon", "text",   "plane", "terrain"};
constexpr std::array<std::string_view, 3> mesh_keys = {"height", "position", "rotation"};
constexpr std::array<std::string_view, 3> terrain_keys = {"cell_size", "scale", "origin"};

void read_length(const TomlReader& table, std::string_view key, double& length) {
  table.require(key, "give it in m");
  table.number(key, length, Range::positive("m"));
}

MeshFile read_mesh_keys(const TomlReader& table) {
  MeshFile mesh;
  mesh.place = table.place("mesh");
  table.text("mesh", mesh.path);
  table.number("height", mesh.height, Range::positive("m"));
  mesh.placed = table.numbers("position", mesh.position, Range::any("m"));
  table.numbers("rotation", mesh.rotation, Range{-360, 360, true, "degrees"});
  return mesh;
}

Terrain read_terrain_keys(const TomlReader& table) {
  Terrain terrain;
  terrain.place = table.place("terrain");
  table.text("terrain", terrain.path);
  table.number("cell_size", terrain.cell_size, Range::positive("m"));
  table.number("scale", terrain.scale, Range::positive(""));
  if (std::array<double, 2> origin{}; table.numbers("origin", origin, Range::any("m"))) terrain.origin = origin;
  return terrain;
}

Sphere read_sphere(const TomlReader& table, int dimensions) {
  const TomlReader keys = *table.table("sphere", {"center", "radius"});
  Sphere sphere;
  read_point(keys, "center", sphere.center, dimensions);
  read_length(keys, "radius", sphere.radius);
  return sphere;
}

Cylinder read_cylinder(const TomlReader& table, int dimensions) {
  const TomlReader keys = *table.table("cylinder", {"base", "radius", "height"});
  Cylinder cylinder;
  read_point(keys, "base", cylinder.base, dimensions);
  read_length(keys, "radius", cylinder.radius);
  read_length(keys, "height", cylinder.height);
  return cylinder;
}

Cone read_cone(const TomlReader& table, int dimensions) {
  const TomlReader keys = *table.table("cone", {"base", "radius", "top_radius", "height"});
  Cone cone;
  read_point(keys, "base", cone.base, dimensions);
  keys.require("radius", "give the radius of the base in m");
  keys.number("radius", cone.radius, Range::not_negative("m"));
  keys.number("top_radius", cone.top_radius, Range::not_negative("m"));
  if (cone.radius == 0 && cone.top_radius == 0) keys.fail("radius", "0 at both ends; make one radius positive");
  read_length(keys, "height", cone.height);
  return cone;
}

// ---- polygons ----

double cross(const Point& origin, const Point& a, const Point& b) {
  return (a[0] - origin[0]) * (b[1] - origin[1]) - (a[1] - origin[1]) * (b[0] - origin[0]);
}

double signed_area(const std::vector<Point>& points) {
  double twice = 0;
  for (std::size_t i = 0; i < points.size(); ++i) twice += cross(points[0], points[i], points[(i + 1) % points.size()]);
  return twice / 2;
}

bool within(const Point& point, const Point& a, const Point& b) {
  return std::min(a[0], b[0]) <= point[0] && point[0] <= std::max(a[0], b[0]) && std::min(a[1], b[1]) <= point[1] &&
         point[1] <= std::max(a[1], b[1]);
}

/// Whether the segments a b and c d share a point.
bool touch(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double a_side = cross(c, d, a), b_side = cross(c, d, b), c_side = cross(a, b, c), d_side = cross(a, b, d);
  if (((a_side > 0 && b_side < 0) || (a_side < 0 && b_side > 0)) &&
      ((c_side > 0 && d_side < 0) || (c_side < 0 && d_side > 0))) {
    return true;
  }
  return (a_side == 0 && within(a, c, d)) || (b_side == 0 && within(b, c, d)) || (c_side == 0 && within(c, a, b)) ||
         (d_side == 0 && within(d, a, b));
}

/// Throws unless the edges meet at common corners alone.
void check_simple(const TomlReader& keys, const std::vector<Point>& points) {
  const std::size_t count = points.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (points[i] == points[(i + 1) % count]) {
      keys.fail("points", fmt::format("point {} stands twice in a row; the outline closes by itself", (i + 1) % count));
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 2; j < count; ++j) {
      if (i == 0 && j == count - 1) continue;  // neighbours around the end
      if (touch(points[i], points[i + 1], points[j], points[(j + 1) % count])) {
        keys.fail("points", fmt::format("the edges from points {} and {} cross or touch; untangle them", i, j));
      }
    }
  }
}

Polygon read_polygon(const TomlReader& table, int dimensions) {
  constexpr std::size_t most_points = 2000;  // checked edge against edge
  const TomlReader keys = *table.table("polygon", {"points", "bottom", "top", "open"});
  Polygon polygon;
  keys.require("points", "give [[x, y], [x, y], ...] in m");
  keys.points("points", polygon.points);
  if (polygon.points.size() < 3 || polygon.points.size() > most_points) {
    keys.fail("points", fmt::format("has {} points; give 3 to {}", polygon.points.size(), most_points));
  }
  check_simple(keys, polygon.points);
  const double area = signed_area(polygon.points);
  if (area == 0) keys.fail("points", "encloses nothing; give an outline with an area");
  if (area < 0) std::reverse(polygon.points.begin(), polygon.points.end());
  if (dimensions == 3 && keys.has("open")) keys.fail("open", "is for 2-D scenes; take a mesh that is open");
  keys.flag("open", polygon.open);
  for (const std::string_view key : {"bottom", "top"}) {
    if (dimensions == 2 && keys.has(key)) keys.fail(key, "is for 3-D scenes; leave it out");
    if (dimensions == 3) keys.require(key, "give the z of both ends, bottom and top, in m");
  }
  keys.number("bottom", polygon.bottom, Range::any("m"));
  keys.number("top", polygon.top, Range::any("m"));
  if (dimensions == 3 && polygon.bottom >= polygon.top) keys.fail("bottom", "is not below top; exchange them");
  return polygon;
}

Text read_text(const TomlReader& table) {
  const TomlReader keys = *table.table("text", {"string", "font", "height", "depth", "position", "rotation"});
  Text text;
  keys.require("string", "give the letters");
  keys.text("string", text.string);
  keys.require("font", "give a font file, such as DejaVuSans-Bold.ttf");
  keys.text("font", text.font);
  read_length(keys, "height", text.height);
  read_length(keys, "depth", text.depth);
  keys.numbers("position", text.position, Range::any("m"));
  keys.numbers("rotation", text.rotation, Range{-360, 360, true, "degrees"});
  return text;
}

Plane read_plane(const TomlReader& table, int dimensions) {
  const TomlReader keys = *table.table("plane", {"point", "normal"});
  Plane plane;
  read_point(keys, "point", plane.point, dimensions);
  keys.require("normal", "give the direction from the plane into the fluid");
  keys.vector("normal", plane.normal, dimensions, Range::any(""));
  if (std::hypot(plane.normal[0], plane.normal[1], plane.normal[2]) < 1e-12) {
    keys.fail("normal", "has no length; give the direction from the plane into the fluid");
  }
  return plane;
}

// ---- which shape ----

/// The only shape key of the table.
std::string_view find_shape_key(const TomlReader& table) {
  std::vector<std::string_view> present;
  for (const std::string_view key : shape_keys) {
    if (table.has(key)) present.push_back(key);
  }
  if (present.empty()) table.fail("", fmt::format("has no shape; add one of {}", fmt::join(shape_keys, ", ")));
  if (present.size() > 1) {
    table.fail(present[1], fmt::format("is a second shape beside {}; keep one of them", present[0]));
  }
  return present[0];
}

void check_allowed(const TomlReader& table, std::string_view shape, int dimensions, ShapeUse use) {
  if (use == ShapeUse::fluid && (shape == "plane" || shape == "terrain")) {
    table.fail(shape, "encloses nothing that could be filled; put it into a [[boundary]]");
  }
  if (dimensions == 2 && (shape == "mesh" || shape == "text" || shape == "terrain")) {
    table.fail(shape, "is for 3-D scenes; use another shape or dimensions = 3");
  }
}

/// The keys beside `mesh` and `terrain` mean nothing without them.
void check_companions(const TomlReader& table, std::string_view shape) {
  for (const std::string_view key : mesh_keys) {
    if (shape != "mesh" && table.has(key)) table.fail(key, "goes with mesh; leave it out");
  }
  for (const std::string_view key : terrain_keys) {
    if (shape != "terrain" && table.has(key)) table.fail(key, "goes with terrain; leave it out");
  }
}

}  // namespace

TomlReader::Keys with_shape_keys(TomlReader::Keys keys) {
  keys.insert(keys.end(), shape_keys.begin(), shape_keys.end());
  keys.insert(keys.end(), mesh_keys.begin(), mesh_keys.end());
  keys.insert(keys.end(), terrain_keys.begin(), terrain_keys.end());
  return keys;
}

void read_point(const TomlReader& table, std::string_view key, std::array<double, 3>& point, int dimensions) {
  table.require(key, dimensions == 3 ? "give [x, y, z] in m" : "give [x, y] in m");
  table.vector(key, point, dimensions, Range::any("m"));
}

bool has_shape(const TomlReader& table) {
  return std::any_of(shape_keys.begin(), shape_keys.end(), [&](std::string_view key) { return table.has(key); });
}

Box read_box(const TomlReader& table, std::string_view key, int dimensions) {
  const TomlReader keys = *table.table(key, {"min", "max"});
  Box box;
  read_point(keys, "min", box.min, dimensions);
  read_point(keys, "max", box.max, dimensions);
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimensions); ++axis) {
    if (box.min[axis] < box.max[axis]) continue;
    keys.fail("min", fmt::format("is not below max along {}; exchange or widen them", "xyz"[axis]));
  }
  return box;
}

Shape read_shape(const TomlReader& table, int dimensions, ShapeUse use) {
  const std::string_view key = find_shape_key(table);
  check_allowed(table, key, dimensions, use);
  check_companions(table, key);
  Shape shape;
  shape.place = table.place(key);
  if (key == "mesh") shape.mesh = read_mesh_keys(table);
  if (key == "sphere") shape.sphere = read_sphere(table, dimensions);
  if (key == "box") shape.box = read_box(table, "box", dimensions);
  if (key == "cylinder") shape.cylinder = read_cylinder(table, dimensions);
  if (key == "cone") shape.cone = read_cone(table, dimensions);
  if (key == "polygon") {
    shape.polygon = read_polygon(table, dimensions);
    if (shape.polygon->open && use == ShapeUse::fluid) table.fail(key, "is open; fluid needs a closed one");
  }
  if (key == "text") shape.text = read_text(table);
  if (key == "plane") shape.plane = read_plane(table, dimensions);
  if (key == "terrain") shape.terrain = read_terrain_keys(table);
  return shape;
}

}  // namespace molten
