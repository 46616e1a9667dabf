// Walls and random numbers that the tests of contact share.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "core/boundary/contact.h"
#include "core/boundary/shapes.h"

namespace molten::contact_test {

template <int Dim> struct Random {
  explicit Random(unsigned seed) : engine(seed) {}
  double uniform(double lo = -1, double hi = 1) { return lo + (hi - lo) * std::generate_canonical<double, 53>(engine); }
  /// Between lo and hi, all powers of ten alike.
  double scale(double lo, double hi) { return lo * std::pow(hi / lo, uniform(0, 1)); }
  Point<Dim> point(double half = 1) {
    return Point<Dim>::NullaryExpr([&](Eigen::Index) { return uniform(-half, half); });
  }
  Point<Dim> unit() {
    for (Point<Dim> p = point();; p = point())
      if (p.norm() > 0.1 && p.norm() < 1) return p.normalized();
  }
  std::mt19937_64 engine;
};

inline Wall<3> triangle(const Point<3>& a, const Point<3>& b, const Point<3>& c, Response response = {}) {
  Wall<3> wall;
  wall.vertices = {a, b, c};
  wall.facets = {{0, 1, 2}};
  wall.response = response;
  return wall;
}

template <int Dim> Wall<Dim> plane(const Point<Dim>& point, const Point<Dim>& normal, Response response = {}) {
  Wall<Dim> wall;
  wall.is_plane = true;
  wall.plane_point = point;
  wall.plane_normal = normal;
  wall.response = response;
  return wall;
}

/// Segments through the points in turn; the front is to the left.
inline Wall<2> chain(std::vector<Point<2>> points, bool closed, Response response = {}) {
  Wall<2> wall;
  const auto n = static_cast<std::int32_t>(points.size());
  for (std::int32_t i = 0; i + 1 < n; ++i) wall.facets.push_back({i, i + 1});
  if (closed) wall.facets.push_back({n - 1, 0});
  wall.vertices = std::move(points);
  wall.response = response;
  return wall;
}

/// The surface of the box −half..half; normals inwards (a tank) or outwards (an obstacle).
inline Wall<3> box(double half, bool inwards, Response response = {}) {
  Wall<3> wall;
  for (int i = 0; i < 8; ++i) wall.vertices.push_back(half * Point<3>(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  wall.facets = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};  // outwards
  if (inwards)
    for (auto& f : wall.facets) std::swap(f[1], f[2]);
  wall.response = response;
  return wall;
}

/// The surface of a closed shape by edges no longer than this; normals inwards or outwards.
inline Wall<3> shell(const Shape& shape, double edge, bool inwards) {
  TriangleMesh mesh = tessellate(shape, edge);
  Wall<3> wall;
  wall.vertices = std::move(mesh.vertices);
  wall.facets = std::move(mesh.triangles);
  if (inwards)
    for (auto& f : wall.facets) std::swap(f[1], f[2]);
  return wall;
}

inline Wall<3> ball(double radius, double edge) {
  Shape shape;
  shape.sphere = Sphere{{0, 0, 0}, radius};
  return shell(shape, edge, false);
}

inline Wall<2> square(double half, bool inwards, Response response = {}) {
  std::vector<Point<2>> p = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
  if (!inwards) std::swap(p[1], p[3]);
  return chain(p, true, response);
}

/// A terrain of n × n cells of two triangles each over 0..n, front side up.
template <class Height> Wall<3> terrain(int n, Height&& height, Response response = {}) {
  Wall<3> wall;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) wall.vertices.push_back({double(i), double(j), height(i, j)});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      wall.facets.push_back({a, b, d});
      wall.facets.push_back({a, d, c});
    }
  wall.response = response;
  return wall;
}

}  // namespace molten::contact_test
