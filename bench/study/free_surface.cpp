// Inviscid bodies of fluid without walls: an elliptic drop (Monaghan 1994) and a rotating square patch.
#include <cmath>

#include "bench/study/ellipse.h"
#include "bench/study/list.h"
#include "bench/study/metrics.h"
#include "bench/study/particles.h"
#include "bench/study/scene_text.h"

namespace molten::study {

Ellipse ellipse_at(double time, double stretch) {
  // A' = A² (b² − a²)/(a² + b²), a' = A a, b = 1/a; fourth-order Runge–Kutta
  const int steps = 1000;
  const double dt = time / steps;
  std::array<double, 2> y{stretch, 1};  // A, a
  const auto rate = [](const std::array<double, 2>& y) {
    const double a2 = y[1] * y[1], b2 = 1 / a2;
    return std::array<double, 2>{y[0] * y[0] * (b2 - a2) / (a2 + b2), y[0] * y[1]};
  };
  const auto moved = [](std::array<double, 2> y, const std::array<double, 2>& f, double by) {
    for (int k = 0; k < 2; ++k) y[k] += by * f[k];
    return y;
  };
  for (int k = 0; k < steps; ++k) {
    const auto k1 = rate(y), k2 = rate(moved(y, k1, dt / 2)), k3 = rate(moved(y, k2, dt / 2)),
               k4 = rate(moved(y, k3, dt));
    for (int i = 0; i < 2; ++i) y[i] += dt / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  return {y[1], 1 / y[1], y[0]};
}

namespace {

/// Semi-axis along d of an ellipse that is evenly filled: ⟨x²⟩ = a²/4.
double semi_axis(const Cloud& c, int d) {
  double mean = 0, square = 0;
  for (const Triple& x : c.position) mean += x[d], square += x[d] * x[d];
  const auto n = static_cast<double>(c.count());
  return 2 * std::sqrt(square / n - mean * mean / n / n);
}

void judge_energy_and_order(const Cloud& c, double energy_at_start, Report& report) {
  report.judge("kinetic_energy", std::abs(kinetic_energy(c) / energy_at_start - 1));
  report.judge("clumped_part", clumped_part(c, 2));
}

Setup drop(const Request& r) {
  const double spacing = 1.0 / static_cast<double>(r.size);
  Setup s;
  s.scene = scene_head(2, {}) + fluid_text(2, spacing, 1);
  const Start square = lattice(2, {-1, -1, 0}, {1, 1, 0}, spacing);
  s.start.spacing = spacing;
  for (const Triple& x : square.position) {
    const double r2 = x[0] * x[0] + x[1] * x[1];
    if (r2 > 1) continue;
    s.start.position.push_back(x);
    s.start.velocity.push_back({-x[0], x[1], 0});
    s.pressure.push_back((1 - r2) / 2);
  }
  s.start.measure = static_cast<double>(s.start.position.size()) * spacing * spacing;
  return s;
}

void run_drop(const Request& r, Report& report) {
  report.expect("short_axis", 0.01);
  report.expect("long_axis", 0.01);
  report.expect("kinetic_energy", 0.01);
  report.expect("clumped_part", 0.001);
  const auto simulation = Simulation::make(r, drop(r), report);
  const Cloud first = simulation->cloud();
  simulation->run_until(r["end_time"]);

  const Cloud c = simulation->cloud();
  const Ellipse exact = ellipse_at(c.time, -1);
  // Relative to what the lattice in a disc has at the start.
  report.judge("short_axis", std::abs(semi_axis(c, 0) / semi_axis(first, 0) / exact.a - 1));
  report.judge("long_axis", std::abs(semi_axis(c, 1) / semi_axis(first, 1) / exact.b - 1));
  judge_energy_and_order(c, kinetic_energy(first), report);
}

/// Pressure of the square [0, 1]² that rotates with the angular velocity 1 and has none on its rim: Poisson's series.
double patch_pressure(double x, double y) {
  double sum = 0;
  for (int m = 1; m < 60; m += 2)
    for (int n = 1; n < 60; n += 2)
      sum -= 32 / (m * n * M_PI * M_PI) / (M_PI * M_PI * (n * n + m * m)) * std::sin(m * M_PI * x) *
             std::sin(n * M_PI * y);
  return sum;
}

double angular_momentum(const Cloud& c) {
  double sum = 0;
  for (std::size_t k = 0; k < c.count(); ++k)
    sum += c.position[k][0] * c.velocity[k][1] - c.position[k][1] * c.velocity[k][0];
  return c.mass * sum;
}

void run_patch(const Request& r, Report& report) {
  report.expect("kinetic_energy", 0.01);
  report.expect("angular_momentum", 0.01);
  report.expect("clumped_part", 0.001);
  const double spacing = 1.0 / static_cast<double>(r.size);
  Setup s;
  s.scene = scene_head(2, {}) + fluid_text(2, spacing, 1);
  s.start = lattice(2, {-0.5, -0.5, 0}, {0.5, 0.5, 0}, spacing);
  set_velocity(s.start, [](const Triple& x) { return Triple{x[1], -x[0], 0}; });
  for (const Triple& x : s.start.position) s.pressure.push_back(patch_pressure(x[0] + 0.5, x[1] + 0.5));
  const auto simulation = Simulation::make(r, s, report);
  const Cloud first = simulation->cloud();
  simulation->run_until(r["end_time"]);

  const Cloud c = simulation->cloud();
  report.judge("angular_momentum", std::abs(angular_momentum(c) / angular_momentum(first) - 1));
  judge_energy_and_order(c, kinetic_energy(first), report);
}

}  // namespace

Case elliptic_drop() {
  return {"elliptic-drop",
          "a disc of radius 1 stretched by v = (−x, y); semi-axes by second moments, kinetic energy, part of the "
          "particles nearer than half a spacing to another",
          "particles a radius",
          40,
          5,
          {{"end_time", 0.76, "radii over the rim's speed at the start"}},
          run_drop};
}

Case rotating_patch() {
  return {"rotating-patch",
          "a square of side 1 that rotates with angular velocity 1; kinetic energy, angular momentum, part of the "
          "particles nearer than half a spacing to another",
          "particles a side",
          50,
          8,
          {{"end_time", 2, "over the angular velocity"}},
          run_patch};
}

}  // namespace molten::study
