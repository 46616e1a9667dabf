#include "core/boundary/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "core/boundary/polygon.h"
#include "core/error.h"

namespace molten {
namespace {

using std::numbers::pi;
using Triangle = std::array<std::int32_t, 3>;

[[noreturn]] void refuse(const Shape& shape, const std::string& what) {
  const Place& p = shape.place;
  std::string where;
  if (p.line > 0) where = p.file + ":" + std::to_string(p.line) + ":" + std::to_string(p.column) + ": ";
  throw Error(ExitCode::usage, where + what);
}

Vec3 vec(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

void require_positive(const Shape& shape, double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value)) refuse(shape, std::string(what) + " must be positive (m)");
}

int parts(double length, double edge, int least, int most) {
  const double wanted = edge > 0 ? std::ceil(length / edge * (1 - 1e-12)) : most;
  return static_cast<int>(std::clamp(wanted, static_cast<double>(least), static_cast<double>(most)));
}

// ---- sphere -------------------------------------------------------------------------------------------------------

TriangleMesh icosahedron() {
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

/// Each side of the icosahedron is cut in `frequency` parts, and all vertices are put on the unit sphere.
TriangleMesh geodesic(int frequency) {
  const TriangleMesh base = icosahedron();
  TriangleMesh mesh;
  // A point of a face is a whole-number mix of its corners; points on shared sides have the same mix from either face.
  std::map<std::array<std::pair<int, int>, 3>, std::int32_t> known;
  for (const Triangle& face : base.triangles) {
    const auto vertex = [&](int i, int j) {
      const int mix[3] = {frequency - i - j, i, j};
      std::array<std::pair<int, int>, 3> key;
      for (int k = 0; k < 3; ++k) key[k] = mix[k] ? std::pair(face[k], mix[k]) : std::pair(-1, 0);
      std::sort(key.begin(), key.end());
      const auto [at, is_new] = known.try_emplace(key, static_cast<std::int32_t>(mesh.vertices.size()));
      if (is_new) {
        Vec3 point = Vec3::Zero();
        for (const auto& [corner, weight] : key)  // in key order: the same bits from either face
          if (weight) point += weight * base.vertices[corner];
        mesh.vertices.push_back(point.normalized());
      }
      return at->second;
    };
    for (int i = 0; i < frequency; ++i)
      for (int j = 0; i + j < frequency; ++j) {
        mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
        if (i + j < frequency - 1) mesh.triangles.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      }
  }
  return mesh;
}

TriangleMesh tessellate_sphere(const Sphere& sphere, double edge) {
  // The icosahedron's side is 1.107 radians; flat cutting stretches the middle of a face by at most 1.26.
  TriangleMesh mesh = geodesic(parts(1.26 * 1.0515 * sphere.radius, edge, 4, 256));
  for (Vec3& v : mesh.vertices) v = vec(sphere.center) + sphere.radius * v;
  return mesh;
}

// ---- extrusions: polygon, box, cylinder, cone ----------------------------------------------------------------------

/// Walls between two rings of n vertices each; `bottom` and `top` are the rings' first vertices.
void add_walls(TriangleMesh& mesh, int n, std::int32_t bottom, std::int32_t top) {
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    mesh.triangles.push_back({bottom + i, bottom + j, top + j});
    mesh.triangles.push_back({bottom + i, top + j, top + i});
  }
}

std::vector<Vec2> circle(const Vec2& center, double radius, double edge) {
  const int n = parts(2 * pi * radius, edge, 16, 1 << 20);
  std::vector<Vec2> points;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * pi * i / n;
    points.emplace_back(center + radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  return points;
}

/// A disc at each end, fanned from its centre; an end of radius 0 is the centre alone.
TriangleMesh tessellate_cone(const Cone& cone, double edge) {
  const std::vector<Vec2> unit = circle(Vec2::Zero(), 1, edge / std::max(cone.radius, cone.top_radius));
  const int n = static_cast<int>(unit.size());
  TriangleMesh mesh;
  const auto add_ring = [&](double radius, double z) {
    const auto center = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.push_back(vec(cone.base) + Vec3(0, 0, z));
    if (radius > 0)
      for (const Vec2& u : unit) mesh.vertices.push_back(vec(cone.base) + Vec3(radius * u.x(), radius * u.y(), z));
    return center;
  };
  const auto add_fan = [&](std::int32_t center, std::int32_t ring, bool up) {
    for (int i = 0; i < n; ++i) {
      const std::int32_t a = ring + i, b = ring + (i + 1) % n;
      mesh.triangles.push_back(up ? Triangle{center, a, b} : Triangle{center, b, a});
    }
  };
  const std::int32_t low = add_ring(cone.radius, 0), high = add_ring(cone.top_radius, cone.height);
  if (cone.radius > 0) add_fan(low, low + 1, false);
  if (cone.top_radius > 0) add_fan(high, high + 1, true);
  if (cone.radius > 0 && cone.top_radius > 0)
    add_walls(mesh, n, low + 1, high + 1);
  else if (cone.radius > 0)
    add_fan(high, low + 1, true);
  else
    add_fan(low, high + 1, false);
  return mesh;
}

std::vector<Vec2> rectangle(double left, double bottom, double right, double top) {
  return {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
}

std::vector<Vec2> polygon_points(const Shape& shape) {
  std::vector<Vec2> points;
  for (const auto& p : shape.polygon->points) points.emplace_back(p[0], p[1]);
  const std::string defect = polygon_defect(points);
  if (!defect.empty()) refuse(shape, "the polygon " + defect);
  if (twice_area(points) < 0) std::reverse(points.begin(), points.end());
  return points;
}

// ---- checks --------------------------------------------------------------------------------------------------------

void check_cone(const Shape& shape, const Cone& cone) {
  require_positive(shape, cone.height, "height");
  if (!(cone.radius >= 0 && cone.top_radius >= 0)) refuse(shape, "radius and top_radius must not be negative (m)");
  require_positive(shape, std::max(cone.radius, cone.top_radius), "radius or top_radius");
}

void check(const Shape& shape, int dimensions) {
  if (shape.sphere) require_positive(shape, shape.sphere->radius, "radius");
  if (shape.box)
    for (int k = 0; k < dimensions; ++k)
      if (!(shape.box->min[k] < shape.box->max[k])) refuse(shape, "box: min must be below max along every axis (m)");
  if (shape.cylinder) {
    require_positive(shape, shape.cylinder->radius, "radius");
    require_positive(shape, shape.cylinder->height, "height");
  }
  if (shape.cone) check_cone(shape, *shape.cone);
  if (shape.polygon && dimensions == 3 && !(shape.polygon->bottom < shape.polygon->top))
    refuse(shape, "polygon: bottom must be below top (m)");
}

}  // namespace

TriangleMesh tessellate(const Shape& shape, double edge) {
  check(shape, 3);
  if (shape.sphere) return tessellate_sphere(*shape.sphere, edge);
  if (shape.box) {
    const auto &low = shape.box->min, &high = shape.box->max;
    return extrude({rectangle(low[0], low[1], high[0], high[1])}, low[2], high[2]);
  }
  if (shape.cylinder) {
    const Cylinder& c = *shape.cylinder;
    return tessellate_cone({c.base, c.radius, c.radius, c.height}, edge);
  }
  if (shape.cone) return tessellate_cone(*shape.cone, edge);
  if (shape.polygon) return extrude({polygon_points(shape)}, shape.polygon->bottom, shape.polygon->top);
  refuse(shape, "needs one of sphere, box, cylinder, cone, polygon");
}

std::vector<Vec2> outline(const Shape& shape, double edge) {
  check(shape, 2);
  if (shape.sphere) return circle(vec(shape.sphere->center).head<2>(), shape.sphere->radius, edge);
  if (shape.box) return rectangle(shape.box->min[0], shape.box->min[1], shape.box->max[0], shape.box->max[1]);
  if (shape.cylinder) {
    const Cylinder& c = *shape.cylinder;
    return rectangle(c.base[0] - c.radius, c.base[1], c.base[0] + c.radius, c.base[1] + c.height);
  }
  if (shape.cone) {
    const Cone& c = *shape.cone;
    const double x = c.base[0], low = c.base[1], high = low + c.height;
    if (c.top_radius == 0) return {{x - c.radius, low}, {x + c.radius, low}, {x, high}};
    if (c.radius == 0) return {{x, low}, {x + c.top_radius, high}, {x - c.top_radius, high}};
    return {{x - c.radius, low}, {x + c.radius, low}, {x + c.top_radius, high}, {x - c.top_radius, high}};
  }
  if (shape.polygon) return polygon_points(shape);
  refuse(shape, "needs one of sphere, box, cylinder, cone, polygon in two dimensions");
}

TriangleMesh extrude(const std::vector<std::vector<Vec2>>& rings, double bottom, double top) {
  TriangleMesh mesh;
  for (const double z : {bottom, top})
    for (const std::vector<Vec2>& ring : rings)
      for (const Vec2& p : ring) mesh.vertices.emplace_back(p.x(), p.y(), z);
  const auto n = static_cast<std::int32_t>(mesh.vertices.size() / 2);
  for (const Triangle& t : clip_ears(rings)) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  std::int32_t first = 0;
  for (const std::vector<Vec2>& ring : rings) {
    add_walls(mesh, static_cast<int>(ring.size()), first, n + first);
    first += static_cast<std::int32_t>(ring.size());
  }
  return mesh;
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.empty()) return 0;
  // Relative to a vertex: far from the origin the parts would be huge and cancel.
  const Vec3 origin = mesh.vertices[mesh.triangles[0][0]];
  double six = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - origin, b = mesh.vertices[t[1]] - origin, c = mesh.vertices[t[2]] - origin;
    six += a.dot(b.cross(c));
  }
  return six / 6;
}

}  // namespace molten
