// fluid.hydrostatic: columns squeezed by their own weight, each on its floor.
#include "core/hydrostatic.h"

#include <gtest/gtest.h>

#include "tests/physics/case.h"

namespace molten::hydrostatic_start_test {
namespace {

using namespace physics_case;

constexpr double spacing = 0.1, gravity = 10;

Scene still_scene(int dimensions, StateEquation kind) {
  Scene scene = plain_scene(dimensions);
  scene.gravity = {};
  scene.gravity[dimensions - 1] = -gravity;
  scene.fluid.hydrostatic = true;
  scene.numerics.state_equation = kind;
  scene.numerics.sound_speed = 10;  // so that a metre of fluid is squeezed by centimetres
  return scene;
}

template <int Dim> class AtRest {
 public:
  AtRest(const Scene& scene, const Start& start, bool squeezed = true)
      : start_(start), parameters_(parameters_of<Dim>(scene, start)), fluid_(parameters_, start, squeezed) {}

  double height(std::size_t k) const { return fluid_.place(start_, k)[Dim - 1]; }
  double compression(std::size_t k) const { return fluid_.compression(fluid_.place(start_, k)); }
  double pressure(std::size_t k) const { return parameters_.eos.pressure(compression(k)); }

 private:
  const Start& start_;
  Parameters<Dim> parameters_;
  FluidAtRest<Dim> fluid_;
};

TEST(HydrostaticStart, GivesEachParticleTheWeightAbove) {
  for (const StateEquation kind : {StateEquation::tait, StateEquation::linear}) {
    const Scene scene = still_scene(3, kind);
    const Start start = lattice(3, {2, 2, 10}, spacing);
    const AtRest<3> rest(scene, start);
    for (std::size_t k = 0; k < start.position.size(); ++k) {
      const double above = 1 - start.position[k][2];  // m of uncompressed fluid
      // The surface is taken half a spacing above the highest particle, which is a little less dense there.
      EXPECT_NEAR(rest.pressure(k), 1000 * gravity * above, 0.01 * 1000 * gravity * spacing);
      EXPECT_LT(rest.height(k), start.position[k][2]) << "or it is not squeezed";
    }
    EXPECT_GT(rest.compression(0), 0.05);
  }
}

TEST(HydrostaticStart, KeepsNeighboursAsFarApartAsTheyAreDense) {
  const Scene scene = still_scene(2, StateEquation::tait);
  const Start start = lattice(2, {1, 10, 0}, spacing);
  const AtRest<2> rest(scene, start);
  for (std::size_t k = 1; k < start.position.size(); ++k) {
    const double density = 1 + (rest.compression(k - 1) + rest.compression(k)) / 2;
    EXPECT_NEAR((rest.height(k) - rest.height(k - 1)) * density, spacing, 1e-4 * spacing);
  }
}

TEST(HydrostaticStart, PutsEachColumnOnItsOwnFloor) {
  const Scene scene = still_scene(2, StateEquation::tait);
  Start start = lattice(2, {2, 10, 0}, spacing);  // over a step of half the height; above a gap in the first column
  std::erase_if(start.position,
                [](const Triple& x) { return x[0] < spacing ? std::abs(x[1] - 0.6) < 1.6 * spacing : x[1] < 0.5; });
  start.velocity.resize(start.position.size());
  const AtRest<2> rest(scene, start);
  for (std::size_t k = 0; k < start.position.size(); ++k) {
    const double x = start.position[k][0], y = start.position[k][1], floor = x > spacing ? 0.5 : y < 0.5 ? 0 : 0.8;
    const bool lowest = y < floor + spacing;
    EXPECT_GE(rest.height(k), floor);
    EXPECT_GT(rest.height(k), y - (lowest ? 0.06 : 1.0) * spacing) << x << ' ' << y;
  }
}

TEST(HydrostaticStart, LeavesTheLatticeWhereItIsNotToBeSqueezed) {
  const Scene scene = still_scene(2, StateEquation::tait);
  const Start start = lattice(2, {2, 10, 0}, spacing);
  const AtRest<2> rest(scene, start, false);
  EXPECT_EQ(rest.height(0), start.position[0][1]);
  EXPECT_GT(rest.compression(0), 0.05);
  Scene weightless = scene;
  weightless.gravity = {};
  const AtRest<2> floating(weightless, start);
  EXPECT_EQ(floating.height(0), start.position[0][1]);
  EXPECT_EQ(floating.compression(0), 0);
}

}  // namespace
}  // namespace molten::hydrostatic_start_test
