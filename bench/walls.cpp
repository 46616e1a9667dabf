// What walls cost a step: build/release/bench/walls [walls/NAME ...] [--steps=N]
// Each row takes two runs of the same moving particles a step each in turn, without and with one thing: contact with
// walls, or support at them. Both start anew from the same moment every few steps, so that they stay alike. The cost is
// the share of the step with it (contact) or of the step without it (support), a median with the interval that holds it
// with 95 % confidence; at the end a table holds it against its reach. `far`: with walls nowhere near the fluid.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/cases.h"
#include "bench/dam_break.h"
#include "bench/program.h"
#include "bench/ratio.h"
#include "core/step.h"
#include "io/geometry/assemble.h"
#include "io/scene/scene_file.h"

namespace molten::bench {
namespace {

constexpr int warm_steps = 5, steps_a_round = 40;

/// Two runs from one moment.
struct Comparison {
  Scene without, with;
  Moment moment;
};

struct Result {
  std::string name;
  double without, with, beside;  // s a step; beside: part of the particles that a wall is near
  Ratio cost;
  std::optional<double> reach;  // of the cost
};
std::vector<Result> results;

template <int Dim> double part_beside_walls(const State<Dim, float>& s) {
  double beside = 0;
  for (std::size_t slot = 0; slot < s.particles.slots(); ++slot) {
    if (s.particles.is_padding(slot)) continue;
    Point<Dim> x;
    for (int d = 0; d < Dim; ++d) x[d] = s.particles[position][d][slot];
    beside += s.contact.may_touch(x, s.parameters.support_radius - s.parameters.contact_radius);
  }
  return beside / static_cast<double>(s.particles.count());
}

template <int Dim> Result compare(benchmark::State& bench, const Comparison& c, bool of_the_whole) {
  std::vector<double> seconds[2], costs;
  double beside = 0;
  for (auto _ : bench) {
    State<Dim, float> states[2] = {state_of<Dim, float>(c.without, c.moment), state_of<Dim, float>(c.with, c.moment)};
    for (int k = 0; k < warm_steps; ++k)
      for (auto& s : states) step(s);
    double sum[2] = {};
    for (int k = 0; k < steps_a_round; ++k)
      for (int n = 0; n < 2; ++n) {
        const int which = (n + k) % 2;
        const Stopwatch watch;
        step(states[which]);
        sum[which] += watch.seconds();
      }
    for (int n = 0; n < 2; ++n) seconds[n].push_back(sum[n] / steps_a_round);
    costs.push_back((sum[1] - sum[0]) / sum[of_the_whole ? 1 : 0]);
    bench.SetIterationTime(sum[1]);
    beside = part_beside_walls(states[1]);
  }
  return {"", median(seconds[0]), median(seconds[1]), beside, ratio_of(costs), {}};
}

// ---- the scenes -----------------------------------------------------------------------------------------------------

Scene without_walls(Scene scene) {
  scene.boundaries.clear();
  return scene;
}

Scene with_support(Scene scene) {
  scene.numerics.wall_support = true;
  return scene;
}

/// The tank as much larger on all sides as the column is high.
template <int Dim> Scene in_larger_tank(Scene scene) {
  const Box& column = *scene.fluid.bodies[0].shape.box;
  const double height = column.max[Dim - 1] - column.min[Dim - 1];
  for (Boundary& tank : scene.boundaries)
    for (int d = 0; d < Dim; ++d) tank.shape.box->min[d] -= height, tank.shape.box->max[d] += height;
  return scene;
}

template <int Dim> Comparison dam_break_contact(bool far) {
  const Scene scene = dam_break_scene<Dim>(100000, 1.3);
  return {without_walls(scene), far ? in_larger_tank<Dim>(scene) : scene,
          moment_of(moving_dam_break<Dim, float>(100000, 1.3))};
}

template <int Dim> Comparison dam_break_support(bool far) {
  const Scene scene = far ? in_larger_tank<Dim>(dam_break_scene<Dim>(100000, 1.3)) : dam_break_scene<Dim>(100000, 1.3);
  return {scene, with_support(scene), moment_of(moving_dam_break<Dim, float>(100000, 1.3))};
}

/// scenes/volcano.toml when its lava runs down the flank; `far`: a kilometre above it.
Comparison volcano(bool far) {
  const Scene scene = read_scene(std::filesystem::path(MOLTEN_SOURCE_DIR) / "scenes/volcano.toml");
  auto s = state_of<3, float>(scene, fill_bodies(scene, features_of(scene)));
  s.clock.stop = 10;  // s
  while (s.clock.time < s.clock.stop) step(s);
  Comparison c{without_walls(scene), scene, moment_of(s)};
  if (far)
    for (auto& x : c.moment.start.position) x[2] += 1000;
  return c;
}

template <int Dim, class Make>
void add_row(const std::string& name, std::optional<double> reach, bool of_the_whole, Make make) {
  auto kept = std::make_shared<std::optional<Comparison>>();
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& bench) {
                                 if (!*kept) *kept = make();
                                 Result r = compare<Dim>(bench, **kept, of_the_whole);
                                 r.name = name, r.reach = reach;
                                 bench.counters["without_ms"] = 1e3 * r.without;
                                 bench.counters["with_ms"] = 1e3 * r.with;
                                 bench.counters["beside_walls"] = r.beside;
                                 bench.counters["cost"] = r.cost.median;
                                 bench.counters["cost_low"] = r.cost.low;
                                 bench.counters["cost_high"] = r.cost.high;
                                 results.push_back(r);
                               })
      ->UseManualTime()
      ->Iterations(std::max(1LL, steps_to_time(400) / steps_a_round))
      ->Unit(benchmark::kMillisecond);
}

