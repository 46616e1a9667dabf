// Does water that has splashed about fill the volume that it had, and does it come to rest?
#include <gtest/gtest.h>

#include "bench/study/request.h"
#include "core/diagnostics.h"
#include "core/step.h"
#include "io/geometry/assemble.h"
#include "io/scene/scene_file.h"
#include "tests/with_threads.h"

namespace molten::splash_test {
namespace {

/// A block falls over in a closed tank, 0.4 m wide, and has come to rest but for a slow sway.
constexpr const char* splash = R"([fluid]
box = { min = [0.01, 0.01, 0.01], max = [0.15, 0.39, 0.3] }
spacing = 0.02
[[boundary]]
box = { min = [0, 0, 0], max = [0.4, 0.4, 0.4] }
inside = true
slip = 1
[run]
end_time = 3
[numerics]
wall_support = true
density_diffusion = 0.1
gradient_correction = true
shifting = true
)";

/// Energies at the end over those of still water, which is as deep as its volume says.
TEST(SlowSplash, WaterDoesNotSwell) {
  const WithThreads one(1);
  const Scene scene = parse_scene(splash, "splash.toml", {});
  const Features features = features_of(scene);
  const Start start = fill_bodies(scene, features);
  const Parameters<3> parameters = parameters_of<3>(scene, start);
  auto s = make_state<3, float>(features, parameters, build_surroundings(scene, start, parameters), start);
  while (s.clock.time < scene.run.end_time) step(s);
  const Diagnostics d = diagnose(s);
  const double mass = scene.fluid.density * start.measure, depth = start.measure / (0.4 * 0.4);
  const double still = mass * 9.81 * depth / 2;
  EXPECT_NEAR(d.potential_energy / still, 1, 0.08);
  EXPECT_LT(d.kinetic_energy / still, 0.1);
}

TEST(SlowSplash, ThinWaterInCornersDoesNotRunAway) {
  // It did where shifting kept up with the speeds that it raised: from 1500 to 12000 particles, within 1 to 4 s.
  const study::Case& box = study::find_case("kleefsman");
  study::Report report;
  EXPECT_TRUE(study::run_case(box, study::make_request(box, "1500", "internal", {"end_time=6"}), report));
  EXPECT_GT(report.steps, 3335);
}

}  // namespace
}  // namespace molten::splash_test
