// Free bodies from scenes: what is refused, and that the lightest that is not gains nothing from the fluid.
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/step.h"
#include "tests/physics/case.h"

namespace molten::free_body_test {
namespace {

/// Water 0.5 m deep; a box of 0.6 m × 0.3 m starts 0.1 m above it.
std::string box_over_water(double density) {
  return "[scene]\ndimensions = 2\n[fluid]\nbox = { min = [0, 0], max = [2, 0.5] }\nspacing = 0.04\n[[boundary]]\n"
         "box = { min = [0, 0], max = [2, 2] }\ninside = true\nslip = 0.5\n[[boundary]]\n"
         "box = { min = [0.7, 0.6], max = [1.3, 0.9] }\nbody = { density = " +
         std::to_string(density) + " }\n[run]\nend_time = 1\n";
}

State<2, float> state_with(double density) {
  const Scene scene = parse_scene(box_over_water(density), "s.toml");
  return physics_case::state_of<2, float>(scene, fill_bodies(scene, features_of(scene)));
}

// Half of its surface, 0.9 m, touches 36 kg of water: 18 kg are 100 kg/m³.
TEST(FreeBody, LighterThanHalfOfWhatItTouchesIsRefused) {
  for (const double density : {99.0, 30.0, 1e-3}) {
    try {
      state_with(density);
      ADD_FAILURE() << density;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("boundary.1.body.density"), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("give 100 kg/m³ or more"), std::string::npos) << e.what();
    }
  }
}

TEST(FreeBody, TheLightestThatIsAllowedDoesNotBounceAboveItsStart) {
  const WithThreads one(1);
  State<2, float> s = state_with(100.5);
  const double start = s.bodies.motion(0).start.centre[1];
  double highest = start, lowest = start;
  s.clock.stop = 1;
  while (s.clock.time < 1) {
    step(s);
    highest = std::max(highest, s.bodies.motion(0).start.centre[1]);
    lowest = std::min(lowest, s.bodies.motion(0).start.centre[1]);
  }
  EXPECT_LT(lowest, 0.66) << "it has reached the water";
  EXPECT_LE(highest, start);
}

}  // namespace
}  // namespace molten::free_body_test
