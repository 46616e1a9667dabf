// The numbers of a run that follow from several of the scene's: the bounds of rest, the default sound speed.
#include "core/parameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "tests/particle_sets.h"

namespace molten::parameters_test {
namespace {

using namespace particle_sets;

constexpr double spacing = 0.02;

Scene sleepy_scene() {
  Scene scene = plain_scene(2);
  scene.numerics.sleep.emplace();
  return scene;
}

RestBounds bounds_of(const Scene& scene, std::vector<double> temperatures = {}) {
  Start start = start_of(scene, cube<2>(2, spacing), spacing);
  if (!temperatures.empty()) start.temperature = std::move(temperatures);
  return *parameters_of<2>(scene, start).rest;
}

TEST(RestBounds, LastAsLongAsTheTopOfAThrow) {
  Scene scene = sleepy_scene();
  const double sound = 40 * 1.3 * spacing / 10;
  EXPECT_NEAR(bounds_of(scene).after, sound, 1e-15);
  scene.gravity = {0, -9.81, 0};
  EXPECT_NEAR(bounds_of(scene).after, sound, 1e-15);
  scene.numerics.sleep->speed = 0.5;
  EXPECT_NEAR(bounds_of(scene).after, 4 * 0.5 / 9.81, 1e-15);
  scene.numerics.sleep->after = 4 * 0.5 / 9.81 + 1e-6;
  EXPECT_EQ(bounds_of(scene).after, scene.numerics.sleep->after);
}

TEST(RestBounds, AreRefusedIfTheyMistakeATopForRest) {
  Scene scene = sleepy_scene();
  scene.file = "s.toml";
  scene.places["numerics.sleep.after"] = {"s.toml", 7, 3};
  scene.gravity = {3, -4, 0};
  scene.numerics.sleep->speed = 0.5;
  scene.numerics.sleep->after = 0.39;
  try {
    bounds_of(scene);
    ADD_FAILURE() << "taken";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::usage);
    const std::string line = e.what();
    EXPECT_TRUE(line.starts_with("s.toml:7:3: numerics.sleep.after: 0.39")) << line;
    EXPECT_NE(line.find("at least 4 speed/|g|, 0.4"), std::string::npos) << line;
    EXPECT_NE(line.find("lower numerics.sleep.speed"), std::string::npos) << line;
  }
}

TEST(RestBounds, OfHeatCountTheWallsTemperatures) {
  Scene scene = sleepy_scene();
  scene.fluid.heat = Heat{1e-4, std::nullopt, 20, 20};
  scene.boundaries.resize(2);
  scene.boundaries[1].temperature = 120;
  const RestBounds bounds = bounds_of(scene);
  EXPECT_NEAR(bounds.temperature, 1, 1e-12);
  EXPECT_NEAR(bounds.temperature_rate, 1e-3 * 100 * 1e-4 / (2 * spacing * spacing), 1e-12) << "over its diagonal";
}

TEST(RestBounds, OfHeatAreMoreThanRoundOff) {
  Scene scene = sleepy_scene();
  scene.fluid.heat = Heat{1e-4, std::nullopt, 1273, 1273};
  for (const auto& asked : {std::optional<double>(), std::optional<double>(0)}) {
    scene.numerics.sleep->temperature = asked;
    EXPECT_GT(bounds_of(scene).temperature, std::nextafter(1273.f, 2000.f) - 1273.f);
    EXPECT_LT(bounds_of(scene).temperature, 0.01);
  }
  EXPECT_EQ(bounds_of(scene, {20, 20, 20, 60}).temperature, 1e-6 * 60);
}

double sound_speed_beside(const Boundary& wall) {
  Scene scene = plain_scene(2);
  scene.numerics.sound_speed.reset();
  scene.gravity = {};
  scene.boundaries.push_back(wall);
  return parameters_of<2>(scene, start_of(scene, cube<2>(11, spacing), spacing)).eos.sound_speed;
}

TEST(SoundSpeed, IsTenTimesTheFastestWalls) {
  const double arm = 10 * spacing * std::sqrt(2) / 2;  // half the fluid's diagonal
  Boundary belt, wheel, body, frames;
  belt.velocity = {3, 4, 0};
  EXPECT_NEAR(sound_speed_beside(belt), 50, 1e-5);
  wheel.motion.emplace().spin = {0, 0, 180};
  EXPECT_NEAR(sound_speed_beside(wheel), 10 * std::numbers::pi * arm, 1e-5);
  body.body.emplace().velocity = {2, 0, 0};
  body.body->spin = {0, 0, -360};
  EXPECT_NEAR(sound_speed_beside(body), 10 * (2 + 2 * std::numbers::pi * arm), 1e-5);
  frames.motion.emplace().key_frames = {{0, 0, 0, 0, 0, 0, 0}, {2, 6, 0, 0, 0, 0, 360}};
  EXPECT_NEAR(sound_speed_beside(frames), 10 * (3 + std::numbers::pi * arm), 1e-5);
}

}  // namespace
}  // namespace molten::parameters_test
