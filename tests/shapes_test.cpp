// Shapes without files: closed, outward, with the volumes and areas of geometry.
#include "core/boundary/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/boundary/polygon.h"
#include "core/error.h"
#include "io/geometry/mesh_file.h"

namespace molten::shapes_test {
namespace {

using std::numbers::pi;
using Points = std::vector<std::array<double, 2>>;

template <class T> Shape shape_of(std::optional<T> Shape::*member, const T& value) {
  Shape shape;
  shape.*member = value;
  return shape;
}

Shape polygon(const Points& points, double bottom = 0, double top = 1) {
  return shape_of(&Shape::polygon, Polygon{points, bottom, top});
}

void expect_closed(const Shape& shape, double edge, double volume, double tolerance) {
  const TriangleMesh mesh = tessellate(shape, edge);
  EXPECT_NO_THROW(require_closed(mesh, "shape"));
  EXPECT_EQ(inspect(mesh).degenerate_triangles, 0u);
  EXPECT_NEAR(signed_volume(mesh), volume, tolerance * volume);
  const std::vector<Vec2> points = outline(shape, edge);
  EXPECT_EQ(polygon_defect(points), "");
  EXPECT_GT(twice_area(points), 0);
}

std::string refusal(const Shape& shape, int dimensions = 3) {
  try {
    dimensions == 3 ? void(tessellate(shape, 0.1)) : void(outline(shape, 0.1));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    return error.what();
  }
  return "";
}

TEST(Shapes, HaveTheirVolumes) {
  expect_closed(shape_of(&Shape::sphere, Sphere{{1, 2, 3}, 2}), 0.1, 32 * pi / 3, 1e-3);
  expect_closed(shape_of(&Shape::box, Box{{-1, 0, 1}, {1, 3, 5}}), 0.1, 24, 1e-14);
  expect_closed(shape_of(&Shape::cylinder, Cylinder{{1, 2, 3}, 0.5, 2}), 0.05, pi / 2, 2e-3);
  expect_closed(shape_of(&Shape::cone, Cone{{1, 2, 3}, 1, 0, 3}), 0.05, pi, 2e-3);
  expect_closed(shape_of(&Shape::cone, Cone{{1, 2, 3}, 0, 1, 3}), 0.05, pi, 2e-3);
  expect_closed(shape_of(&Shape::cone, Cone{{1, 2, 3}, 2, 1, 3}), 0.05, 7 * pi, 2e-3);
  expect_closed(polygon({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}), 1, 5, 1e-14);
}

TEST(Shapes, SphereVerticesAreOnTheSphereAndEdgesAreShort) {
  for (const double edge : {10.0, 0.7, 0.2, 0.05}) {
    const TriangleMesh mesh = tessellate(shape_of(&Shape::sphere, Sphere{{1, 2, 3}, 1}), edge);
    for (const Vec3& v : mesh.vertices) ASSERT_NEAR((v - Vec3(1, 2, 3)).norm(), 1, 1e-14);
    double longest = 0;
    for (const auto& t : mesh.triangles)
      for (int k = 0; k < 3; ++k)
        longest = std::max(longest, (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm());
    EXPECT_LE(longest, edge);
    EXPECT_EQ(mesh.vertices.size(), mesh.triangles.size() / 2 + 2);  // Euler
  }
}

TEST(Shapes, VolumeIsExactFarFromTheOrigin) {
  const TriangleMesh mesh = tessellate(shape_of(&Shape::box, Box{{1e6, 1e6, 1e6}, {1e6 + 1, 1e6 + 1, 1e6 + 1}}), 1);
  EXPECT_NEAR(signed_volume(mesh), 1, 1e-9);
}

TEST(Shapes, ConcavePolygonsAreCut) {
  Points comb;  // teeth, with straight corners
  for (int i = 0; i < 40; ++i) comb.push_back({i * 1.0, 0});
  for (int i = 39; i >= 0; --i) {
    comb.push_back({i + 0.0, 3});
    comb.push_back({i - 0.5, 1});
  }
  const Shape shape = polygon(comb);
  const std::vector<Vec2> points = outline(shape, 1);
  const auto triangles = clip_ears(points);
  ASSERT_EQ(triangles.size(), points.size() - 2);
  double area = 0;
  for (const auto& t : triangles) {
    const double part = twice_area({points[t[0]], points[t[1]], points[t[2]]});
    EXPECT_GT(part, 0);
    area += part;
  }
  EXPECT_NEAR(area, twice_area(points), 1e-12 * area);
  EXPECT_NO_THROW(require_closed(tessellate(shape, 1), "comb"));
}

TEST(Shapes, ClockwisePolygonsAreTurned) {
  EXPECT_NEAR(signed_volume(tessellate(polygon({{0, 1}, {1, 1}, {1, 0}, {0, 0}}), 1)), 1, 1e-14);
  EXPECT_NEAR(twice_area(outline(polygon({{0, 1}, {1, 1}, {1, 0}, {0, 0}}), 1)), 2, 1e-14);
}

TEST(Shapes, BadPolygonsAreRefused) {
  EXPECT_NE(refusal(polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1}})).find("crosses or touches itself"), std::string::npos);
  for (const int dimensions : {2, 3}) {
    EXPECT_NE(refusal(polygon({}), dimensions), "");
    EXPECT_NE(refusal(polygon({{0, 0}, {1, 0}}), dimensions), "");
    EXPECT_NE(refusal(polygon({{0, 0}, {1, 0}, {2, 0}}), dimensions), "");
    EXPECT_NE(refusal(polygon({{0, 0}, {1, 0}, {1, 0}, {0, 1}}), dimensions), "");
    EXPECT_NE(refusal(polygon({{0, 0}, {2, 0}, {1, 0}, {1, 1}}), dimensions), "");
    EXPECT_NE(refusal(polygon({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}), dimensions), "");  // touches its own side
    EXPECT_NE(refusal(polygon({{0, 0}, {1, 0}, {NAN, 1}}), dimensions), "");
  }
  EXPECT_NE(refusal(polygon({{0, 0}, {1, 0}, {0, 1}}, 1, 1)), "");
}

