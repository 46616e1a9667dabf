// What `molten check` says of bad surfaces, with places; and leaks.
#include "io/geometry/mesh_defects.h"

#include <gtest/gtest.h>

#include "core/boundary/shapes.h"
#include "io/geometry/leak.h"
#include "tests/contact_shapes.h"

namespace molten::mesh_defects_test {
namespace {

TriangleMesh ball(const Vec3& centre = {1, 2, 3}, double radius = 0.5) {
  Shape shape;
  shape.sphere = Sphere{{centre[0], centre[1], centre[2]}, radius};
  return tessellate(shape, 0.1);
}

std::vector<Defect> of_kind(const std::vector<Defect>& all, const std::string& word) {
  std::vector<Defect> some;
  for (const Defect& d : all)
    if (d.what.find(word) != std::string::npos) some.push_back(d);
  return some;
}

TEST(MeshDefects, ASoundSurfaceHasNone) { EXPECT_TRUE(find_defects(ball()).empty()); }

TEST(MeshDefects, TwoHolesAreTwoHolesTheLargerFirst) {
  TriangleMesh mesh = ball();
  const auto around = [&](const Vec3& x, double reach) {
    std::erase_if(mesh.triangles, [&](const auto& t) { return (mesh.vertices[t[0]] - x).norm() < reach; });
  };
  around({1, 2, 3.5}, 0.15);
  around({1.5, 2, 3}, 0.01);
  around({0.5, 2, 3}, 0.08);
  const auto holes = of_kind(find_defects(mesh), "hole");
  ASSERT_GE(holes.size(), 2u);
  EXPECT_LT((holes[0].place - Vec3(1, 2, 3.5)).norm(), 0.1) << holes[0].place.transpose();
  EXPECT_NE(holes[0].cure.find("Fill Holes"), std::string::npos);
}

TEST(MeshDefects, FlippedDuplicateAndFlatTriangles) {
  TriangleMesh mesh = ball();
  std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
  mesh.triangles.push_back(mesh.triangles[30]);
  mesh.triangles.push_back({mesh.triangles[50][0], mesh.triangles[50][1], mesh.triangles[50][1]});
  const auto all = find_defects(mesh);
  const auto middle = [&](int t) {
    return Vec3((mesh.vertices[mesh.triangles[t][0]] + mesh.vertices[mesh.triangles[t][1]] +
                 mesh.vertices[mesh.triangles[t][2]]) /
                3);
  };
  const auto flipped = of_kind(all, "opposite ways"), twice = of_kind(all, "twice"), flat = of_kind(all, "no area");
  ASSERT_EQ(flipped.size(), 3u);
  for (const Defect& d : flipped) EXPECT_LT((d.place - middle(7)).norm(), 0.1);
  ASSERT_EQ(twice.size(), 1u);
  EXPECT_EQ(twice[0].place, middle(30));
  ASSERT_EQ(flat.size(), 1u);
  EXPECT_EQ(flat[0].place, mesh.vertices[mesh.triangles[50][0]]);
}

void add_to(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

/// The unit cube with its lowest corner there.
TriangleMesh cube_at(const Vec3& lower) {
  Shape shape;
  shape.box = Box{{lower.x(), lower.y(), lower.z()}, {lower.x() + 1, lower.y() + 1, lower.z() + 1}};
  return tessellate(shape, 10);
}

TEST(MeshDefects, BallsThatOverlapPassThroughEachOther) {
  TriangleMesh mesh = ball({0, 0, 0}, 0.5);
  const TriangleMesh other = ball({0.83, 0.01, 0.02}, 0.5);
  add_to(mesh, other);
  const auto crossings = of_kind(find_defects(mesh, 1000), "passes through");
  ASSERT_GT(crossings.size(), 10u);
  for (const Defect& d : crossings) EXPECT_NEAR(d.place.x(), 0.415, 0.02) << "where the two surfaces meet";
  EXPECT_EQ(of_kind(find_defects(mesh, 3), "passes through").size(), 3u);
  EXPECT_NE(of_kind(find_defects(mesh, 3), "passes through")[2].what.find("more like it"), std::string::npos);
}

/// Two unit cubes whose edges go exactly through the diagonals of each other's faces.
TEST(MeshDefects, AnEdgeThroughTheEdgeOfTwoTrianglesPassesThrough) {
  TriangleMesh mesh = cube_at({0, 0, 0});
  add_to(mesh, cube_at({0.5, 0.5, 0.5}));
  EXPECT_FALSE(of_kind(find_defects(mesh), "passes through").empty());
}

TEST(MeshDefects, AnEdgeThatTouchesAnEdgeDoesNot) {
  TriangleMesh mesh = cube_at({0, 0, 0});
  TriangleMesh blade;
  blade.vertices = {{0.5, 0.3, 1.5}, {1.5, 0.3, 0.5}, {2, 0.3, 2}};
  blade.triangles = {{0, 1, 2}};
  add_to(mesh, blade);
  EXPECT_TRUE(of_kind(find_defects(mesh), "passes through").empty());
}

/// An open tray of 2 × 2 × 0.5 m from two-sided sheets; `hole`: the width (m) of a slot in its side.
Wall<3> tray(double hole) {
  Wall<3> wall;
  wall.two_sided = true;
  const auto quad = [&](const Point<3>& a, const Point<3>& b, const Point<3>& c, const Point<3>& d) {
    const auto n = static_cast<std::int32_t>(wall.vertices.size());
    for (const auto& x : {a, b, c, d}) wall.vertices.push_back(x);
    wall.facets.push_back({n, n + 1, n + 2});
    wall.facets.push_back({n, n + 2, n + 3});
  };
  quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  quad({-1, -1, 0}, {1, -1, 0}, {1, -1, 0.5}, {-1, -1, 0.5});
  quad({-1, 1, 0}, {1, 1, 0}, {1, 1, 0.5}, {-1, 1, 0.5});
  quad({-1, -1, 0}, {-1, 1, 0}, {-1, 1, 0.5}, {-1, -1, 0.5});
  const double left = 0.33 - hole / 2, right = 0.33 + hole / 2;
  quad({1, -1, 0}, {1, left, 0}, {1, left, 0.5}, {1, -1, 0.5});
  quad({1, right, 0}, {1, 1, 0}, {1, 1, 0.5}, {1, right, 0.5});
  return wall;
}

TEST(Leak, IsFoundAndLocatedIfAParticleFitsThrough) {
  const double spacing = 0.05;
  Scene scene;
  scene.boundaries.resize(1);
  Start start;
  start.spacing = spacing;
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 6; ++j) start.position.push_back({-0.5 + j * spacing, -0.5, 0.05 + k * spacing});
  const auto leak_of = [&](double hole) {
    const Wall<3> wall = tray(hole);
    return find_leak<3>(scene, start, {wall}, Contact<3>({wall}, spacing / 2, 2.6 * spacing));
  };
  EXPECT_FALSE(leak_of(0));
  EXPECT_FALSE(leak_of(0.9 * spacing)) << "a particle does not fit through";
  const auto leak = leak_of(1.5 * spacing);
  ASSERT_TRUE(leak);
  EXPECT_LT((leak->narrowest - Point<3>(1, 0.33, 0.1)).head<2>().norm(), 0.1) << leak->narrowest.transpose();
}

}  // namespace
}  // namespace molten::mesh_defects_test
