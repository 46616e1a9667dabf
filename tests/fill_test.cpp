// Filling: counts, exact measures, and every position against a winding number computed another way.
#include "core/fill.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <set>

#include "core/boundary/shapes.h"
#include "core/error.h"
#include "io/geometry/mesh_file.h"

namespace molten::fill_test {
namespace {

using std::numbers::pi;
using Triangle = std::array<std::int32_t, 3>;

Shape sphere(const Vec3& center, double radius) {
  Shape shape;
  shape.sphere = Sphere{{center.x(), center.y(), center.z()}, radius};
  return shape;
}

Shape box(const Vec3& low, const Vec3& high) {
  Shape shape;
  shape.box = Box{{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}};
  return shape;
}

Region solid(const Shape& shape, double edge) { return {tessellate(shape, edge), {}}; }
Region flat(const Shape& shape, double edge) { return {{}, outline(shape, edge)}; }

/// The oracle: the sum of the triangles' solid angles (van Oosterom and Strackee), in double.
double winding_number(const TriangleMesh& mesh, const Vec3& p) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p, c = mesh.vertices[t[2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4 * pi);
}

double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto to_segment = [&](const Vec3& u, const Vec3& v) {
    const double t = std::clamp((p - u).dot(v - u) / (v - u).squaredNorm(), 0.0, 1.0);
    return (p - u - t * (v - u)).norm();
  };
  const Vec3 n = (b - a).cross(c - a);
  const bool over =
      (b - a).cross(p - a).dot(n) >= 0 && (c - b).cross(p - b).dot(n) >= 0 && (a - c).cross(p - c).dot(n) >= 0;
  if (over && n.norm() > 0) return std::abs((p - a).dot(n)) / n.norm();
  return std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
}

double distance(const TriangleMesh& mesh, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles)
    least = std::min(least, distance_to_triangle(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  return least;
}

/// Walks over the cells of the bounding box (every `stride`th) and asks whether exactly those inside are filled.
void expect_right(const TriangleMesh& mesh, const Filling& filling, int stride) {
  Eigen::AlignedBox3d bounds;
  for (const Vec3& v : mesh.vertices) bounds.extend(v);
  const double tolerance = 1e-4 * bounds.sizes().maxCoeff(), s = filling.spacing;
  const Vec3 first = filling.positions[0];
  const auto cell = [&](const Vec3& x) {
    const Vec3 c = (x - first) / s;
    return std::array<long, 3>{std::lround(c.x()), std::lround(c.y()), std::lround(c.z())};
  };
  std::set<std::array<long, 3>> filled;
  for (const Vec3& x : filling.positions) {
    const auto c = cell(x);
    ASSERT_LT((first + s * Vec3(c[0], c[1], c[2]) - x).norm(), 1e-6 * s) << "not on the lattice";
    ASSERT_TRUE(filled.insert(c).second) << "two particles in one cell";
  }
  const auto low = cell(bounds.min() - Vec3::Constant(s)), high = cell(bounds.max() + Vec3::Constant(s));
  long visited = 0, wrong = 0;
  for (long i = low[0]; i <= high[0]; ++i)
    for (long j = low[1]; j <= high[1]; ++j)
      for (long k = low[2]; k <= high[2]; ++k) {
        if (visited++ % stride != 0) continue;
        const Vec3 x = first + s * Vec3(i, j, k);
        const bool inside = winding_number(mesh, x) > 0.5;
        if (inside != filled.contains({i, j, k}) && distance(mesh, x) > tolerance) ++wrong;
      }
  EXPECT_EQ(wrong, 0);
}

ExitCode code_of(const std::vector<Region>& regions, int dimensions, std::optional<long long> count,
                 std::optional<double> spacing) {
  try {
    fill(regions, dimensions, count, spacing);
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.code();
  }
  return ExitCode::done;
}

TEST(Fill, SphereHasItsVolume) {
  const Filling filling = fill({solid(sphere({0, 0, 0}, 1), 0.02)}, 3, 20000, {});
  EXPECT_NEAR(filling.measure, 4 * pi / 3, 1e-3);
  EXPECT_NEAR(filling.positions.size() * std::pow(filling.spacing, 3) / filling.measure, 1, 0.01);
  for (const Vec3& x : filling.positions) EXPECT_LT(x.norm(), 1 + 1e-6);
}

TEST(Fill, CountsAreMet) {
  Shape cone, cylinder, letter;
  cone.cone = Cone{{0, 0, 0}, 1, 0, 2};
  cylinder.cylinder = Cylinder{{1, 2, 3}, 0.5, 2};
  letter.polygon = Polygon{{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 0, 1};
  for (const Shape& shape : {sphere({0, 0, 0}, 1), cone, cylinder, letter, box({0, 0, 0}, {1, 0.7, 1.9})})
    for (const long long asked : {100, 545, 1150, 7007, 10188, 100000}) {
      const Filling filling = fill({solid(shape, 0.05)}, 3, asked, {});
      EXPECT_LE(std::abs(static_cast<double>(filling.positions.size()) - asked), 0.01 * asked) << asked;
      EXPECT_EQ(filling.region.size(), filling.positions.size());
    }
}

TEST(Fill, CountsAreMetInTwoDimensions) {
  for (const Shape& shape : {sphere({0, 0, 0}, 1), box({0, 0, 0}, {1, 2, 0})})
    for (const long long asked : {1, 10, 100, 545, 2222, 36823, 1000000}) {
      const Filling filling = fill({flat(shape, 0.01)}, 2, asked, {});
      EXPECT_LE(std::abs(static_cast<double>(filling.positions.size()) - asked), 0.01 * asked) << asked;
      for (const Vec3& x : filling.positions) ASSERT_EQ(x.z(), 0);
    }
}

TEST(Fill, CubesMeetEveryCount) {
  const Region cube = solid(box({0, 0, 0}, {1, 1, 1}), 1);
  for (long long asked = 1; asked < 3000; asked += 37) {
    const Filling filling = fill({cube}, 3, asked, {});
    EXPECT_LE(std::abs(static_cast<double>(filling.positions.size()) - asked), 0.01 * asked) << asked;
    for (const Vec3& x : filling.positions) ASSERT_TRUE(x.minCoeff() > 0 && x.maxCoeff() < 1);
  }
}

TEST(Fill, AlignedBoxIsFilledToItsFaces) {
  const Filling filling = fill({solid(box({0, 0, 0}, {1, 2, 0.5}), 1)}, 3, {}, 0.1);
  ASSERT_EQ(filling.positions.size(), 10u * 20 * 5);
  EXPECT_NEAR(filling.measure, 1, 1e-14);
  Eigen::AlignedBox3d bounds;
  for (const Vec3& x : filling.positions) bounds.extend(x);
  EXPECT_LT((bounds.min() - Vec3(0.05, 0.05, 0.05)).norm(), 1e-12);
  EXPECT_LT((bounds.max() - Vec3(0.95, 1.95, 0.45)).norm(), 1e-12);

  const Filling by_count = fill({solid(box({0, 0, 0}, {1, 2, 0.5}), 1)}, 3, 1000, {});
  ASSERT_EQ(by_count.positions.size(), 1000u);
  EXPECT_NEAR(by_count.spacing, 0.1, 1e-12);
}

TEST(Fill, AlignedRectangleIsFilledToItsSides) {
  const Filling filling = fill({flat(box({0, 0, 0}, {1, 2, 0}), 1)}, 2, {}, 0.02);
  ASSERT_EQ(filling.positions.size(), 5000u);
  const Filling odd = fill({flat(box({0, 0, 0}, {1, 2, 0}), 1)}, 2, {}, 0.03);
  EXPECT_EQ(odd.positions.size(), 33u * 67);
}

TEST(Fill, NearlyTheNumberOfACubeKeepsTheFittingSpacing) {
  const Filling filling = fill({solid(box({0, 0, 0}, {1, 1, 1}), 1)}, 3, 1003, {});
  EXPECT_EQ(filling.positions.size(), 1000u);
  EXPECT_NEAR(filling.spacing, 0.1, 1e-12);
}

// Cell centres on the far faces are outside, on the near faces inside, so that bodies that touch share nothing.
TEST(Fill, CentresOnAFaceBelongToOneSide) {
  const Filling filling = fill({solid(box({0, 0, 0}, {1.25, 1.25, 1.25}), 1)}, 3, {}, 0.1);
  EXPECT_EQ(filling.positions.size(), 12u * 12 * 12);
  const Filling touching =
      fill({solid(box({0, 0, 0}, {1.25, 1, 1}), 1), solid(box({1.25, 0, 0}, {2, 1, 1}), 1)}, 3, {}, 0.1);
  EXPECT_EQ(touching.positions.size(), 2000u);
}

TEST(Fill, SphereIsRightCellByCell) {
  const Shape shape = sphere({0.3, -0.2, 0.1}, 1);
  const Region region = solid(shape, 0.2);
  expect_right(region.mesh, fill({region}, 3, 5000, {}), 1);
}

TEST(Fill, ConcavePolygonIsRightCellByCell) {
  Shape letter;  // a C
  letter.polygon = Polygon{{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {3, 2}, {3, 3}, {0, 3}}, -1, 1};
  const Region region = solid(letter, 1);
  EXPECT_NEAR(signed_volume(region.mesh), 14, 1e-12);
  expect_right(region.mesh, fill({region}, 3, 4000, {}), 1);
}

TEST(Fill, TiltedBoxIsRightCellByCell) {
  Region region = solid(box({-1, -1, -1}, {1, 1, 1}), 1);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(pi / 4, Vec3(1, 1, 0).normalized()).toRotationMatrix();
  for (Vec3& v : region.mesh.vertices) v = turn * v;
  expect_right(region.mesh, fill({region}, 3, 4000, {}), 1);
}

TEST(Fill, FarFromTheOriginIsTheSame) {
  Region near = solid(sphere({0, 0, 0}, 1), 0.1), far = near;
  for (Vec3& v : far.mesh.vertices) v += Vec3(1e6, -1e6, 1e6);
  const Filling a = fill({near}, 3, 5000, {}), b = fill({far}, 3, 5000, {});
  EXPECT_NEAR(b.measure, a.measure, 1e-8);
  EXPECT_NEAR(static_cast<double>(b.positions.size()), a.positions.size(), 50);
  expect_right(far.mesh, b, 3);
}

TEST(Fill, TinyAndHugeAreTheSame) {
  const std::size_t normal = fill({solid(sphere({0, 0, 0}, 1), 0.1)}, 3, 5000, {}).positions.size();
  EXPECT_EQ(fill({solid(sphere({0, 0, 0}, 1e-6), 1e-7)}, 3, 5000, {}).positions.size(), normal);
  EXPECT_EQ(fill({solid(sphere({0, 0, 0}, 1e6), 1e5)}, 3, 5000, {}).positions.size(), normal);
}

TEST(Fill, OverlappingPartsOfOneMeshCountOnce) {
  Region region = solid(box({0, 0, 0}, {1, 1, 1}), 1);
  const TriangleMesh other = tessellate(box({0.55, 0, 0}, {2, 1, 1}), 1);
  const auto offset = static_cast<std::int32_t>(region.mesh.vertices.size());
  region.mesh.vertices.insert(region.mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Triangle& t : other.triangles)
    region.mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  EXPECT_EQ(fill({region}, 3, {}, 0.1).positions.size(), 2000u);
}

TEST(Fill, CavityStaysEmpty) {
  Region region = solid(box({0, 0, 0}, {1, 1, 1}), 1);
  const TriangleMesh hole = tessellate(box({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}), 1);
  const auto offset = static_cast<std::int32_t>(region.mesh.vertices.size());
  region.mesh.vertices.insert(region.mesh.vertices.end(), hole.vertices.begin(), hole.vertices.end());
  for (const Triangle& t : hole.triangles)
    region.mesh.triangles.push_back({t[0] + offset, t[2] + offset, t[1] + offset});
  const Filling filling = fill({region}, 3, {}, 0.1);
  EXPECT_EQ(filling.positions.size(), 1000u - 216);
  EXPECT_NEAR(filling.measure, 1 - 0.216, 1e-12);
}

TEST(Fill, SeveralBodiesShareTheLattice) {
  const std::vector<Region> regions = {solid(sphere({0, 0, 0}, 1), 0.1), solid(box({3, 0, 0}, {4, 1, 1}), 1)};
  const Filling filling = fill(regions, 3, 10000, {});
  EXPECT_LE(std::abs(static_cast<double>(filling.positions.size()) - 10000), 100);
  EXPECT_NEAR(filling.measure, signed_volume(regions[0].mesh) + 1, 1e-12);
  std::array<int, 2> sizes{};
  for (std::size_t i = 0; i < filling.positions.size(); ++i) {
    ++sizes[filling.region[i]];
    ASSERT_EQ(filling.region[i], filling.positions[i].x() > 2 ? 1 : 0);
  }
  EXPECT_GT(sizes[0], 4 * sizes[1] - 200);
}

TEST(Fill, RepeatsBitForBit) {
  const Region region = solid(sphere({0, 0, 0}, 1), 0.1);
  const Filling a = fill({region}, 3, 3000, {}), b = fill({region}, 3, 3000, {});
  ASSERT_EQ(a.positions.size(), b.positions.size());
  for (std::size_t i = 0; i < a.positions.size(); ++i) ASSERT_EQ(a.positions[i], b.positions[i]);
}

TEST(Fill, RefusesWhatCannotBeFilled) {
  const Region ball = solid(sphere({0, 0, 0}, 1), 0.3);
  Region inverted = ball, open = ball;
  for (Triangle& t : inverted.mesh.triangles) std::swap(t[0], t[1]);
  open.mesh.triangles.resize(open.mesh.triangles.size() - 20);
  EXPECT_EQ(code_of({ball}, 3, {}, {}), ExitCode::usage);
  EXPECT_EQ(code_of({ball}, 3, 10, 0.1), ExitCode::usage);
  EXPECT_EQ(code_of({ball}, 3, 0, {}), ExitCode::usage);
  EXPECT_EQ(code_of({ball}, 3, -5, {}), ExitCode::usage);
  EXPECT_EQ(code_of({ball}, 3, 1LL << 40, {}), ExitCode::usage);
  EXPECT_EQ(code_of({ball}, 3, {}, 0.0), ExitCode::usage);
  EXPECT_EQ(code_of({ball}, 3, {}, std::nan("")), ExitCode::usage);
  EXPECT_EQ(code_of({ball}, 3, {}, 1e-9), ExitCode::usage);
  EXPECT_EQ(code_of({ball}, 3, {}, 5.0), ExitCode::usage);
  EXPECT_EQ(code_of({}, 3, 10, {}), ExitCode::usage);
  EXPECT_EQ(code_of({inverted}, 3, 1000, {}), ExitCode::geometry);
  EXPECT_EQ(code_of({open}, 3, 100000, {}), ExitCode::geometry);
  EXPECT_EQ(code_of({ball, solid(sphere({1, 0, 0}, 1), 0.3)}, 3, 5000, {}), ExitCode::geometry);
  EXPECT_EQ(code_of({ball, solid(sphere({9, 0, 0}, 0.001), 1)}, 3, 5000, {}), ExitCode::usage);
}

TEST(Fill, MillionIsQuick) {
  const Region cube = solid(box({0, 0, 0}, {1, 1, 1}), 1);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(fill({cube}, 3, 1000000, {}).positions.size(), 1000000u);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  RecordProperty("seconds", std::to_string(taken.count()));
  EXPECT_LT(taken.count(), 10);
}

TEST(Fill, Bunny) {
  const std::filesystem::path file = std::filesystem::path(MOLTEN_SOURCE_DIR) / "scenes/models/bunny.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "run scripts/models to fetch the models";
  const Region bunny{read_mesh(file), {}};
  for (const long long asked : {1000, 10188, 50000}) {
    const Filling filling = fill({bunny}, 3, asked, {});
    EXPECT_LE(std::abs(static_cast<double>(filling.positions.size()) - asked), 0.01 * asked);
    EXPECT_NEAR(filling.measure, 194.288, 1e-3);
    if (asked == 10188) expect_right(bunny.mesh, filling, 11);
  }
}

}  // namespace
}  // namespace molten::fill_test