void add_all() {
  constexpr bool near = false, far = true;
  if (std::filesystem::exists(std::filesystem::path(MOLTEN_SOURCE_DIR) / "scenes/models/volcano.json")) {
    add_row<3>("walls/contact/volcano", 0.1, true, [] { return volcano(near); });
    add_row<3>("walls/contact/volcano/far", 0.02, true, [] { return volcano(far); });
  }
  add_row<3>("walls/contact/dam-break-3d", {}, true, [] { return dam_break_contact<3>(near); });
  add_row<3>("walls/contact/dam-break-3d/far", 0.02, true, [] { return dam_break_contact<3>(far); });
  add_row<2>("walls/contact/dam-break-2d", {}, true, [] { return dam_break_contact<2>(near); });
  add_row<2>("walls/contact/dam-break-2d/far", 0.02, true, [] { return dam_break_contact<2>(far); });
  add_row<3>("walls/support/dam-break-3d", 0.15, false, [] { return dam_break_support<3>(near); });
  add_row<3>("walls/support/dam-break-3d/far", 0.0, false, [] { return dam_break_support<3>(far); });
  add_row<2>("walls/support/dam-break-2d", 0.15, false, [] { return dam_break_support<2>(near); });
  add_row<2>("walls/support/dam-break-2d/far", 0.0, false, [] { return dam_break_support<2>(far); });
}

void print_table() {
  if (results.empty()) return;
  fmt::print(stderr, "\n{:32} {:>10} {:>8} {:>14} {:>24} {:>9}\n", "", "without ms", "with ms", "beside walls %",
             "cost %", "reach %");
  for (const Result& r : results)
    fmt::print(stderr, "{:32} {:10.3f} {:8.3f} {:14.1f} {:>24} {:>9}\n", r.name, 1e3 * r.without, 1e3 * r.with,
               100 * r.beside,
               fmt::format("{:.2f} [{:.2f}, {:.2f}]", 100 * r.cost.median, 100 * r.cost.low, 100 * r.cost.high),
               r.reach ? fmt::format("{:g}", 100 * *r.reach) : "–");
}

}  // namespace
}  // namespace molten::bench

int main(int argc, char** argv) {
  return molten::bench::run_program(argc, argv, molten::bench::add_all, molten::bench::print_table);
}
