// Heat beside insulating walls with support: it is kept, and it is conducted along them as far from them.
#include <fmt/format.h>

#include <numbers>

#include "tests/physics/case.h"

namespace molten::insulation_test {
namespace {

using namespace physics_case;

constexpr double spacing = 0.05, diffusivity = 0.05, length = 40 * spacing;

template <int Dim, class Real> State<Dim, Real> state_from(const std::string& text) {
  const Scene scene = parse_scene(text, "s.toml");
  return state_of<Dim, Real>(scene, fill_bodies(scene, features_of(scene)));
}

std::string vector(int dimensions, double x, double y, double z = 0) {
  return dimensions == 2 ? fmt::format("[{}, {}]", x, y) : fmt::format("[{}, {}, {}]", x, y, z);
}

constexpr double depth = 6 * spacing;  // in 3-D

std::string plane(const std::string& point, const std::string& normal, const std::string& more = "") {
  return fmt::format("[[boundary]]\nplane = {{ point = {}, normal = {} }}\n{}\n", point, normal, more);
}

std::string box(int dimensions, double width, double bottom, double top) {
  return fmt::format("box = {{ min = {}, max = {} }}", vector(dimensions, 0, bottom),
                     vector(dimensions, width, top, depth));
}

/// A closed tank with fluid up to two thirds of its height, whose lowest row, on the floor, is hot and conducts
/// `ratio` times as well.
std::string tank(int dimensions, double ratio, const std::string& velocity, const std::string& numerics) {
  const double width = 10 * spacing, height = 6 * spacing;
  return fmt::format(
      "[scene]\ndimensions = {}\ngravity = {}\n[fluid]\nspacing = {}\n[fluid.heat]\ndiffusivity = {}\n"
      "[[fluid.body]]\n{}\ntemperature = 100\ndiffusivity = {}\nvelocity = {}\n"
      "[[fluid.body]]\n{}\ntemperature = 0\nvelocity = {}\n"
      "[[boundary]]\n{}\ninside = true\n[numerics]\npreset = \"basic\"\nwall_support = true\ndensity_diffusion = 0.1\n"
      "sound_speed = 10\n{}\n[run]\nend_time = 10\n",
      dimensions, vector(dimensions, 0, 0), spacing, diffusivity, box(dimensions, width, 0, spacing),
      ratio * diffusivity, velocity, box(dimensions, width, spacing, height), velocity,
      box(dimensions, width, 0, 1.5 * height), numerics);
}

template <class F> class InsulatedTank : public ::testing::Test {
 protected:
  OneThread one;
};
TYPED_TEST_SUITE(InsulatedTank, Flavours, FlavourNames);

/// The hottest that is left of 100.
template <int Dim, class Real> double hottest(const State<Dim, Real>& s) {
  double most = 0;
  for_each_particle(s, [&](std::size_t slot) { most = std::max(most, s.particles[temperature][0][slot]); });
  return most;
}

TYPED_TEST(InsulatedTank, KeepsItsHeat) {
  MOLTEN_FLAVOUR;
  double worst = 0;
  for (const char* numerics : {"", "gradient_correction = true\nshifting = true", "integrator = \"runge_kutta_4\""})
    for (const double ratio : {1.0, 0.1}) {
      auto s = state_from<Dim, Real>(tank(Dim, ratio, vector(Dim, 0.5, 0.2, 0.3), numerics));
      const double before = diagnose(s).heat;
      for (int k = 0; k < 150; ++k) step(s);
      const double drift = std::abs(diagnose(s).heat / before - 1);
      worst = std::max(worst, drift);
      EXPECT_LT(drift, TypeParam::single ? 1e-7 : 1e-12) << numerics << ' ' << ratio;
      EXPECT_LT(hottest(s), ratio == 1 ? 75 : 95) << "or nothing flowed";
    }
  this->RecordProperty("drift", fmt::format("{:.3g}", worst));
}

TYPED_TEST(InsulatedTank, KeepsItsHeatAtRest) {
  MOLTEN_FLAVOUR;
  auto s = state_from<Dim, Real>(tank(Dim, 1, vector(Dim, 0, 0), "sleep = { after = 0.005 }"));
  const double before = diagnose(s).heat;
  while (s.sleep.asleep < static_cast<std::int64_t>(s.particles.count()) && s.clock.time < 0.1) step(s);
  const double warm = hottest(s);
  ASSERT_EQ(s.sleep.asleep, static_cast<std::int64_t>(s.particles.count()));
  ASSERT_GT(s.sleep.warm, 0);
  run_until(s, s.clock.time + 0.1);
  EXPECT_LT(hottest(s), 0.9 * warm) << "or nothing flowed";
  EXPECT_NEAR(diagnose(s).heat / before, 1, 1e-4);
}

// ---- along walls ----------------------------------------------------------------------------------------------------

/// A channel along x, between two planes at the ends of y, or closed on itself there as elsewhere.
std::string channel(int dimensions, int rows, bool walls, const std::string& numerics) {
  const double height = rows * spacing, margin = walls ? height : 0;
  const std::string periodic = std::string("\"x\"") + (walls ? "" : ", \"y\"") + (dimensions == 2 ? "" : ", \"z\"");
  std::string text = fmt::format(
      "[scene]\ndimensions = {}\ngravity = {}\nperiodic = [{}]\ndomain = {{ min = {}, max = {} }}\n[fluid]\n"
      "spacing = {}\n{}\n[fluid.heat]\ndiffusivity = {}\ninitial = 0\n[run]\nend_time = 10\n",
      dimensions, vector(dimensions, 0, 0), periodic, vector(dimensions, 0, -margin),
      vector(dimensions, length, height + margin, depth), spacing, box(dimensions, length, 0, height), diffusivity);
  if (walls)
    text += plane(vector(dimensions, 0, 0), vector(dimensions, 0, 1)) +
            plane(vector(dimensions, 0, height), vector(dimensions, 0, -1));
  return text + "[numerics]\npreset = \"basic\"\nsound_speed = 1\n" + numerics +
         (walls ? "\nwall_support = true\n" : "\n");
}

/// What is left of a wave of temperatures along a channel when theory has it at 1/e.
template <int Dim, class Real> double left_of_wave(const std::string& text) {
  const Scene scene = parse_scene(text, "s.toml");
  Start start = fill_bodies(scene, features_of(scene));
  const double wave_number = 2 * std::numbers::pi / length;
  const auto shape = [&](double x) { return std::cos(wave_number * x); };
  for (std::size_t k = 0; k < start.position.size(); ++k) start.temperature[k] = shape(start.position[k][0]);
  auto s = state_of<Dim, Real>(scene, start);
  run_until(s, 1 / (diffusivity * wave_number * wave_number));
  double sum = 0;
  for_each_particle(
      s, [&](std::size_t slot) { sum += s.particles[temperature][0][slot] * shape(s.particles[position][0][slot]); });
  return 2 * sum / static_cast<double>(s.particles.count());
}

TYPED_TEST(InsulatedTank, ConductsAlongItsWallsAsFarFromThem) {
  MOLTEN_FLAVOUR;
  for (const char* numerics : {"", "gradient_correction = true"}) {
    const double far = std::log(left_of_wave<Dim, Real>(channel(Dim, 6, false, numerics)));
    const double beside = std::log(left_of_wave<Dim, Real>(channel(Dim, 4, true, numerics)));
    this->RecordProperty(*numerics ? "corrected" : "plain", fmt::format("{:.4f}", beside / far));
    EXPECT_NEAR(beside / far, 1, 0.02) << numerics << "; a ninth less without what walls hide";
    EXPECT_NEAR(far, -1, 0.03);
  }
}

// ---- through layers -------------------------------------------------------------------------------------------------

/// A bar along x between planes: its ends with these keys, its sides insulating.
struct Bar {
  double length, across;       // m
  std::string heat, numerics;  // keys
  std::string left = "", right = "";

