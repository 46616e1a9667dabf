// What a feature costs a scene that does not ask for it, and one that does:
//   build/release/bench/skip [skip/FEATURE ...] [--steps=N]
// For every optional feature three runs of one block of water take steps in turn: `minimal`, without the feature
// compiled in (minimal.h: exactly the terms that the scene needs), `off`, the solver's own step for the same scene, and
// `on`, for the scene with the feature. Where the solver has instantiations without the feature, the scene asks for
// another optional feature that brings it in. The ratios are medians over batches of steps, with the interval that
// holds the median with 95 % confidence; at the end they are printed as a table. Before they are timed, minimal and off
// must have got to the same places.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/cases.h"
#include "bench/minimal.h"
#include "bench/program.h"
#include "bench/ratio.h"

namespace molten::bench {
namespace {

using S = State<3, float>;
using Step = std::function<void(S&)>;
constexpr int batch = 8;  // steps

struct Result {
  std::string feature;
  double minimal, off, on;  // s a step, medians
  Ratio off_ratio, on_ratio;
};
std::vector<Result> results;

/// The largest difference of any particle's position after the same steps, in spacings.
double apart(const S& a, const S& b) {
  std::vector<std::array<double, 3>> place(a.particles.count());
  const auto for_each = [](const S& s, auto&& f) {
    for (std::size_t slot = 0; slot < s.particles.slots(); ++slot)
      if (!s.particles.is_padding(slot)) f(slot, static_cast<std::size_t>(s.particles[id][0][slot]));
  };
  for_each(a, [&](std::size_t slot, std::size_t k) {
    for (int d = 0; d < 3; ++d) place[k][d] = a.particles[position][d][slot];
  });
  double most = 0;
  for_each(b, [&](std::size_t slot, std::size_t k) {
    for (int d = 0; d < 3; ++d) most = std::max(most, std::abs(b.particles[position][d][slot] - place[k][d]));
  });
  return most / a.parameters.spacing;
}

struct Comparison {
  std::string feature;
  Scene without, with;
  Step minimal;
};

/// The three states' turns, twice each. None follows itself, for it would find its columns in the cache, and each
/// follows each of the others once.
constexpr std::array<int, 6> turns = {0, 2, 1, 0, 1, 2};

void compare(benchmark::State& bench, const Comparison& c) {
  S states[3] = {block_in<3, float>(c.without, 100000), block_in<3, float>(c.without, 100000),
                 block_in<3, float>(c.with, 100000)};
  const Step steps[3] = {c.minimal, step<3, float>, step<3, float>};
  for (int k = 0; k < 20; ++k)
    for (int which = 0; which < 3; ++which) steps[which](states[which]);
  if (const double way = apart(states[0], states[1]); !(way < 2e-5))
    return bench.SkipWithError(fmt::format("the minimal step is off by {} spacings", way).c_str());
  std::vector<double> seconds[3];
  for (auto _ : bench) {
    double sum[3] = {};
    // The first two states are the same, and take minimal and off steps by turns: where a state's columns lie is worth
    // up to a hundredth.
    for (int k = 0; k < batch / 2; ++k)
      for (const int turn : turns) {
        const int which = turn < 2 ? (turn + k) % 2 : turn;
        const Stopwatch watch;
        steps[which](states[turn]);
        sum[which] += watch.seconds();
      }
    for (int which = 0; which < 3; ++which) seconds[which].push_back(sum[which] / batch);
    bench.SetIterationTime(sum[1]);
  }
  std::vector<double> off, on;
  for (std::size_t k = 0; k < seconds[0].size(); ++k) {
    off.push_back(seconds[1][k] / seconds[0][k]);
    on.push_back(seconds[2][k] / seconds[0][k]);
  }
  const Result r{c.feature, median(seconds[0]), median(seconds[1]), median(seconds[2]), ratio_of(off), ratio_of(on)};
  results.push_back(r);
  bench.counters["minimal_ms"] = 1e3 * r.minimal;
  bench.counters["off_ms"] = 1e3 * r.off;
  bench.counters["on_ms"] = 1e3 * r.on;
  bench.counters["off_ratio"] = r.off_ratio.median;
  bench.counters["off_ratio_low"] = r.off_ratio.low;
  bench.counters["off_ratio_high"] = r.off_ratio.high;
  bench.counters["on_ratio"] = r.on_ratio.median;
}

// ---- the scenes, and what each needs --------------------------------------------------------------------------------

Scene plain() {
  Scene scene = tank(3, 1.3);
  scene.boundaries.clear();
  return scene;
}
Scene with_heat(Scene scene) {
  scene.fluid.heat = Heat{1e-5, std::nullopt, 20, 20};
  return scene;
}
Scene with_smd(Scene scene) {
  Rheology& r = scene.fluid.rheology;
  r.model = Rheology::Model::smd;
  r.jump_number = {15, 15};
  return scene;
}
Scene with_laminar(Scene scene) {
  scene.fluid.rheology.viscosity = 1;
  return scene;
}
Scene with_xsph(Scene scene) {
  scene.numerics.xsph = Xsph{};
  return scene;
}
Scene with_outflow(Scene scene) {
  scene.outflows = {Plane{{0, 0, -100}, {0, 0, -1}}};
  return scene;
}
Scene with_moving_wall(Scene scene) {
  Boundary ball;
  ball.shape.sphere = Sphere{{0.5, 0.5, 1.5}, 0.2};
  ball.motion.emplace().velocity = {0, 0, 0.1};
  scene.boundaries.push_back(ball);
  return scene;
}
/// The scene with numerics as f(numerics) makes them.
template <class F> Scene also(Scene scene, F f) {
  f(scene.numerics);
  return scene;
}
Scene without_artificial(Scene scene) {
  scene.numerics.artificial_viscosity = 0;
  return scene;
}

ArtificialViscosity<float> artificial(const S& s) {
  const Parameters<3>& p = s.parameters;
  return {p.artificial_viscosity, p.eos.sound_speed, p.smoothing_length, p.eos.rest_density};
}

/// The steps of a block of 100 000 particles; `extra(s)` makes the one optional term that its scene has, which is
/// always on in it. (That artificial viscosity is on is tested, as in the solver: without the test laminar viscosity is
/// slower by 1.3 %, by the compiler's luck.)
template <class Extra> Step forces_and(Extra extra) {
  return [=](S& s) { minimal_step(s, false, Continuity{}, PressureForce{}, artificial(s), Always(extra(s))); };
}

std::vector<Comparison> comparisons() {
  const Step heat = forces_and(
      [](const S& s) { return HeatConduction<float>(s.parameters.diffusivity, s.parameters.eos.rest_density); });
  const Step stress = forces_and([](const S& s) {
    return StressForce<3, float>(true, s.parameters.eos.rest_density, s.parameters.kernel_second_moment);
  });
  const Step laminar = forces_and(
      [](const S& s) { return LaminarViscosity<float>(s.parameters.viscosity, s.parameters.eos.rest_density); });
  const Step xsph = forces_and([](const S& s) { return XsphTerm<float>(true, s.parameters.eos.rest_density); });
  const Step basic = [](S& s) { minimal_step(s, false, Continuity{}, PressureForce{}, Always(artificial(s))); };
  return {
      {"heat", with_smd(plain()), with_heat(with_smd(plain())), stress},
      {"smd_stress", with_heat(plain()), with_smd(with_heat(plain())), heat},
      {"laminar_viscosity", with_xsph(plain()), with_laminar(with_xsph(plain())), xsph},
      {"xsph", with_laminar(plain()), with_xsph(with_laminar(plain())), laminar},
      {"artificial_viscosity", without_artificial(plain()), plain(),
       [](S& s) { minimal_step(s, false, Continuity{}, PressureForce{}); }},
      {"contact", plain(), tank(3, 1.3),
       [](S& s) { minimal_step(s, true, Continuity{}, PressureForce{}, Always(artificial(s))); }},
      {"density_diffusion", plain(), also(plain(), [](Numerics& n) { n.density_diffusion = 0.2; }), basic},
      {"density_filter", plain(), also(plain(), [](Numerics& n) { n.density_filter.emplace(); }), basic},
      {"gradient_correction", plain(), also(plain(), [](Numerics& n) { n.gradient_correction = true; }), basic},
      {"tensile_correction", plain(), also(plain(), [](Numerics& n) { n.tensile_correction = true; }), basic},
      {"sleep", plain(), also(plain(), [](Numerics& n) { n.sleep.emplace(); }), basic},
      {"outflow", plain(), with_outflow(plain()), basic},
      {"wall_support", tank(3, 1.3), also(tank(3, 1.3), [](Numerics& n) { n.wall_support = true; }), basic},
      {"moving_wall", tank(3, 1.3), with_moving_wall(tank(3, 1.3)), basic},
      {"time_step_levels", with_smd(plain()), also(with_smd(plain()), [](Numerics& n) { n.time_step_levels = 2; }),
       stress},
  };
}

void add_all() {
  for (const Comparison& c : comparisons())
    benchmark::RegisterBenchmark(("skip/" + c.feature).c_str(), [c](benchmark::State& bench) { compare(bench, c); })
        ->UseManualTime()
        ->Iterations(std::max(1LL, steps_to_time(300) / batch))
        ->Unit(benchmark::kMillisecond);
}

void print_table() {
  if (results.empty()) return;
  fmt::print(stderr, "\n{:22} {:>10} {:>8} {:>8}   {:>26}   {:>26}\n", "feature", "minimal ms", "off ms", "on ms",
             "off / minimal", "on / minimal");
  const auto text = [](const Ratio& r) { return fmt::format("{:.4f} [{:.4f}, {:.4f}]", r.median, r.low, r.high); };
  for (const Result& r : results)
    fmt::print(stderr, "{:22} {:10.3f} {:8.3f} {:8.3f}   {:>26}   {:>26}\n", r.feature, 1e3 * r.minimal, 1e3 * r.off,
               1e3 * r.on, text(r.off_ratio), text(r.on_ratio));
}

}  // namespace
}  // namespace molten::bench

int main(int argc, char** argv) {
  return molten::bench::run_program(argc, argv, molten::bench::add_all, molten::bench::print_table);
}
