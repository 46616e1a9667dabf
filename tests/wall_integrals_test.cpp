// Integrals of the kernel over walls against brute-force sums over the solid, in corners, at ridges and over tilted
// meshes.
#include "core/boundary/wall_integrals.h"

#include <gtest/gtest.h>

#include <functional>

#include "core/kernel.h"
#include "tests/contact_shapes.h"
#include "tests/particle_sets.h"

namespace molten::wall_integrals_test {
namespace {

constexpr double smoothing_length = 1.3, reach = 2 * smoothing_length;

template <int Dim> struct Integrals {
  double hidden = 0;                         // ∫_solid W dV
  Point<Dim> gradient = Point<Dim>::Zero();  // −∫_solid ∇W dV
};

template <int Dim> WallIntegrals<Dim> integrals_of(const std::vector<Wall<Dim>>& walls) {
  return {walls, WallSurface<Dim>(walls), KernelKind::wendland_c2, smoothing_length};
}

template <int Dim> Integrals<Dim> sum(const WallIntegrals<Dim>& walls, const Point<Dim>& x) {
  Integrals<Dim> all;
  walls.visit(x, [&](const WallPatch<Dim>& patch) {
    all.hidden += patch.hidden;
    all.gradient += patch.weight * patch.normal;
    EXPECT_LT(patch.centroid.norm(), reach);
    EXPECT_NEAR(patch.centroid.dot(patch.normal), -patch.distance, 1e-9);
  });
  return all;
}

/// Midpoint rule; `cells` per axis, whose sides the walls should meet.
template <int Dim> Integrals<Dim> brute(const Point<Dim>& x, const std::function<bool(Point<Dim>)>& solid, int cells) {
  const Kernel<KernelChoice::wendland_c2, double> kernel(KernelKind::wendland_c2, Dim, smoothing_length, 1);
  const double size = 2 * reach / cells;
  Integrals<Dim> all;
  for (long k = 0; k < std::lround(std::pow(cells, Dim)); ++k) {
    Point<Dim> y;
    long rest = k;
    for (int d = 0; d < Dim; ++d, rest /= cells) y[d] = -reach + (rest % cells + 0.5) * size;
    if (y.norm() >= reach || !solid(Point<Dim>(x + y))) continue;
    const auto w = kernel(Lanes<double, 1>(y.norm()));
    all.hidden += w.w.v * std::pow(size, Dim);
    all.gradient += w.slope.v * y * std::pow(size, Dim);  // ∇ by the particle's position is −slope y
  }
  return all;
}

template <int Dim>
void expect_as_brute(const std::vector<Wall<Dim>>& walls, const Point<Dim>& x,
                     const std::function<bool(Point<Dim>)>& solid) {
  const auto ours = sum(integrals_of(walls), x);
  const auto twin = brute<Dim>(x, solid, Dim == 2 ? 1300 : 130);
  const double tolerance = Dim == 2 ? 1e-3 : 5e-4;
  EXPECT_NEAR(ours.hidden, twin.hidden, tolerance) << x.transpose();
  EXPECT_LT((ours.gradient - twin.gradient).norm(), 2 * tolerance) << x.transpose();
}

Wall<2> loop(const std::vector<Point<2>>& corners) {
  Wall<2> wall;
  wall.vertices = corners;
  const auto n = static_cast<std::int32_t>(corners.size());
  for (std::int32_t k = 0; k < n; ++k) wall.facets.push_back({k, (k + 1) % n});
  return wall;
}

template <int Dim> Wall<Dim> plane(const Point<Dim>& point, const Point<Dim>& normal) {
  Wall<Dim> wall;
  wall.is_plane = true;
  wall.plane_point = point;
  wall.plane_normal = normal.normalized();
  return wall;
}

Wall<3> box_container() {
  Shape shape;
  shape.box = Box{{0, 0, 0}, {10, 10, 10}};
  return contact_test::shell(shape, 100, true);
}

const auto outside_square = [](Point<2> y) { return y.minCoeff() < 0 || y.maxCoeff() > 10; };
const auto outside_cube = [](Point<3> y) { return y.minCoeff() < 0 || y.maxCoeff() > 10; };

TEST(WallIntegrals, InsideASquare) {
  const std::vector<Wall<2>> walls{loop({{0, 0}, {10, 0}, {10, 10}, {0, 10}})};
  for (const Point<2>& x : {Point<2>(5, 0.5), Point<2>(5, 0.2), Point<2>(0.5, 0.5), Point<2>(8.9, 9.6)})
    expect_as_brute<2>(walls, x, outside_square);
}

TEST(WallIntegrals, PlanesEndWhereTheyMeet) {
  const std::vector<Wall<2>> walls{plane<2>({0, 0}, {0, 1}), plane<2>({0, 0}, {1, 0})};
  for (const Point<2>& x : {Point<2>(5, 0.5), Point<2>(0.5, 0.5), Point<2>(1.3, 0.4)})
    expect_as_brute<2>(walls, x, outside_square);
  std::vector<Wall<3>> three;
  for (int k = 0; k < 3; ++k) three.push_back(plane<3>(Point<3>::Zero(), Point<3>::Unit(k)));
  for (const Point<3>& x : {Point<3>(5, 4, 0.52), Point<3>(0.52, 0.6, 0.72), Point<3>(1.32, 5, 0.4)})
    expect_as_brute<3>(three, x, outside_cube);
}

TEST(WallIntegrals, OverARidge) {
  const std::vector<Wall<2>> walls{loop({{0, 0}, {0, 10}, {10, 10}, {10, 0}})};  // clockwise: the fluid is outside
  const auto inside = [](Point<2> y) { return !outside_square(y); };
  for (const Point<2>& x : {Point<2>(-0.5, 5), Point<2>(-0.4, -0.3), Point<2>(10.1, 9.2)})
    expect_as_brute<2>(walls, x, inside);
}

TEST(WallIntegrals, InsideABox) {
  for (const Point<3>& x :
       {Point<3>(5, 5, 0.52), Point<3>(0.52, 0.6, 0.72), Point<3>(1.32, 5, 0.4), Point<3>(8, 9, 9.48)})
    expect_as_brute<3>({box_container()}, x, outside_cube);
}

TEST(WallIntegrals, InsideARoundedMeshOfManyTriangles) {
  Shape shape;
  shape.sphere = Sphere{{0, 0, 0}, 6};
  const std::vector<Wall<3>> walls{contact_test::shell(shape, 0.8, true)};
  ASSERT_GT(walls[0].facets.size(), 500U);
  const auto outside = [](Point<3> y) { return y.norm() > 5.97; };  // the facets lie a little inside the sphere
  for (const Point<3>& x : {Point<3>(0, 0, -5.3), Point<3>(3, 3.2, 2.6)}) {
    const auto ours = sum(integrals_of(walls), x);
    const auto twin = brute<3>(x, outside, 130);
    EXPECT_NEAR(ours.hidden, twin.hidden, 0.01);
    EXPECT_LT((ours.gradient - twin.gradient).norm(), 0.02);
  }
}

TEST(WallIntegrals, ManySmallFacetsCountAsTheWallThatTheyMake) {
  Shape shape;
  shape.sphere = Sphere{{0, 0, 0}, 20};
  const std::vector<Wall<3>> many{contact_test::shell(shape, 0.5, true)}, few{contact_test::shell(shape, 1.5, true)};
  const auto fine = integrals_of(many), coarse = integrals_of(few);
  ASSERT_GT(many[0].facets.size(), 8 * few[0].facets.size());
  for (const double depth : {0.3, 0.5, 0.9, 1.5, 2.2})
    for (const Point<3>& way : {Point<3>(0, 0, -1), Point<3>(0.6, 0.8, 0), Point<3>(0.48, 0.6, 0.64)}) {
      int visited = 0;
      const Point<3> x = (20 - depth) * way;
      const auto as_sphere = [](Point<3> y) { return y.norm() > 20; };
      const auto ours = sum(fine, x), theirs = sum(coarse, x), twin = brute<3>(x, as_sphere, 130);
      EXPECT_NEAR(ours.hidden, theirs.hidden, 0.008) << depth << ", the coarse mesh is up to 0.014 inside the sphere";
      EXPECT_NEAR(ours.hidden, twin.hidden, 0.003) << depth;
      EXPECT_LT((ours.gradient - twin.gradient).norm(), 0.003) << depth;
      fine.visit(x, [&](const WallPatch<3>& patch) {
        ++visited;
        EXPECT_NEAR(patch.normal.dot(way), -1, 1e-4);
        EXPECT_NEAR(patch.distance, depth, 0.05);
        EXPECT_NEAR(patch.across.trace(), patch.hidden, 1e-12);
      });
      EXPECT_EQ(visited, 1) << depth;
    }
}

TEST(WallIntegrals, ManySmallSegmentsCountAsTheWallThatTheyMake) {
  std::vector<Point<2>> corners;
  for (int k = 0; k <= 400; ++k) corners.emplace_back(-20 + 0.1 * k, 1e-6 * (k % 3));
  Wall<2> chain = loop(corners);
  chain.facets.pop_back();  // open
  const auto many = integrals_of<2>({chain}), one = integrals_of<2>({loop({{-20, 0}, {20, 0}, {20, 30}, {-20, 30}})});
  for (const double depth : {0.1, 0.3, 0.65, 1.3, 2.4}) {
    const auto a = sum(many, {0.03, depth}), b = sum(one, {0.03, depth});
    EXPECT_NEAR(a.hidden, b.hidden, 2e-3) << depth;
    EXPECT_LT((a.gradient - b.gradient).norm(), 2e-3) << depth;
  }
}

TEST(WallIntegrals, AClosedSurfaceHidesAllOfItsInside) {
  const auto ours = sum(integrals_of<3>({contact_test::ball(1, 0.3)}), Point<3>(0, 0, 1.5));
  const auto twin = brute<3>(
      {0, 0, 1.5}, [](Point<3> y) { return y.norm() < 0.985; }, 130);
  EXPECT_NEAR(ours.hidden, twin.hidden, 0.003);
  EXPECT_LT((ours.gradient - twin.gradient).norm(), 0.01);
}

TEST(WallIntegrals, TheShortWayIsTheLongOne) {
  const auto walls = integrals_of<3>({box_container()});
  for (const double d : {0.05, 0.5, 1.7, 2.5}) {
    const Point<3> x(5, 4.3, d);
    const std::int32_t plane = walls.plane_near(x, reach);
    ASSERT_GE(plane, 0);
    const Point<3>& normal = walls.plane(plane).normal;
    const double height = normal.dot(x) - walls.plane(plane).offset;
    const auto quick = walls.of_plane(height);
    EXPECT_NEAR(height, d, 1e-12);
    int visited = 0;
    walls.visit(x, [&](const WallPatch<3>& exact) {
      ++visited;
      EXPECT_NEAR(quick.weight, exact.weight, 1e-5);
      EXPECT_NEAR(quick.hidden, exact.hidden, 1e-5);
      EXPECT_LT((-height * normal - exact.centroid).norm(), 1e-4);
    });
    EXPECT_EQ(visited, 1);
  }
}

TEST(WallIntegrals, TellWhichWallsAreNear) {
  using Walls = WallIntegrals<3>;
  const auto walls = integrals_of<3>({box_container()});
  EXPECT_EQ(walls.plane_near({5, 5, 5}, reach), Walls::no_plane);
  EXPECT_EQ(walls.plane_near({5, 2.5, 1}, reach), Walls::many_planes);
  EXPECT_NE(walls.plane_near({5, 5, 1}, reach), walls.plane_near({5, 1, 5}, reach));
  EXPECT_GE(walls.plane_near({5, 5, 2.59}, reach), 0);
  EXPECT_EQ(walls.plane_near({5, 5, 2.61}, reach), Walls::no_plane);
}

TEST(WallIntegrals, EveryKernel) {
  for (const auto kind : {KernelKind::gaussian, KernelKind::quadratic, KernelKind::cubic_spline,
                          KernelKind::wendland_c2, KernelKind::lucy, KernelKind::poly6, KernelKind::spiky})
    for (const int dim : {2, 3}) {
      const RadialIntegrals radial(kind, dim, 1);
      EXPECT_NEAR(radial.plane(1e-9).hidden, 0.5, 2e-3) << static_cast<int>(kind) << ' ' << dim;
      // Planes stacked from here to the end hide what is behind the first.
      double hidden = 0;
      for (double d = 0.205; d < radial.reach(); d += 0.01) hidden += 0.01 * radial.plane(d).weight;
      EXPECT_NEAR(radial.plane(0.2).hidden, hidden, 2e-3) << static_cast<int>(kind) << ' ' << dim;
    }
}

// ---- the pieces found once a step -----------------------------------------------------------------------------------

template <class Real> State<2, Real> in_a_corner() {
  using namespace particle_sets;
  Scene scene = plain_scene(2);
  scene.numerics.wall_support = true;
  scene.fluid.rheology = {Rheology::Model::smd, 0, 0.5, {15, 15}, 60, 20};
  scene.boundaries.emplace_back().shape.plane.emplace();  // stands for the walls below
  std::vector<Wall<2>> walls(2);
  walls[0].vertices = {{0, 0}, {2, 0}}, walls[0].facets = {{0, 1}};
  walls[1].vertices = {{0, 2}, {0, 0}}, walls[1].facets = {{0, 1}};
  const Start start = start_of(scene, cube<2>(12, 0.1, 0.2), 0.1);
  const auto p = parameters_of<2>(scene, start);
  return make_state<2, Real>(features_of(scene), p, Contact<2>(walls, p.contact_radius, p.support_radius), start);
}

template <int Dim, class Real> std::vector<double> weights(const State<Dim, Real>& s, std::size_t slot) {
  std::vector<double> all;
  const Point<Dim> x(s.particles[position][0][slot], s.particles[position][1][slot]);
  s.wall_support.visit(slot, x, [&](const auto& patch) { all.push_back(patch.weight), all.push_back(patch.hidden); });
  return all;
}

TEST(WallPatches, FoundOnceAreThoseFoundEveryTime) {
  auto s = in_a_corner<float>();
  const auto of_all = [&] {
    std::vector<std::vector<double>> all;
    for (std::size_t slot = 0; slot < s.particles.slots(); ++slot)
      if (s.wall_support.plane(slot / cluster_size) == WallSupport<2>::many_planes && !s.particles.is_padding(slot))
        all.push_back(weights(s, slot));
    return all;
  };
  const auto every_time = of_all();
  ASSERT_GT(every_time.size(), 10u);
  s.wall_support.find_patches(s.particles, 0);
  EXPECT_EQ(of_all(), every_time);
  s.particles[position][0][0] += 0.01;
  EXPECT_EQ(of_all(), every_time) << "kept";
  s.wall_support.forget_patches();
  EXPECT_NE(of_all(), every_time) << "forgotten";
}

TEST(WallPatches, GiveTheSameBits) {
  auto once = in_a_corner<float>(), twice = in_a_corner<float>();
  find_all_rates(once);
  find_viscosity(twice), find_rates(twice);
  for (int d = 0; d < 2; ++d)
    for (std::size_t slot = 0; slot < once.particles.slots(); ++slot)
      EXPECT_EQ(once.particles[acceleration][d][slot], twice.particles[acceleration][d][slot]);
  EXPECT_EQ(weights(once, 0), weights(twice, 0)) << "forgotten after the step's passes";
}

}  // namespace
}  // namespace molten::wall_integrals_test
