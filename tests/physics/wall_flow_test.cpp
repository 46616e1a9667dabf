// Flow and heat between walls with support, against exact profiles: plane Poiseuille and Couette flow, conduction.
#include <fmt/format.h>

#include "tests/physics/case.h"

namespace molten::wall_flow_test {
namespace {

using namespace physics_case;

// A channel of width 1 along x whose walls are two segments, with ν = k = 0.1 and velocities up to 1.
struct Channel {
  int rows = 32;
  bool driven = false;     // by a force along it
  double belt = 0;         // velocity of the upper wall
  bool heated = false;     // walls at 0 and 1
  double layer = 0;        // thickness of a layer as conductive as the fluid on the upper wall
  bool insulated = false;  // the upper wall
  double smoothing_ratio = 2;
};
constexpr double diffusivity = 0.1;

Wall<2> segment(const Point<2>& a, const Point<2>& b) {
  Wall<2> wall;
  wall.vertices = {a, b};
  wall.facets = {{0, 1}};
  return wall;
}

std::vector<Wall<2>> walls_of(const Channel& c) {
  Wall<2> lower = segment({-5, 0}, {5, 0}), upper = segment({5, 1}, {-5, 1});
  upper.skin.velocity.x() = c.belt;
  if (c.heated) lower.skin.temperature = 0;
  if (c.heated && !c.insulated) upper.skin.temperature = 1;
  if (c.layer > 0) upper.skin.layer_diffusivity = diffusivity, upper.skin.layer_thickness = c.layer;
  return {lower, upper};
}

Scene channel_scene(const Channel& c, double length) {
  Scene scene = plain_scene(2);
  scene.fluid.density = 1;
  scene.fluid.rheology.viscosity = diffusivity;
  if (c.driven) scene.gravity[0] = 8 * diffusivity;
  if (c.heated) scene.fluid.heat = Heat{diffusivity, {}, 0, 0};
  scene.numerics.sound_speed = 10;
  scene.numerics.density_diffusion = 0.1;
  scene.numerics.wall_support = true;
  scene.numerics.smoothing_ratio = c.smoothing_ratio;
  scene.boundaries.emplace_back().shape.plane.emplace();  // stands for the walls below
  scene.domain = Box{{0, -1, 0}, {length, 2, 0}};
  scene.periodic = {true, false, false};
  return scene;
}

/// Relative L2 error of the velocity (of the temperature, if heated) against exact(y), in steady state.
template <class Real, class F> double error_of(const Channel& c, F&& exact) {
  const OneThread one;
  const double spacing = 1.0 / c.rows;
  Start start = lattice(2, {8, c.rows, 0}, spacing);
  if (c.heated) start.temperature.assign(start.position.size(), 0.3);
  const Scene scene = channel_scene(c, 8 * spacing);
  const auto p = parameters_of<2>(scene, start);
  auto s =
      make_state<2, Real>(features_of(scene), p, Contact<2>(walls_of(c), p.contact_radius, p.support_radius), start);
  run_until(s, (c.layer > 0 || c.insulated ? 3 : 1.2) / diffusivity);
  double error2 = 0, norm2 = 0;
  for_each_particle(s, [&](std::size_t slot) {
    const double value = c.heated ? s.particles[temperature][0][slot] : double(s.particles[velocity][0][slot]);
    const double wanted = exact(s.particles[position][1][slot]);
    error2 += (value - wanted) * (value - wanted);
    norm2 += wanted * wanted;
  });
  const double error = std::sqrt(error2 / (norm2 > 0 ? norm2 : static_cast<double>(s.particles.count())));
  ::testing::Test::RecordProperty("error", fmt::format("{:.5f}", error));
  return error;
}

const auto parabola = [](double y) { return 4 * y * (1 - y); };
const auto linear = [](double y) { return y; };

TEST(WallFlow, Poiseuille) {
  EXPECT_LT((error_of<double>({.driven = true}, parabola)), 0.005);
  EXPECT_LT((error_of<float>({.driven = true}, parabola)), 0.005);
}

TEST(WallFlow, Couette) {
  EXPECT_LT((error_of<double>({.belt = 1}, linear)), 0.005);
  EXPECT_LT((error_of<float>({.belt = 1, .smoothing_ratio = 1.3}, linear)), 0.005);
}

TEST(WallFlow, ABeltCountsAlongItselfAlone) {
  const auto accelerations = [](const Point<2>& belt) {
    Channel c{.rows = 8};
    std::vector<Wall<2>> walls = walls_of(c);
    walls[1].skin.velocity = belt;
    const Start start = lattice(2, {8, c.rows, 0}, 1.0 / c.rows);
    const Scene scene = channel_scene(c, 1);
    const auto p = parameters_of<2>(scene, start);
    auto s = make_state<2, double>(features_of(scene), p, Contact<2>(walls, p.contact_radius, p.support_radius), start);
    find_rates(s);
    std::vector<double> all;
    for_each_particle(s, [&](std::size_t slot) {
      for (int d = 0; d < 2; ++d) all.push_back(s.particles[acceleration][d][slot]);
      all.push_back(s.particles[compression_rate][0][slot]);
    });
    return all;
  };
  EXPECT_EQ(accelerations({1, 0}), accelerations({1, 5}));
  EXPECT_NE(accelerations({1, 0}), accelerations({2, 0}));
}

// Fluid that leaves a wall together keeps its density, unless it is pressed; fluid that nears one gets denser.
TEST(WallFlow, AWallDoesNotStretchFluidThatLeavesIt) {
  const auto rate_beside_wall = [](double speed, double compressed) {
    const Channel c{.rows = 8};
    Start start = lattice(2, {8, c.rows / 2, 0}, 1.0 / c.rows);  // the lower half, far from the upper wall
    start.velocity.assign(start.position.size(), {0, speed, 0});
    const Scene scene = channel_scene(c, 1);
    const auto p = parameters_of<2>(scene, start);
    auto s = make_state<2, double>(features_of(scene), p, Contact<2>(walls_of(c), p.contact_radius, p.support_radius),
                                   start);
    for_each_particle(s, [&](std::size_t slot) { s.particles[compression][0][slot] = compressed; });
    find_rates(s);
    double rate = 0;
    for_each_particle(s, [&](std::size_t slot) {
      if (s.particles[position][1][slot] < 1.0 / c.rows) rate = s.particles[compression_rate][0][slot];
    });
    return rate;
  };
  EXPECT_NEAR(rate_beside_wall(1, -1e-4), 0, 1e-9);
  EXPECT_LT(rate_beside_wall(1, 1e-4), -1);
  EXPECT_GT(rate_beside_wall(-1, -1e-4), 1);
}

TEST(WallFlow, Conduction) {
  EXPECT_LT((error_of<double>({.rows = 16, .heated = true}, linear)), 0.005);
  EXPECT_LT((error_of<float>({.rows = 16, .heated = true, .smoothing_ratio = 1.3}, linear)), 0.005);
}

TEST(WallFlow, ConductionThroughALayer) {
  EXPECT_LT((error_of<double>({.rows = 16, .heated = true, .layer = 1}, [](double y) { return y / 2; })), 0.01);
}

TEST(WallFlow, AnInsulatedWallLetsNoHeatPass) {
  EXPECT_LT((error_of<double>({.rows = 16, .heated = true, .insulated = true}, [](double) { return 0.0; })), 0.001);
}

}  // namespace
}  // namespace molten::wall_flow_test
