// A box that floats and a vent that fills a shaft.
#include <algorithm>
#include <cmath>

#include "bench/study/list.h"
#include "bench/study/particles.h"
#include "bench/study/scene_text.h"

namespace molten::study {

namespace {

constexpr double gravity = 9.81, density = 1000;  // m/s², kg/m³

// ---- a floating box -------------------------------------------------------------------------------------------------

constexpr double depth = 1, tank_width = 2, box_width = 0.6, box_height = 0.3;  // m

/// Released above the depth at which it displaces its weight (Archimedes) in a tank whose level that raises: with the
/// water's area A, level tank_width = A + (level − bottom) box_width.
void run_floating_box(const Request& r, Report& report) {
  report.expect("draught", 0.02);
  report.expect("tilt", no_reach);
  const double spacing = depth / static_cast<double>(r.size), draught = r["density"] * box_height;
  const double bottom = depth - std::round((1 - r["lift"]) * draught / spacing) * spacing;
  const double left = std::round((tank_width - box_width) / 2 / spacing) * spacing;
  const Triple lower{left, bottom, 0}, upper{left + box_width, bottom + box_height, 0};
  Setup s;
  s.scene =
      scene_head(2, {0, -gravity, 0}) + fluid_text(2, spacing, density) +
      fmt::format("[[boundary]]\nbox = {}\ninside = true\nslip = 1\n", box_text(2, {}, {tank_width, 3 * depth, 0})) +
      fmt::format("[[boundary]]\nbox = {}\nslip = 1\nbody = {{ density = {:.17g} }}\n", box_text(2, lower, upper),
                  r["density"] * density) +
      sound_speed_text(10 * std::sqrt(2 * gravity * depth)) + wall_support_text();
  s.start = lattice(2, {}, {tank_width, depth, 0}, spacing);
  std::erase_if(s.start.position, [&](const Triple& x) {
    return x[0] > lower[0] - spacing / 4 && x[0] < upper[0] + spacing / 4 && x[1] > bottom;
  });
  s.start.velocity.resize(s.start.position.size());
  s.start.measure = static_cast<double>(s.start.position.size()) * spacing * spacing;
  for (const Triple& x : s.start.position) s.pressure.push_back(density * gravity * (depth - x[1]));
  const auto simulation = Simulation::make(r, s, report);
  const double end = r["end_time"] * std::sqrt(depth / gravity);
  double sum = 0, samples = 0;
  simulation->run_until(end, 0.01, [&](const Cloud& c) {
    if (c.time < 0.75 * end) return;
    const double base = c.bodies.at(0).centre[1] - box_height / 2;
    double water = 0;  // m², squeezed by its weight
    for (const double rho : c.density) water += c.mass / rho;
    sum += (water - base * tank_width) / (tank_width - box_width), ++samples;
  });
  const std::array<double, 9> turn = simulation->cloud().bodies.at(0).turn;
  report.judge("draught", std::abs(sum / samples / draught - 1));
  report.judge("tilt", std::abs(std::atan2(turn[3], turn[0])));
}

// ---- a vent ---------------------------------------------------------------------------------------------------------

/// Slope of the line that fits best.
double slope_of(const std::vector<std::pair<double, double>>& points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [a, b] : points) n += 1, x += a, y += b, xx += a * a, xy += a * b;
  return (n * xy - x * y) / (n * xx - x * x);
}

/// A vent is the floor of a shaft without walls, periodic across, which it fills at the speed v. A flow that stopped
/// dead would be denser by v/c.
void run_vent(const Request& r, Report& report) {
  report.expect("flux", 0.005);
  report.expect("density_burst", 0.1);
  const double speed = r["speed"], width = 1, spacing = width / static_cast<double>(r.size);
  const double sound_speed = 10 * std::sqrt(speed * speed + 2 * gravity * r["height"]);
  Setup s;
  s.scene =
      scene_head(2, {0, -gravity, 0}, periodic_text(2, {-width / 2, -1, 0}, {width / 2, r["height"] + 1, 0}, "x")) +
      fluid_text(2, spacing, density) +
      fmt::format("[[vent]]\ndisc = {{ centre = [0, 0], normal = [0, 1], radius = {} }}\nrate = {:.17g}\n", width / 2,
                  speed * width) +
      sound_speed_text(sound_speed);
  s.start.spacing = spacing;
  const auto simulation = Simulation::make(r, s, report);
  const double end = r["height"] / speed;
  std::vector<std::pair<double, double>> out;  // s, m²
  double burst = 0;
  simulation->run_until(end, end / 1000, [&](const Cloud& c) {
    double left = 0;
    for (std::size_t k = 0; k < c.count(); ++k) {
      const double y = c.position[k][1];
      if (y < 0) continue;
      ++left;
      const double at_rest = gravity * std::max(speed * c.time - y, 0.0) / (sound_speed * sound_speed);
      burst = std::max(burst, std::abs(c.density[k] / density - 1 - at_rest));
    }
    out.emplace_back(c.time, left * spacing * spacing);
  });
  report.judge("flux", std::abs(slope_of(out) / (speed * width) - 1));
  report.judge("density_burst", burst / (speed / sound_speed));
}

}  // namespace

Case floating_box() {
  return {"floating-box",
          "a free box 0.6 m wide and 0.3 m high in water 1 m deep, released above the depth at which it floats; its "
          "draught against Archimedes', mean of the last quarter, and how far it tilts (rad)",
          "particles a depth",
          40,
          10,
          {{"density", 0.5, "of the box over that of water"},
           {"lift", 0.25, "part of the draught by which it starts too high"},
           {"end_time", 30, "√(depth/g)"}},
          run_floating_box};
}

Case vent_flux() {
  return {"vent-flux",
          "a vent is the floor of a shaft 1 m wide, periodic across, which it fills; volume a second that comes out "
          "against what was "
          "asked, largest deviation of the density from that at rest over v/c",
          "particles across the shaft",
          20,
          4,
          {{"speed", 1, "m/s"}, {"height", 2, "filled, m"}},
          run_vent};
}

}  // namespace molten::study