TEST(Shapes, BadNumbersAreRefusedWithTheirPlace) {
  Shape sphere = shape_of(&Shape::sphere, Sphere{{0, 0, 0}, -1});
  sphere.place = {"a.toml", 3, 7};
  EXPECT_EQ(refusal(sphere).find("a.toml:3:7: radius"), 0u);
  EXPECT_NE(refusal(shape_of(&Shape::sphere, Sphere{{0, 0, 0}, NAN})), "");
  EXPECT_NE(refusal(shape_of(&Shape::box, Box{{0, 0, 0}, {1, 1, 0}})), "");
  EXPECT_EQ(refusal(shape_of(&Shape::box, Box{{0, 0, 0}, {1, 1, 0}}), 2), "");
  EXPECT_NE(refusal(shape_of(&Shape::cylinder, Cylinder{{0, 0, 0}, 1, 0})), "");
  EXPECT_NE(refusal(shape_of(&Shape::cone, Cone{{0, 0, 0}, 0, 0, 1})), "");
  EXPECT_NE(refusal(shape_of(&Shape::cone, Cone{{0, 0, 0}, -1, 1, 1})), "");
  EXPECT_NE(refusal(Shape{}), "");
}

TEST(Shapes, OutlinesHaveTheirAreas) {
  EXPECT_NEAR(twice_area(outline(shape_of(&Shape::sphere, Sphere{{1, 2, 0}, 1}), 0.01)) / 2, pi, 1e-4);
  EXPECT_NEAR(twice_area(outline(shape_of(&Shape::box, Box{{1, 2, 0}, {2, 4, 0}}), 0.01)) / 2, 2, 1e-14);
  EXPECT_NEAR(twice_area(outline(shape_of(&Shape::cylinder, Cylinder{{1, 2, 0}, 0.5, 3}), 0.01)) / 2, 3, 1e-14);
  EXPECT_NEAR(twice_area(outline(shape_of(&Shape::cone, Cone{{1, 2, 0}, 1, 0, 3}), 0.01)) / 2, 3, 1e-14);
  EXPECT_NEAR(twice_area(outline(shape_of(&Shape::cone, Cone{{1, 2, 0}, 1, 0.5, 3}), 0.01)) / 2, 4.5, 1e-14);
}

}  // namespace
}  // namespace molten::shapes_test
