// The same bits for any number of threads: the rates, and runs of whole steps with walls, heat and changing viscosity.
// And whatever the age of the list, so that a run that goes on with a new one after a restart keeps its bits.
#include <gtest/gtest.h>

#include <cstring>

#include "tests/particle_sets.h"
#include "tests/with_threads.h"

namespace molten::threads_test {
namespace {

using namespace particle_sets;

/// All columns and the clock as they are in memory.
template <int Dim, class Real> std::vector<unsigned char> bits_of(const State<Dim, Real>& s) {
  std::vector<unsigned char> bits;
  const auto append = [&](const void* data, std::size_t bytes) {
    const std::size_t at = bits.size();
    bits.resize(at + bytes);
    std::memcpy(bits.data() + at, data, bytes);
  };
  for_each_field([&]<class F>(F) {
    if (!s.particles.has(F{})) return;
    for (const auto* column : s.particles[F{}].c) append(column, s.particles.slots() * sizeof *column);
  });
  append(&s.clock.time, sizeof s.clock.time);
  append(&s.extremes.speed2, sizeof s.extremes.speed2);
  append(&s.extremes.acceleration2, sizeof s.extremes.acceleration2);
  return bits;
}

/// A floor and the walls of a tank `width` m wide, from the origin on.
template <int Dim> std::vector<Wall<Dim>> tank(double width) {
  std::vector<Wall<Dim>> walls;
  for (int d = 0; d < Dim; ++d)
    for (int side = 0; side < (d == Dim - 1 ? 1 : 2); ++side) {
      Wall<Dim> wall;
      wall.is_plane = true;
      wall.plane_normal[d] = side == 0 ? 1 : -1;
      wall.plane_point[d] = side * width;
      wall.response = {0, 1};
      walls.push_back(wall);
    }
  return walls;
}

Scene dam_break(int dim) {
  Scene scene = plain_scene(dim);
  scene.gravity = dim == 2 ? std::array<double, 3>{0, -9.81, 0} : std::array<double, 3>{0, 0, -9.81};
  scene.numerics.sound_speed.reset();
  scene.numerics.artificial_viscosity = 0.1;
  return scene;
}

Scene melting_block(int dim) {
  Scene scene = dam_break(dim);
  scene.fluid.rheology = {Rheology::Model::smd, 0, 0.5, {15, 150}, 60, 20};
  scene.fluid.heat = Heat{1e-4, std::array<double, 2>{40, 60}, 20, 90};
  scene.numerics.xsph = Xsph{Xsph::Form::velocity, 0.3};
  scene.numerics.integrator = IntegratorKind::symplectic_euler;
  return scene;
}

Scene shifted_flow(int dim) {
  Scene scene = melting_block(dim);
  scene.numerics.gradient_correction = true;
  scene.numerics.stress_form = StressForm::pairwise;
  scene.numerics.shifting = Shifting{};
  return scene;
}

template <int Dim, class Real> State<Dim, Real> start_run(const Scene& scene) {
  const double spacing = 0.02;
  Start start = start_of(scene, cube<Dim>(Dim == 2 ? 40 : 13, spacing, 0.1), spacing);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> warm(20, 90), fast(-1, 1);
  for (double& T : start.temperature) T = warm(random);
  if (features_of(scene).varied_conduction)
    for (const auto& x : start.position) start.conductivity.push_back(x[0] < 0.3 ? 1 : 100);
  for (auto& v : start.velocity)  // so that 50 steps see sorts and bounces
    for (int d = 0; d < Dim; ++d) v[d] = fast(random);
  return state_of<Dim, Real>(scene, start, tank<Dim>(Dim == 2 ? 1.6 : 0.52));
}

template <int Dim, class Real> std::vector<unsigned char> bits_after(const Scene& scene, int threads, int steps) {
  const WithThreads set(threads);
  auto s = start_run<Dim, Real>(scene);
  for (int k = 0; k < steps; ++k) step(s);
  return bits_of(s);
}

template <class F> class ThreadsOf : public testing::Test {};
TYPED_TEST_SUITE(ThreadsOf, Flavours, FlavourNames);

template <int Dim, class Real> void expect_same_bits(const Scene& scene, int steps) {
  const auto one = bits_after<Dim, Real>(scene, 1, steps);
  for (const int threads : {2, 3}) EXPECT_EQ(one == (bits_after<Dim, Real>(scene, threads, steps)), true) << threads;
}

TYPED_TEST(ThreadsOf, RatesOfADamBreak) {
  expect_same_bits<TypeParam::dim, typename TypeParam::Real>(dam_break(TypeParam::dim), 1);
}

TYPED_TEST(ThreadsOf, DamBreakOf50Steps) {
  expect_same_bits<TypeParam::dim, typename TypeParam::Real>(dam_break(TypeParam::dim), 50);
}

TYPED_TEST(ThreadsOf, MeltingBlockOf50Steps) {
  expect_same_bits<TypeParam::dim, typename TypeParam::Real>(melting_block(TypeParam::dim), 50);
}

TYPED_TEST(ThreadsOf, ShiftedFlowOf30Steps) {
  expect_same_bits<TypeParam::dim, typename TypeParam::Real>(shifted_flow(TypeParam::dim), 30);
}

TYPED_TEST(ThreadsOf, ConsistentLaplaciansOf20Steps) {
  Scene scene = shifted_flow(TypeParam::dim);
  scene.numerics.laplacian = LaplacianForm::consistent;
  expect_same_bits<TypeParam::dim, typename TypeParam::Real>(scene, 20);
}

TYPED_TEST(ThreadsOf, BodiesThatConductDifferentlyOf20Steps) {
  Scene scene = melting_block(TypeParam::dim);
  scene.fluid.bodies.emplace_back().diffusivity = 1e-2;
  expect_same_bits<TypeParam::dim, typename TypeParam::Real>(scene, 20);
}

TYPED_TEST(ThreadsOf, RungeKuttaOf10Steps) {
  Scene scene = melting_block(TypeParam::dim);
  scene.numerics.integrator = IntegratorKind::runge_kutta_4;
  expect_same_bits<TypeParam::dim, typename TypeParam::Real>(scene, 10);
}

TYPED_TEST(ThreadsOf, WallsWithSupportOf50Steps) {
  Scene scene = melting_block(TypeParam::dim);
  scene.numerics.wall_support = true;
  scene.numerics.density_diffusion = 0.1;
  expect_same_bits<TypeParam::dim, typename TypeParam::Real>(scene, 50);
}

TYPED_TEST(ThreadsOf, ShiftedFlowBetweenWallsWithSupportOf30Steps) {
  Scene scene = shifted_flow(TypeParam::dim);
  scene.numerics.wall_support = true;
  scene.numerics.density_diffusion = 0.1;
  expect_same_bits<TypeParam::dim, typename TypeParam::Real>(scene, 30);
}

/// The rates with the list's narrowest shell and with wider ones, which add pairs out of reach.
template <int Dim, class Real> void expect_same_bits_from_wider_shells(const Scene& scene) {
  auto s = start_run<Dim, Real>(scene);
  for (int k = 0; k < 3; ++k) step(s);
  sort_and_list(s);
  find_all_rates(s);
  const auto narrowest = bits_of(s);
  for (int k = 0; k < 2; ++k) {
    s.neighbours.moved(0.22 * s.parameters.skin);
    ASSERT_FALSE(s.neighbours.is_due());
    find_all_rates(s);
    EXPECT_EQ(narrowest == bits_of(s), true) << k;
  }
}

TYPED_TEST(ThreadsOf, RatesFromWiderShells) {
  constexpr int Dim = TypeParam::dim;
  using Real = typename TypeParam::Real;
  Scene smooth = dam_break(Dim);
  smooth.numerics.gradient_correction = true;
  for (const bool support : {false, true})
    for (Scene scene : {dam_break(Dim), melting_block(Dim), shifted_flow(Dim), smooth}) {
      scene.numerics.wall_support = support;
      if (support) scene.numerics.density_diffusion = 0.1;
      expect_same_bits_from_wider_shells<Dim, Real>(scene);
    }
}

TYPED_TEST(ThreadsOf, TheBitsDoChangeWithTheState) {
  // So that the comparisons above are known to see a difference.
  constexpr int Dim = TypeParam::dim;
  using Real = typename TypeParam::Real;
  EXPECT_NE((bits_after<Dim, Real>(dam_break(Dim), 1, 3)), (bits_after<Dim, Real>(dam_break(Dim), 1, 4)));
}

}  // namespace
}  // namespace molten::threads_test
