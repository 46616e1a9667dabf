// Heat conduction: decay of a wave and two slabs in contact against their exact solutions, the kernel's known factor on
// a lattice, heat that is neither made nor lost, interfaces of bodies, and a melting front.
#include <fmt/format.h>

#include <map>

#include "tests/physics/case.h"

namespace molten::heat_test {
namespace {

using namespace physics_case;
constexpr double pi = std::numbers::pi;
constexpr double diffusivity = 0.1;

Scene heated_scene(int dimensions, double fixed_dt, double smoothing_ratio) {
  Scene scene = plain_scene(dimensions);
  scene.fluid.heat = Heat{};
  scene.fluid.heat->diffusivity = diffusivity;
  scene.numerics.smoothing_ratio = smoothing_ratio;
  scene.numerics.fixed_dt = fixed_dt;
  return scene;
}

/// Σ V_j (1 − cos κ x) (−2 W'/r) / κ² over a lattice: what the Wendland kernel makes of ∇² of a wave, by brute force.
double wendland_factor(int dimensions, double smoothing_ratio, double wave_number, double spacing) {
  const double h = smoothing_ratio * spacing;
  const double constant = dimensions == 2 ? 7 / (4 * pi) : 21 / (16 * pi);
  const int reach = static_cast<int>(std::ceil(2 * smoothing_ratio));
  double sum = 0;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      for (int k = dimensions == 3 ? -reach : 0; k <= (dimensions == 3 ? reach : 0); ++k) {
        const double q = std::sqrt(i * i + j * j + k * k) / smoothing_ratio;
        if (q >= 2) continue;
        const double slope = -5 * constant * std::pow(1 - q / 2, 3) / std::pow(h, dimensions + 2);  // W'/r
        sum += std::pow(spacing, dimensions) * (1 - std::cos(wave_number * i * spacing)) * -2 * slope;
      }
  return sum / (wave_number * wave_number);
}

TEST(LatticeFactor, IsWhatTheoryOfTheKernelSays) {
  const double long_wave = 1e-3;  // per spacing
  EXPECT_NEAR(wendland_factor(2, 1.3, long_wave, 1), 0.974, 5e-4);
  EXPECT_NEAR(wendland_factor(3, 1.3, long_wave, 1), 0.979, 5e-4);
  EXPECT_NEAR(wendland_factor(2, 2, long_wave, 1), 0.999, 5e-4);
  EXPECT_NEAR(wendland_factor(3, 2, long_wave, 1), 0.999, 5e-4);
}

/// A wave along x in a periodic box of length 1.
template <int Dim, class Real> struct Wave {
  static constexpr int cells = 48, across = 9;
  static constexpr double spacing = 1.0 / cells, mean = 50, height = 10;
  static constexpr double rate = diffusivity * 4 * pi * pi;  // k κ²
  static constexpr int steps = 300;
  double dt = 0.5 / rate / steps;  // the wave falls to e^(−1/2)

  State<Dim, Real> start(double smoothing_ratio) const {
    Scene scene = heated_scene(Dim, dt, smoothing_ratio);
    make_periodic(scene, {1, across * spacing, across * spacing});
    Start start = lattice(Dim, {cells, across, across}, spacing);
    for (const Triple& x : start.position) start.temperature.push_back(mean + height * std::sin(2 * pi * x[0]));
    return state_of<Dim, Real>(scene, start);
  }

  /// The share of the wave that is left.
  static double amplitude(const State<Dim, Real>& s) {
    double sum = 0;
    for_each_particle(s, [&](std::size_t slot) {
      sum += (s.particles[temperature][0][slot] - mean) * std::sin(2 * pi * s.particles[position][0][slot]);
    });
    return 2 * sum / static_cast<double>(s.particles.count()) / height;
  }

  /// Largest deviation from the exact solution, as a share of the wave at the start.
  static double worst(const State<Dim, Real>& s, double left) {
    double worst = 0;
    for_each_particle(s, [&](std::size_t slot) {
      const double exact = mean + height * left * std::sin(2 * pi * s.particles[position][0][slot]);
      worst = std::max(worst, std::abs(s.particles[temperature][0][slot] - exact) / height);
    });
    return worst;
  }

  State<Dim, Real> run(double smoothing_ratio) const {
    State<Dim, Real> s = start(smoothing_ratio);
    for (int k = 0; k < steps; ++k) step(s);
    return s;
  }

  /// The rate that the run shows over the exact one; what explicit steps add is taken out.
  double factor(const State<Dim, Real>& s) const { return (1 - std::pow(amplitude(s), 1.0 / steps)) / dt / rate; }
};

template <class F> class HeatWave : public ::testing::Test {
 protected:
  OneThread one;
};
TYPED_TEST_SUITE(HeatWave, Flavours, FlavourNames);

// At h = 2 spacings the kernel is within 0.1 % of ∇², and what is left over is the wave's own curvature over h.
TYPED_TEST(HeatWave, DecaysAsTheExactSolution) {
  const Wave<TypeParam::dim, typename TypeParam::Real> wave;
  const auto s = wave.run(2);
  const double error = wave.worst(s, std::exp(-wave.rate * s.clock.time));
  const double expected = wendland_factor(TypeParam::dim, 2, 2 * pi, wave.spacing);
  this->RecordProperty("worst", fmt::format("{:.3g}", error));
  this->RecordProperty("factor", fmt::format("{:.6f}", wave.factor(s)));
  EXPECT_LT(error, 2e-3);
  EXPECT_NEAR(wave.factor(s), expected, TypeParam::single ? 2e-6 : 1e-10);
}

TYPED_TEST(HeatWave, DecaysAtTheKernelsPaceAtTheUsualSmoothingLength) {
  const Wave<TypeParam::dim, typename TypeParam::Real> wave;
  const auto s = wave.run(1.3);
  const double expected = wendland_factor(TypeParam::dim, 1.3, 2 * pi, wave.spacing);
  this->RecordProperty("factor", fmt::format("{:.6f}", wave.factor(s)));
  EXPECT_NEAR(wave.factor(s), expected, TypeParam::single ? 2e-6 : 1e-10);
  EXPECT_NEAR(expected, TypeParam::dim == 2 ? 0.974 : 0.979, 3e-3);
}

// ---- heat is conserved ----------------------------------------------------------------------------------------------

/// A jittered block with free surfaces, hot at one end, that turns and shears as it goes; where it is hot it conducts
/// `ratio` times as well.
template <int Dim, class Real> State<Dim, Real> insulated_body(double ratio) {
  Scene scene = heated_scene(Dim, 2e-4, 1.3);
  if (ratio != 1) scene.fluid.bodies.emplace_back().diffusivity = diffusivity;
  scene.fluid.heat->diffusivity = diffusivity / ratio;
  scene.numerics.sound_speed = 5;
  scene.numerics.artificial_viscosity = 0.5;
  Start start = lattice(Dim, {Dim == 3 ? 12 : 30, Dim == 3 ? 9 : 20, 8}, 0.05);
  jitter(start, Dim, 0.2);
  for (std::size_t k = 0; k < start.position.size(); ++k) {
    const Triple& x = start.position[k];
    start.temperature.push_back(x[0] < 0.3 ? 1400 : 300);
    if (ratio != 1) start.conductivity.push_back(x[0] < 0.3 ? ratio : 1);
    start.velocity[k] = {-0.8 * x[1], 0.5 * x[0], 0};
  }
  return state_of<Dim, Real>(scene, start);
}

template <class F> class InsulatedBody : public ::testing::Test {
 protected:
  OneThread one;
};
TYPED_TEST_SUITE(InsulatedBody, Flavours, FlavourNames);

/// How much of it flows in 400 steps, as a part of all.
template <int Dim, class Real> double expect_kept(double ratio, double tolerance) {
  auto s = insulated_body<Dim, Real>(ratio);
  const double before = diagnose(s).heat;
  double exchanged = 0;  // so that the figure is one of a body in which heat flows
  for (int k = 0; k < 400; ++k) {
    step(s);
    for_each_particle(s, [&](std::size_t slot) {
      exchanged += s.clock.dt * s.parameters.particle_mass * std::abs(s.particles[temperature_rate][0][slot]) / 2;
    });
  }
  const double drift = std::abs(diagnose(s).heat / before - 1);
  ::testing::Test::RecordProperty("drift", fmt::format("{:.3g}", drift));
  EXPECT_LT(drift, tolerance);
  for_each_particle(s, [&](std::size_t slot) {  // and nothing is hotter than the hottest, or colder than the coldest
    EXPECT_LE(s.particles[temperature][0][slot], 1400 * (1 + 1e-6));
    EXPECT_GE(s.particles[temperature][0][slot], 300 * (1 - 1e-6));
  });
  return exchanged / before;
}

TYPED_TEST(InsulatedBody, KeepsItsHeat) {
  const double tolerance = TypeParam::single ? 1e-8 : 1e-12;
  const double alike = expect_kept<TypeParam::dim, typename TypeParam::Real>(1, tolerance);
  const double cold_insulates = expect_kept<TypeParam::dim, typename TypeParam::Real>(100, tolerance);
  EXPECT_GT(alike, 0.02);
  EXPECT_LT(cold_insulates, alike);
  EXPECT_GT(cold_insulates, 0.001);
}

// ---- where bodies that conduct differently meet ---------------------------------------------------------------------

/// Blocks of 12 and 12 columns, the right one conducting 10 times as well.
template <int Dim, class Real> State<Dim, Real> two_blocks(double displacement) {
  Scene scene = heated_scene(Dim, 1e-4, 1.3);
  scene.fluid.bodies.emplace_back().diffusivity = 10 * diffusivity;
  Start start = lattice(Dim, {24, 15, 15}, 1);
  for (const Triple& x : start.position) {
    start.temperature.push_back(0);
    start.conductivity.push_back(x[0] < 12 ? 1 : 10);
  }
  jitter(start, Dim, displacement);
  auto s = state_of<Dim, Real>(scene, start);
  find_all_rates(s);
  return s;
}

/// Calls f(distance of the plane, what the particle found), in spacings; what the column beside it finds on the lattice
/// counts as half a spacing, as only ratios matter.
template <int Dim, class Real, class F> void for_each_distance(double displacement, const F& f) {
  const auto even = two_blocks<Dim, Real>(0), s = two_blocks<Dim, Real>(displacement);
  double factor = 0;
  for_each_particle(even, [&](std::size_t slot) {
    if (std::abs(even.particles[position][0][slot] - 11.5) < 0.1)
      factor = 2 * even.particles[interface_distance][0][slot];
  });
  for_each_particle(s, [&](std::size_t slot) {
    const double d = s.particles[interface_distance][0][slot], k = s.particles[conductivity][0][slot];
    EXPECT_NEAR(d / k, s.particles[interface_resistance][0][slot], 1e-6 * d);
    f(std::abs(s.particles[position][0][slot] - 12), d / factor);
  });
}

template <class F> class Interface : public ::testing::Test {
 protected:
  OneThread one;
};
TYPED_TEST_SUITE(Interface, Flavours, FlavourNames);

TYPED_TEST(Interface, IsAsFarAsThePlane) {
  std::map<double, int> seen;
  for_each_distance<TypeParam::dim, typename TypeParam::Real>(0, [&](double exact, double found) {
    ++seen[exact];
    if (exact < 2)
      EXPECT_NEAR(found / exact, 1, 0.1) << exact;
    else
      EXPECT_GT(found, 2) << exact;
  });
  EXPECT_EQ(seen.size(), 12);
}

TYPED_TEST(Interface, IsAsFarAsThePlaneInDisorder) {
  double sum2 = 0;
  int count = 0;
  for_each_distance<TypeParam::dim, typename TypeParam::Real>(0.2, [&](double exact, double found) {
    if (exact > 1.5) return;
    ++count;
    sum2 += (found - exact) * (found - exact);
  });
  this->RecordProperty("rms", fmt::format("{:.3g}", std::sqrt(sum2 / count)));
  EXPECT_LT(std::sqrt(sum2 / count), 0.15) << "spacings";
}

// ---- two slabs in contact, and the front in between that melts ------------------------------------------------------

constexpr double cold = 20, hot = 90, middle = 1.5;

/// A bar of length 3, hot in its upper half, at rest; free ends far from the contact.
template <int Dim, class Real> State<Dim, Real> two_slabs() {
  constexpr double spacing = 0.05, across = 9 * spacing;
  Scene scene = heated_scene(Dim, 1e-3, 2);
  scene.fluid.heat->melting_range = {40, 60};
  scene.fluid.rheology.model = Rheology::Model::smd;
  scene.fluid.rheology.jump_number = {0, 100};
  Start start = lattice(Dim, {60, 9, 9}, spacing);
  make_periodic(scene, {3, across, across});
  scene.periodic[0] = false;
  for (const Triple& x : start.position) start.temperature.push_back(x[0] > middle ? hot : cold);
  return state_of<Dim, Real>(scene, start);
}

template <class F> class MeltingFront : public ::testing::Test {
 protected:
  OneThread one;
};
TYPED_TEST_SUITE(MeltingFront, Flavours, FlavourNames);

template <int Dim, class Real> double exact_temperature(const State<Dim, Real>& s, std::size_t slot) {
  const double x = s.particles[position][0][slot] - middle;
  return (hot + cold) / 2 + (hot - cold) / 2 * std::erf(x / std::sqrt(4 * diffusivity * s.clock.time));
}

/// The hot side stays hot and flows, the cold one stays stiff.
template <int Dim, class Real> void expect_soft_where_hot(const State<Dim, Real>& s) {
  const double stiff = s.parameters.smd.viscosity(0, cold), soft = s.parameters.smd.viscosity(0, hot);
  EXPECT_NEAR(stiff / soft, 101, 1e-9);
  for_each_particle(s, [&](std::size_t slot) {
    const double T = s.particles[temperature][0][slot], eta = s.particles[viscosity][0][slot];
    EXPECT_EQ(s.particles[position][0][slot] > middle, T > (hot + cold) / 2);
    const double low = T < 39 ? stiff : soft, high = T > 61 ? soft : stiff;
    EXPECT_GE(eta, low * 0.99) << T;
    EXPECT_LE(eta, high * 1.01) << T;
  });
}

TYPED_TEST(MeltingFront, FollowsTheTwoSlabsInContact) {
  auto s = two_slabs<TypeParam::dim, typename TypeParam::Real>();
  for (int k = 0; k < 300; ++k) step(s);
  double sum2 = 0, worst = 0;
  for_each_particle(s, [&](std::size_t slot) {
    const double error = std::abs(s.particles[temperature][0][slot] - exact_temperature(s, slot)) / (hot - cold);
    worst = std::max(worst, error);
    sum2 += error * error;
  });
  const double rms = std::sqrt(sum2 / static_cast<double>(s.particles.count()));
  this->RecordProperty("worst", fmt::format("{:.3g}", worst));
  this->RecordProperty("rms", fmt::format("{:.3g}", rms));
  EXPECT_LT(worst, 5e-3);
  EXPECT_LT(rms, 2e-3);
  expect_soft_where_hot(s);
}

}  // namespace
}  // namespace molten::heat_test