  std::string scene(int dimensions) const {
    const auto at = [&](double x, double y, double z = 0) { return vector(dimensions, x, y, z); };
    std::string text = fmt::format(
        "[scene]\ndimensions = {}\ngravity = {}\n[fluid]\nspacing = {}\nbox = {{ min = {}, max = {} }}\n[fluid.heat]\n"
        "{}\n[run]\nend_time = 10\n[numerics]\npreset = \"basic\"\nwall_support = true\n{}\n",
        dimensions, at(0, 0), spacing, at(0, 0), at(length, across, across), heat, numerics);
    text += plane(at(0, 0), at(1, 0), left) + plane(at(length, 0), at(-1, 0), right);
    text += plane(at(0, 0), at(0, 1)) + plane(at(0, across), at(0, -1));
    if (dimensions == 3) text += plane(at(0, 0), at(0, 0, 1)) + plane(at(0, 0, across), at(0, 0, -1));
    return text;
  }
};

/// Behind a layer that lets through a hundredth of what the bar could.
Bar bar_on_layer(int cells, const std::string& numerics) {
  Bar bar{cells * spacing, 6 * spacing, fmt::format("diffusivity = {}\ninitial = 100", diffusivity),
          "sound_speed = 1\n" + numerics};
  bar.left = fmt::format("temperature = 0\nground = {{ diffusivity = {}, thickness = {} }}", 0.001 * diffusivity,
                         0.1 * bar.length);
  return bar;
}

TYPED_TEST(InsulatedTank, CoolsThroughALayerAsItShould) {
  MOLTEN_FLAVOUR;
  constexpr int cells = 8;
  for (const char* numerics : {"", "gradient_correction = true", "smoothing_ratio = 2"}) {
    auto s = state_from<Dim, Real>(bar_on_layer(cells, numerics).scene(Dim));
    const double before = diagnose(s).heat, time = 5 * std::pow(cells * spacing, 2) / diffusivity;
    run_until(s, time);
    // The lowest wave's decay, μ² with μ tan μ = Bi = 0.01; in units of the length and its time.
    const double mu2 = 0.01 * (1 - 0.01 / 3), rate = std::log(before / diagnose(s).heat) / 5;
    this->RecordProperty(*numerics ? std::string(numerics).substr(0, 9) : "plain", fmt::format("{:.4f}", rate / mu2));
    EXPECT_NEAR(rate / mu2, 1, 0.012) << numerics;
  }
}

// ---- corners of insulating walls and of ones with a temperature -----------------------------------------------------

TYPED_TEST(InsulatedTank, HoldsALinearProfileUpToTheCorners) {
  MOLTEN_FLAVOUR;
  constexpr int cells = 12;
  for (const double smoothing_ratio : {1.3, 2.0}) {
    const Bar bar{cells * spacing,
                  4 * spacing,
                  "diffusivity = 1\ninitial = 30",
                  fmt::format("sound_speed = 20\nsmoothing_ratio = {}", smoothing_ratio),
                  "temperature = 0",
                  "temperature = 100"};
    auto s = state_from<Dim, Real>(bar.scene(Dim));
    run_until(s, std::pow(cells * spacing, 2));
    double furthest = 0;  // in the difference from one particle to the next
    for_each_particle(s, [&](std::size_t slot) {
      const double exact = 100 * s.particles[position][0][slot] / (cells * spacing);
      furthest = std::max(furthest, std::abs(s.particles[temperature][0][slot] - exact) / 100 * cells);
    });
    this->RecordProperty(smoothing_ratio < 2 ? "narrow" : "wide", fmt::format("{:.3g}", furthest));
    EXPECT_LT(furthest, 0.07) << smoothing_ratio << "; 0.1 to 0.6 by the distance of a piece, aside";
  }
}

}  // namespace
}  // namespace molten::insulation_test
