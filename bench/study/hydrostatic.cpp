// Fluids at rest between walls: water in a tank and in a bowl, and a layer on a slope below its yield stress.
#include <algorithm>
#include <cmath>
#include <functional>

#include "bench/study/channel_profile.h"
#include "bench/study/list.h"
#include "bench/study/metrics.h"
#include "bench/study/particles.h"
#include "bench/study/scene_text.h"

namespace molten::study {

namespace {

constexpr double gravity = 9.81, density = 1000, depth = 1;      // m/s², kg/m³, m
const double sound_speed = 10 * std::sqrt(2 * gravity * depth);  // m/s

/// Water; the numerics may replace the equation of state, but not its sound speed.
const EquationOfState water{StateEquation::tait, density, sound_speed, 7};

/// Pressure (Pa) of a fluid at rest, `below` (m) its surface.
double pressure_at_rest(const EquationOfState& eos, double below) {
  return eos.pressure(eos.compression_at_rest(gravity * below));
}

/// The level (m) of a column that is `depth` high uncompressed.
double level_of_column(const EquationOfState& eos) {
  return eos.potential_at_rest(eos.compression(density * gravity * depth)) / gravity;
}

/// Pressure at height 0 of the line that fits the particles below `top` best.
double pressure_at_floor(const Cloud& c, int up, double top) {
  double n = 0, y1 = 0, y2 = 0, p1 = 0, py = 0;
  for (std::size_t k = 0; k < c.count(); ++k) {
    const double y = c.position[k][up], p = c.pressure[k];
    if (y > top) continue;
    ++n, y1 += y, y2 += y * y, p1 += p, py += p * y;
  }
  return (p1 * y2 - py * y1) / (n * y2 - y1 * y1);
}

/// Runs for 30 √(H/g) and judges pressure, floor pressure and the kinetic energy of the last second.
void judge_rest(const Request& r, Report& report, const Setup& s, int up,
                const std::function<double(const EquationOfState&)>& level_of, double energy_reach) {
  report.expect("pressure_l2", 0.01);
  report.expect("floor_pressure", 0.01);
  report.expect("kinetic_energy", energy_reach);
  const auto simulation = Simulation::make(r, s, report);
  const double end = r["end_time"] * std::sqrt(depth / gravity);
  double energy = 0, samples = 0;
  simulation->run_until(end, 0.02, [&](const Cloud& c) {
    if (c.time >= end - 1) energy += kinetic_energy(c), ++samples;
  });
  const Cloud c = simulation->cloud();
  const double level = level_of(c.eos);
  FieldError pressure;
  double potential = 0;
  for (std::size_t k = 0; k < c.count(); ++k) {
    pressure.add(c.pressure[k], pressure_at_rest(c.eos, level - c.position[k][up]));
    potential += c.mass * gravity * c.position[k][up];
  }
  report.judge("pressure_l2", pressure.l2());
  report.judge("floor_pressure", std::abs(pressure_at_floor(c, up, depth / 4) / pressure_at_rest(c.eos, level) - 1));
  report.judge("kinetic_energy", energy / samples / potential);
}

/// Walls that the fluid rests on. At 1.3 spacings, the default, a square lattice buckles under its own weight, and the
/// pressure's gradient on it is 2.6 % short; at 1.5 it stays, and the gradient is within 0.3 %.
std::string numerics_text() {
  return fmt::format("{}{}smoothing_ratio = 1.5\n", sound_speed_text(sound_speed), wall_support_text());
}

void run_box(const Request& r, Report& report) {
  const int dimensions = r["dimensions"] == 3 ? 3 : 2, up = dimensions - 1;
  const double spacing = depth / static_cast<double>(r.size);
  const double width = std::round(r["aspect_ratio"] * static_cast<double>(r.size)) * spacing;
  Triple fluid{width, width, width}, tank = fluid, g{};
  fluid[up] = depth, tank[up] = 2 * depth, g[up] = -gravity;
  Setup s;
  s.scene = scene_head(dimensions, g) + fluid_text(dimensions, spacing, density, "hydrostatic = true") +
            numerics_text() +
            fmt::format("[[boundary]]\nbox = {}\ninside = true\nslip = 1\n", box_text(dimensions, {}, tank));
  s.start = lattice(dimensions, {}, fluid, spacing);
  judge_rest(r, report, s, up, level_of_column, 1e-6);
}

/// The lower half of a ball of radius `depth` on z = 0, in shells a spacing apart from half a spacing before the wall
/// on; on each, particles wind up along a spiral, as far from each other. The mass is that of the bowl full of water at
/// rest.
Start half_ball(double spacing) {
  const double golden = M_PI * (3 - std::sqrt(5.0));
  Start start;
  start.spacing = spacing;
  for (double r = depth - spacing / 2; r > 0; r -= spacing) {
    const double count = std::round(2 * M_PI * (r * r + spacing * spacing / 12) / (spacing * spacing));
    for (double k = 0; k < count; ++k) {
      const double z = -r * (k + 0.5) / count, around = golden * k, across = std::sqrt(r * r - z * z);
      start.position.push_back({across * std::cos(around), across * std::sin(around), depth + z});
    }
  }
  constexpr int layers = 1000;
  for (int k = 0; k < layers; ++k) {
    const double z = (k + 0.5) * depth / layers;
    start.measure +=
        (1 + water.compression_at_rest(gravity * (depth - z))) * M_PI * z * (2 * depth - z) * depth / layers;
  }
  return start;
}

void run_bowl(const Request& r, Report& report) {
  const double spacing = depth / static_cast<double>(r.size);
  Setup s;
  s.scene = scene_head(3, {0, 0, -gravity}) + fluid_text(3, spacing, density) + numerics_text() +
            fmt::format("[[boundary]]\nsphere = {{ center = [0, 0, {}], radius = {} }}\ninside = true\nslip = 1\n",
                        depth, depth);
  s.start = half_ball(spacing);
  s.start.velocity.assign(s.start.position.size(), Triple{});
  for (const Triple& x : s.start.position) s.pressure.push_back(pressure_at_rest(water, depth - x[2]));
  judge_rest(
      r, report, s, 2, [](const EquationOfState&) { return depth; }, 1e-5);
}

// ---- a slope --------------------------------------------------------------------------------------------------------

/// A layer of SMD fluid (units of its depth, density and ρg) on a slope, periodic along it. Its largest stress is below
/// the yield stress, so it only creeps, and hardly faster than a fluid of the viscosity η0 would: ρ g sinθ H²/(2η0) at
/// its surface. How much faster the SMD curve itself says: 1.07 times at 0.3 of the yield stress, 1.15 times at half.
void run_slope(const Request& r, Report& report) {
  report.expect("creep", 1.1);
  report.expect("surface_speed", 0.02);
  const double angle = r["slope"] * M_PI / 180, spacing = 1 / static_cast<double>(r.size), length = 8 * spacing;
  const double stress = std::sin(angle), yield_stress = stress / r["part_of_yield"];
  const double viscosity = (r["jump_number"] + 1) * yield_stress;  // γ̇1 = 1
  Setup s;
  s.scene = scene_head(2, {stress, -std::cos(angle), 0}, periodic_text(2, {0, -1, 0}, {length, 3, 0}, "x")) +
            fluid_text(2, spacing, 1,
                       fmt::format("[fluid.rheology]\nmodel = \"smd\"\nn = 0.5\njump_number = {:.17g}\n"
                                   "yield_stress = {:.17g}\nconsistency = {:.17g}\n",
                                   r["jump_number"], yield_stress, yield_stress)) +
            "[numerics]\n" + wall_support_text() + "[[boundary]]\nplane = { point = [0, 0], normal = [0, 1] }\n";
  s.start = lattice(2, {}, {length, 1, 0}, spacing);
  for (const Triple& x : s.start.position) s.pressure.push_back(std::cos(angle) * (1 - x[1]));
  const auto simulation = Simulation::make(r, s, report);
  simulation->run_until(r["end_time"]);

  const Cloud c = simulation->cloud();
  double speed = 0, count = 0;
  for (std::size_t k = 0; k < c.count(); ++k)
    if (c.position[k][1] > 1 - 1.5 * spacing) speed += c.velocity[k][0], ++count;
  const auto stress_of = [&](double strain) { return yield_stress * smd_stress(strain, r["jump_number"], 0.5); };
  // Half a channel's stress falls as a layer's; its middle is the surface.
  const double exact = ChannelProfile(stress_of, stress).at(0);
  report.judge("creep", count > 0 ? speed / count / (stress / (2 * viscosity)) : no_reach);
  report.judge("surface_speed", count > 0 ? std::abs(speed / count / exact - 1) : no_reach);
}

}  // namespace

Case hydrostatic_box() {
  return {
      "hydrostatic-box",
      "water 1 m deep at rest in a tank; relative L2 of the pressure, pressure at the floor, mean kinetic energy of "
      "the last second over the potential energy",
      "particles a depth",
      40,
      8,
      {{"end_time", 30, "√(depth/g)"}, {"aspect_ratio", 1, "width over depth"}, {"dimensions", 2, "2 or 3"}},
      run_box};
}

Case hydrostatic_bowl() {
  return {"hydrostatic-bowl",
          "water 1 m deep at rest in a round bowl, in 3-D; as hydrostatic-box",
          "particles a depth",
          20,
          6,
          {{"end_time", 30, "√(depth/g)"}},
          run_bowl};
}

Case slope_yield() {
  return {"slope-yield",
          "a layer of SMD fluid on a slope below its yield stress; its surface's speed over that of a fluid of the "
          "viscosity at rest, and against that of the SMD fluid",
          "particles a depth",
          16,
          4,
          {{"slope", 20, "degrees"},
           {"part_of_yield", 0.5, "stress at the slope over the yield stress"},
           {"jump_number", 150, "J"},
           {"end_time", 0.2, "√(depth/g)"}},
          run_slope};
}

}  // namespace molten::study
