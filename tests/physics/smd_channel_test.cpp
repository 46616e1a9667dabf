// Steady channel flow of Newtonian and viscoplastic fluids against their exact profiles. Walls that carry the fluid are
// not needed: in a periodic box whose halves are driven opposite ways the velocity vanishes where they meet, so each
// half is a channel between no-slip walls.
#include <fmt/format.h>

#include <cstdlib>
#include <fstream>

#include "tests/physics/case.h"

namespace molten::smd_channel_test {
namespace {

using namespace physics_case;

// A channel in units of its half gap, the yield stress, the strain rate γ̇₁ and the density.
constexpr double half_gap = 1;

struct Channel {
  int rows = 10;         // particles across half a gap
  double viscosity = 0;  // above 0: Newtonian
  double jump_number = 15;
  double flow_index = 0.5;
  double wall_stress = 2;
  double smoothing_ratio = 1.3;
};

Scene channel_scene(const Channel& c, double length) {
  Scene scene = plain_scene(2);
  scene.fluid.density = 1;
  if (c.viscosity > 0) {
    scene.fluid.rheology.viscosity = c.viscosity;
  } else {
    scene.fluid.rheology.model = Rheology::Model::smd;
    scene.fluid.rheology.jump_number = {c.jump_number, c.jump_number};
    scene.fluid.rheology.flow_index = c.flow_index;
  }
  scene.numerics.smoothing_ratio = c.smoothing_ratio;
  scene.numerics.sound_speed = 20;

  make_periodic(scene, {length, 4 * half_gap, 0});
  return scene;
}

// ---- the exact profile ----------------------------------------------------------------------------------------------

double stress_of(const Channel& c, double strain) {
  if (c.viscosity > 0) return c.viscosity * strain;
  return -std::expm1(-(c.jump_number + 1) * strain) * (std::pow(strain, c.flow_index) + 1);
}

/// The strain rate at which the fluid carries a stress.
double strain_at(const Channel& c, double stress) {
  double low = 0, high = 10;
  for (int k = 0; k < 100; ++k) {
    const double middle = (low + high) / 2;
    (stress_of(c, middle) < stress ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// Velocity over y from the middle (0) to the wall (1): the strain rate of τ = τ_w y, integrated from the wall.
class Profile {
 public:
  explicit Profile(const Channel& c) : velocity_(parts + 1, 0.0) {
    for (int k = parts; k > 0; --k) {
      const double y = (k - 0.5) / parts;
      velocity_[k - 1] = velocity_[k] + strain_at(c, c.wall_stress * y) / parts;
    }
  }
  double at(double y) const {
    const double k = std::min(std::abs(y), 1.0) * parts;
    const int low = std::min(static_cast<int>(k), parts - 1);
    return velocity_[low] + (k - low) * (velocity_[low + 1] - velocity_[low]);
  }
  double mean() const {
    double sum = 0;
    for (int k = 0; k < parts; ++k) sum += (velocity_[k] + velocity_[k + 1]) / 2 / parts;
    return sum;
  }

 private:
  static constexpr int parts = 20000;
  std::vector<double> velocity_;
};

/// Distance from the middle of the channel that y lies in, and the way that it flows.
double from_middle(double y) { return std::fmod(y + 4 * half_gap, 2 * half_gap) - half_gap; }
double way(double y) { return std::fmod(y + 4 * half_gap, 4 * half_gap) < 2 * half_gap ? 1 : -1; }

TEST(ChannelProfile, IsTheReferences) {
  EXPECT_NEAR(Profile({.jump_number = 15}).mean(), 0.1641063, 1e-6);
  EXPECT_NEAR(Profile({.jump_number = 150}).mean(), 0.1472812, 1e-6);
  EXPECT_NEAR(Profile({.viscosity = 1}).mean(), 2. / 3, 1e-6);
}

/// u over y of a reference file.
std::vector<std::array<double, 2>> read_reference(const std::string& file) {
  std::ifstream in(file);
  std::vector<std::array<double, 2>> rows;
  for (std::string line; std::getline(in, line);) {
    std::array<double, 2> row{};
    if (std::sscanf(line.c_str(), "%lf,%lf", &row[0], &row[1]) == 2) rows.push_back(row);
  }
  return rows;
}

TEST(ChannelProfile, AgreesWithTheFilesOfReferences) {
  const char* folder = std::getenv("MOLTEN_REFERENCE");
  if (!folder) GTEST_SKIP() << "MOLTEN_REFERENCE names no folder of references";
  for (const int jump : {0, 15, 150}) {
    const Profile profile({.jump_number = double(jump)});
    const auto rows = read_reference(fmt::format("{}/rheology/smd_channel_n0.5_J{}_tauw2.csv", folder, jump));
    ASSERT_GT(rows.size(), 100u) << jump;
    double mean = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      EXPECT_NEAR(profile.at(rows[k][0]), rows[k][1], 1e-6) << jump;
      if (k > 0) mean += (rows[k][0] - rows[k - 1][0]) * (rows[k][1] + rows[k - 1][1]) / 2;
    }
    EXPECT_NEAR(profile.mean(), mean, 1e-5) << jump;
  }
}

// ---- the run --------------------------------------------------------------------------------------------------------

struct Outcome {
  double error;     // rms of the velocity along, over the mean velocity
  double flow;      // mean velocity over the exact one, less 1
  double sideways;  // largest velocity across, over the mean velocity
};

/// One step of the solver with a force that gravity, the same everywhere, is not.
template <class Real> void driven_step(State<2, Real>& s, double force) {
  if (s.neighbours.is_due()) sort_and_list(s);
  if (s.features.stress) find_viscosity(s);
  find_rates(s);
  for_each_particle(s, [&](std::size_t slot) {
    s.particles[acceleration][0][slot] += static_cast<Real>(force * way(s.particles[position][1][slot]));
  });
  require_sane(s);
  choose_time_step(s);
  integrate_and_collide(s);
  s.clock.time += s.clock.dt;
  ++s.clock.step;
}

template <class Real> Outcome compare_with(const State<2, Real>& s, const Profile& profile) {
  double sum2 = 0, flow = 0, sideways = 0;
  for_each_particle(s, [&](std::size_t slot) {
    const double y = s.particles[position][1][slot];
    const double u = way(y) * s.particles[velocity][0][slot];
    sum2 += std::pow(u - profile.at(from_middle(y)), 2);
    flow += u;
    sideways = std::max(sideways, std::abs(double(s.particles[velocity][1][slot])));
  });
  const auto n = static_cast<double>(s.particles.count());
  const double mean = profile.mean();
  return {std::sqrt(sum2 / n) / mean, flow / n / mean - 1, sideways / mean};
}

/// From rest, or from the exact profile to see what the solver makes of it.
template <class Real> Outcome run_channel(const Channel& c, double end_time, bool from_rest = true) {
  const OneThread one;
  const double spacing = half_gap / c.rows, length = 8 * spacing;
  const Profile profile(c);
  Start start = lattice(2, {8, 4 * c.rows, 0}, spacing);
  for (std::size_t k = 0; k < start.position.size() && !from_rest; ++k) {
    const double y = start.position[k][1];
    start.velocity[k][0] = way(y) * profile.at(from_middle(y));
  }
  State<2, Real> s = state_of<2, Real>(channel_scene(c, length), start);
  while (s.clock.time < end_time) driven_step(s, c.wall_stress / half_gap);
  const Outcome o = compare_with(s, profile);
  ::testing::Test::RecordProperty("outcome", fmt::format("rms {:.4f} flow {:+.4f} sideways {:.4f} in {} steps", o.error,
                                                         o.flow, o.sideways, s.clock.step));
  return o;
}

void expect_within(const Outcome& o, double error, double flow) {
  EXPECT_LT(o.error, error);
  EXPECT_LT(std::abs(o.flow), flow);
  EXPECT_LT(o.sideways, 0.02);
}

// The kernel makes 0.974 of the Laplacian at 1.3 spacings (heat_test), so that the fluid flows 2.7 % too fast.
TEST(Channel, NewtonianWithTheLaminarTerm) {
  const Channel c{.viscosity = 1};
  expect_within(run_channel<double>(c, 4), 0.04, 0.04);
  expect_within(run_channel<float>(c, 4), 0.04, 0.04);
}

TEST(Channel, NewtonianAtTwoSpacings) {
  expect_within(run_channel<double>({.rows = 20, .viscosity = 1, .smoothing_ratio = 2}, 3), 0.006, 0.006);
}

// From the exact profile and for a short while: the kink of the profile where the halves meet sets velocities going
// that alternate from row to row.
TEST(Channel, ViscoplasticKeepsItsProfileForAWhile) {
  for (const double jump : {15.0, 150.0}) {
    const Outcome o = run_channel<double>({.jump_number = jump}, 0.05, false);
    EXPECT_LT(o.error, 0.15) << jump;
    EXPECT_LT(std::abs(o.flow), 0.1) << jump;
  }
}

// What follows fails by tens of percent with the bare sum of stresses, which does not feel such velocities.

// At stresses far below the yield stress the fluid has the viscosity η₀.
TEST(Channel, ViscoplasticThatIsAsGoodAsNewtonian) {
  expect_within(run_channel<double>({.jump_number = 0, .flow_index = 1, .wall_stress = 0.01}, 4), 0.05, 0.05);
}

TEST(Channel, Viscoplastic15FromRest) {
  expect_within(run_channel<double>({.jump_number = 15}, 4), 0.045, 0.035);
  expect_within(run_channel<float>({.jump_number = 15}, 4), 0.045, 0.035);
}

TEST(Channel, Viscoplastic150FromItsProfile) {
  expect_within(run_channel<double>({.jump_number = 150}, 0.3, false), 0.075, 0.02);
}

TEST(SlowChannel, Viscoplastic15Finer) {
  expect_within(run_channel<double>({.rows = 20, .jump_number = 15}, 4), 0.03, 0.02);
}

TEST(SlowChannel, Viscoplastic150FromRest) { expect_within(run_channel<double>({.jump_number = 150}, 3), 0.075, 0.03); }

}  // namespace
}  // namespace molten::smd_channel_test
