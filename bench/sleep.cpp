// What sleep is worth: a settled pool of lava, long and without ends, on which a block of hot lava slumps in the
// middle.
//   build/release/bench/sleep [2|3] [LENGTH [END_TIME]]
// runs it with and without sleep, interleaved, and prints a table: time a step, share asleep, how far the slump has
// come, its heat and the momentum, and their differences. LENGTH: of the pool in spacings; END_TIME in s.
#include <fmt/format.h>
#include <omp.h>

#include <array>
#include <chrono>
#include <cmath>
#include <string>

#include "core/diagnostics.h"
#include "core/step.h"
#include "io/program/report.h"
#include "version.h"

namespace molten::bench {
namespace {

constexpr double spacing = 0.02;                // m
constexpr int depth = 16, patch = 12;           // spacings; of the pool, and of the piece that is repeated
constexpr double cold = 20, hot = 90;           // degrees
constexpr std::array<int, 2> block = {10, 10};  // spacings; length and height of what slumps

/// A pool `length` spacings long, as wide as the patch in 3-D; periodic across gravity.
Scene pool(int dim, int length) {
  Scene scene;
  scene.dimensions = dim;
  if (dim == 2) scene.gravity = {0, -9.81, 0};
  scene.fluid.rheology.viscosity = 100;
  scene.fluid.heat = Heat{1e-5, std::nullopt, cold, cold};
  scene.numerics.sound_speed = 25;  // 10 √(2 g H)
  scene.domain = Box{{0, dim == 2 ? -1.0 : 0.0, -1}, {length * spacing, dim == 2 ? 9 : patch * spacing, 9}};
  scene.periodic = {true, dim == 3, false};
  return scene;
}

template <int Dim, class Real> State<Dim, Real> state_of(const Scene& scene, const Start& start) {
  Features features = features_of(scene);
  features.contact = true;
  Wall<Dim> floor;
  floor.is_plane = true;
  floor.plane_normal[Dim - 1] = 1;
  floor.response = {0, 1};
  const Parameters<Dim> p = parameters_of<Dim>(scene, start);
  return make_state<Dim, Real>(features, p, Contact<Dim>({floor}, spacing / 2, p.support_radius), start);
}

Start lattice(int dim, int length) {
  Start start;
  start.spacing = spacing;
  for (int x = 0; x < length; ++x)
    for (int y = 0; y < (dim == 3 ? patch : 1); ++y)
      for (int up = 0; up < depth; ++up) {
        const double a = (x + 0.5) * spacing, b = (y + 0.5) * spacing, c = (up + 0.5) * spacing;
        start.position.push_back(dim == 3 ? std::array{a, b, c} : std::array{a, c, 0.0});
      }
  start.velocity.assign(start.position.size(), {0, 0, 0});
  start.temperature.assign(start.position.size(), cold);
  start.measure = static_cast<double>(start.position.size()) * std::pow(spacing, dim);
  return start;
}

template <int Dim, class Real> void set_compression(State<Dim, Real>& s, std::size_t slot, double value) {
  s.particles[compression][0][slot] = static_cast<Real>(value);
  if (s.particles.has(half_compression)) s.particles[half_compression][0][slot] = static_cast<Real>(value);
}

/// What a patch of the pool comes to rest at: position and compression by id.
template <int Dim> struct Settled {
  std::vector<std::array<double, 3>> position;  // m
  std::vector<double> compression;
};

/// Lets a patch settle: it is stopped whenever its kinetic energy falls.
template <int Dim, class Real> Settled<Dim> settle() {
  const Scene scene = pool(Dim, patch);
  const Start start = lattice(Dim, patch);
  auto s = state_of<Dim, Real>(scene, start);
  const double sound2 = 25.0 * 25.0;
  for (std::size_t slot = 0; slot < s.particles.slots(); ++slot)
    set_compression(s, slot, 9.81 * (depth * spacing - s.particles[position][Dim - 1][slot]) / sound2);
  prepare(s);
  double before = 0;
  for (int k = 0; k < 30000; ++k) {
    step(s);
    if (k % 10 > 0) continue;
    const Diagnostics now = diagnose(s);
    if (k > 2000 && now.max_speed < 1e-5) break;
    const bool slower = now.kinetic_energy < before;
    before = slower ? 0 : now.kinetic_energy;
    if (!slower) continue;
    for (auto* c : s.particles[velocity].c) std::fill_n(c, s.particles.slots(), Real(0));
    for (auto* c : s.particles[half_velocity].c) std::fill_n(c, s.particles.slots(), Real(0));
  }
  fmt::print(stderr, "settled to {:.2g} m/s after {} steps\n", diagnose(s).max_speed, s.clock.step);
  Settled<Dim> settled{start.position, std::vector<double>(start.position.size())};
  for (std::size_t slot = 0; slot < s.particles.slots(); ++slot) {
    if (s.particles.is_padding(slot)) continue;
    const auto k = static_cast<std::size_t>(s.particles[id][0][slot]);
    for (int d = 0; d < Dim; ++d) settled.position[k][d] = s.particles[position][d][slot];
    settled.compression[k] = s.particles[compression][0][slot];
  }
  return settled;
}

/// The pool of `length` spacings, and the block on its middle.
template <int Dim, class Real> State<Dim, Real> slump(const Settled<Dim>& settled, int length, bool sleeps) {
  Scene scene = pool(Dim, length);
  if (sleeps) scene.numerics.sleep.emplace();
  Start start = lattice(Dim, 0);
  std::vector<double> compressions;
  for (int k = 0; k < length / patch; ++k)
    for (std::size_t n = 0; n < settled.position.size(); ++n) {
      auto x = settled.position[n];
      x[0] += k * patch * spacing;
      start.position.push_back(x);
      compressions.push_back(settled.compression[n]);
    }
  start.temperature.assign(start.position.size(), cold);
  for (auto x : lattice(Dim, block[0]).position) {
    if (x[Dim - 1] > block[1] * spacing) continue;
    x[0] += (length - block[0]) / 2 * spacing;
    x[Dim - 1] += depth * spacing;
    start.position.push_back(x);
    compressions.push_back(9.81 * ((depth + block[1]) * spacing - x[Dim - 1]) / (25 * 25));
    start.temperature.push_back(hot);
  }
  start.velocity.assign(start.position.size(), {0, 0, 0});
  start.measure = static_cast<double>(start.position.size()) * std::pow(spacing, Dim);
  auto s = state_of<Dim, Real>(scene, start);
  for (std::size_t slot = 0; slot < s.particles.slots(); ++slot)
    if (!s.particles.is_padding(slot)) set_compression(s, slot, compressions[s.particles[id][0][slot]]);
  prepare(s);
  return s;
}

/// One of the two runs.
template <int Dim, class Real> struct Run {
  State<Dim, Real> s;
  double seconds = 0, lately = 0;  // all told, and of the last part
  std::int64_t steps = 0;          // of the last part

  void until(double time) {
    const auto start = std::chrono::steady_clock::now();
    const std::int64_t first = s.clock.step;
    while (s.clock.time < time) step(s);
    steps = s.clock.step - first;
    lately = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    seconds += lately;
  }

  /// How far the particles of the block have come from the middle (m).
  double front(double middle) const {
    double far = 0;
    for (std::size_t slot = 0; slot < s.particles.slots(); ++slot)
      if (!s.particles.is_padding(slot) && s.particles[id][0][slot] >= first_of_block)
        far = std::max(far, std::abs(s.particles[position][0][slot] - middle));
    return far;
  }
  std::int64_t first_of_block;
};

template <int Dim, class Real> void compare(int length, double end) {
  const Settled<Dim> settled = settle<Dim, Real>();
  const auto pooled = static_cast<std::int64_t>(settled.position.size()) * (length / patch);
  Run<Dim, Real> on{slump<Dim, Real>(settled, length, true), 0, 0, 0, pooled};
  Run<Dim, Real> off{slump<Dim, Real>(settled, length, false), 0, 0, 0, pooled};
  const double middle = length * spacing / 2;
  fmt::print("{}-D, {} particles, {} threads, commit {}, {}, {}\n", Dim, on.s.particles.count(), omp_get_max_threads(),
             MOLTEN_COMMIT, compiler_name(), cpu_name());
  fmt::print("{:>8} {:>8} {:>9} {:>9} {:>7} {:>9} {:>9} {:>11} {:>9} {:>10}\n", "t/s", "asleep%", "off ms", "on ms",
             "ratio", "front/m", "off by %", "heat by %", "energy", "B/particle");
  for (int part = 1; part <= 10; ++part) {
    on.until(end * part / 10);
    off.until(end * part / 10);
    const Diagnostics a = diagnose(on.s), b = diagnose(off.s);
    const double front = on.front(middle), truth = off.front(middle), n = static_cast<double>(a.particles);
    fmt::print("{:8.4f} {:8.2f} {:9.3f} {:9.3f} {:7.2f} {:9.4f} {:9.3f} {:11.2g} {:9.3g} {:4.0f} {:4.0f}\n",
               on.s.clock.time, 100 * static_cast<double>(a.asleep) / n,
               1e3 * off.lately / static_cast<double>(off.steps), 1e3 * on.lately / static_cast<double>(on.steps),
               off.lately / on.lately, front, 100 * (front / truth - 1), 100 * (a.heat / b.heat - 1),
               on.s.sleep.taken_energy, static_cast<double>(off.s.bytes()) / n, static_cast<double>(on.s.bytes()) / n);
    std::fflush(stdout);
  }
  fmt::print("all told: {:.1f} s without sleep, {:.1f} s with it: {:.2f} times faster\n", off.seconds, on.seconds,
             off.seconds / on.seconds);
  for (const auto& [name, seconds] : on.s.timer.seconds()) fmt::print("  {:<24} {:8.2f} s\n", name, seconds);
}

}  // namespace
}  // namespace molten::bench

int main(int argc, char** argv) {
  if (argc > 4 || (argc > 1 && std::string(argv[1]) != "2" && std::string(argv[1]) != "3")) {
    fmt::print(stderr, "usage: sleep [2|3 [LENGTH [END]]]: dimensions, spacings along the pool, simulated seconds\n");
    return 2;
  }
  const int dim = argc > 1 ? std::stoi(argv[1]) : 2;
  const int length = argc > 2 ? std::stoi(argv[2]) / 12 * 12 : dim == 2 ? 4800 : 2400;
  const double end = argc > 3 ? std::stod(argv[3]) : 0.2;
  if (dim == 2)
    molten::bench::compare<2, float>(length, end);
  else
    molten::bench::compare<3, float>(length, end);
  return 0;
}
