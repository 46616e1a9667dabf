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

/// Squared errors on the centre lines, over points and moments.
class LineErrors {
 public:
  explicit LineErrors(double reynolds) : exact_(cavity_flow(reynolds, points)) {}

  void add(const Cloud& c) {
    for (int k = 1; k < points; ++k) {
      const double at = static_cast<double>(k) / points;
      const double u = value_at(c, 2, {0.5, at, 0}, [&](std::size_t i) { return c.velocity[i][0]; });
      const double v = value_at(c, 2, {at, 0.5, 0}, [&](std::size_t i) { return c.velocity[i][1]; });
      u2_ += std::pow(u - exact_.u(at), 2), v2_ += std::pow(v - exact_.v(at), 2);
    }
    count_ += points - 1;
  }
  double u() const { return std::sqrt(u2_ / count_); }
  double v() const { return std::sqrt(v2_ / count_); }

 private:
  static constexpr int points = 64;  // intervals
  CentreLines exact_;
  double u2_ = 0, v2_ = 0, count_ = 0;
};

void run(const Request& r, Report& report) {
  report.expect("u_rms", 0.004);
  report.expect("v_rms", 0.004);
  const double spacing = 1.0 / static_cast<double>(r.size);
  Setup s;
  s.scene = scene_head(2, {}) + fluid_text(2, spacing, 1, newtonian_text(1 / r["reynolds"])) + sound_speed_text(10) +
            wall_support_text() + std::string(driven_text) + walls;
  s.start = lattice(2, {}, {1, 1, 0}, spacing);
  const auto simulation = Simulation::make(r, s, report);
  LineErrors errors(r["reynolds"]);
  for (int percent = 80; percent <= 100; ++percent) {  // few moments are good or bad by chance
    simulation->run_until(percent / 100.0 * r["end_time"]);
    errors.add(simulation->cloud());
  }
  report.judge("u_rms", errors.u());
  report.judge("v_rms", errors.v());
}

}  // namespace

Case cavity() {
  return {"cavity",
          "steady flow in a lid-driven cavity; rms of the velocity on both centre lines over the lid's speed, at 63 "
          "points each and 21 moments of the last fifth of the run",
          "particles a side",
          50,
          8,
          {{"reynolds", 100, "Re"}, {"end_time", 20, "side over the lid's speed; from 0.2 Re on the flow is steady"}},
          run};
}

}  // namespace molten::study
