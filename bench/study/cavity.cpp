// The lid-driven cavity [0, 1]² (lid speed, side and density 1) against differences on a grid.
#include <cmath>

#include "bench/study/cavity_flow.h"
#include "bench/study/list.h"
#include "bench/study/particles.h"
#include "bench/study/scene_text.h"

namespace molten::study {

namespace {

constexpr const char* walls = R"([[boundary]]
plane = { point = [0, 0], normal = [0, 1] }
[[boundary]]
plane = { point = [0, 0], normal = [1, 0] }
[[boundary]]
plane = { point = [1, 0], normal = [-1, 0] }
[[boundary]]
plane = { point = [0, 1], normal = [0, -1] }
velocity = [1, 0]
)";

void run(const Request& r, Report& report) {
  report.expect("u_rms", 0.004);
  report.expect("v_rms", 0.004);
  const double spacing = 1.0 / static_cast<double>(r.size);
  Setup s;
  s.scene = scene_head(2, {}) + fluid_text(2, spacing, 1, newtonian_text(1 / r["reynolds"])) + sound_speed_text(10) +
            wall_support_text() + walls;
  s.start = lattice(2, {}, {1, 1, 0}, spacing);
  const auto simulation = Simulation::make(r, s, report);
  simulation->run_until(r["end_time"]);

  const Cloud c = simulation->cloud();
  const CentreLines exact = cavity_flow(r["reynolds"], 64);
  constexpr int points = 100;
  double u2 = 0, v2 = 0;
  for (int k = 1; k < points; ++k) {
    const double at = static_cast<double>(k) / points;
    u2 += std::pow(value_at(c, 2, {0.5, at, 0}, [&](std::size_t i) { return c.velocity[i][0]; }) - exact.u(at), 2);
    v2 += std::pow(value_at(c, 2, {at, 0.5, 0}, [&](std::size_t i) { return c.velocity[i][1]; }) - exact.v(at), 2);
  }
  report.judge("u_rms", std::sqrt(u2 / (points - 1)));
  report.judge("v_rms", std::sqrt(v2 / (points - 1)));
}

}  // namespace

Case cavity() {
  return {"cavity",
          "lid-driven cavity; rms of the velocity on both centre lines over the lid's speed, at 99 points each",
          "particles a side",
          50,
          8,
          {{"reynolds", 100, "Re"}, {"end_time", 10, "side over the lid's speed"}},
          run};
}

}  // namespace molten::study
