#include "bench/study/dam_break.h"

#include <algorithm>
#include <cmath>

#include "bench/study/particles.h"
#include "bench/study/scene_text.h"

namespace molten::study {

constexpr double gravity = 9.81, density = 1000;

Setup dam_break(const DamBreak& d) {
  const int up = d.dimensions - 1;
  Triple g{};
  g[up] = -gravity;
  // A column that is not a whole number of spacings gets the nearest.
  Triple size{};
  for (int k = 0; k < d.dimensions; ++k) size[k] = std::round(d.column[k] / d.spacing) * d.spacing;
  Setup s;
  s.scene = scene_head(d.dimensions, g) + fluid_text(d.dimensions, d.spacing, density) +
            fmt::format("[[boundary]]\nbox = {}\ninside = true\nslip = {:.17g}\n", box_text(d.dimensions, {}, d.tank),
                        d.slip) +
            "[numerics]\n" + std::string(impact_text) + wall_support_text(0.2);
  if (d.gate > 0) s.scene += gate_text(d.column[0], d.column[1] + 5 * d.spacing, d.spacing, d.gate);
  s.start = lattice(d.dimensions, {}, size, d.spacing);
  stagger(s.start, d.stagger);
  perturb(s.start, d.dimensions, d.perturbation);
  for (const Triple& x : s.start.position) s.pressure.push_back(density * gravity * (size[up] - x[up]));
  return s;
}

Parameter gate_parameter(double speed) {
  return {"gate", speed, "speed at which a gate before the column rises, m/s; 0: none; none with dias and queiroz"};
}

Parameter perturbation_parameter() {
  return {"perturbation", 0.2, "width of the random displacements at the start, spacings"};
}

double gate_of(const Request& request) {
  return request.numerics == "dias" || request.numerics == "queiroz" ? 0 : request["gate"];
}

std::string gate_text(double left, double top, double spacing, double speed) {
  return fmt::format(
      "[[boundary]]\nbox = {{ min = [{}, {}], max = [{}, {}] }}\nmotion = {{ velocity = [0, {}] }}\nslip = 1\n", left,
      spacing / 10, left + 2 * spacing, top, speed);
}

double front_of(const Cloud& cloud, std::ptrdiff_t farthest) {
  std::vector<double> x;
  for (const Triple& place : cloud.position) x.push_back(place[0]);
  const auto front = x.begin() + std::min(farthest, std::ssize(x)) - 1;
  std::nth_element(x.begin(), front, x.end(), std::greater<>());
  return *front + cloud.spacing / 2;
}

void expect_series(Report& report, const std::string& name, double raw_reach, double shifted_reach) {
  report.expect(name + "_raw", raw_reach);
  report.expect(name + "_shifted", shifted_reach);
  report.expect(name + "_time_shift", no_reach);
}

void judge_series(Report& report, const std::string& name, const Series& run, const Series& experiment) {
  if (run.at.empty() || experiment.at.empty()) {  // the run ends before the experiment's time begins
    for (const char* what : {"_raw", "_shifted", "_time_shift"}) report.judge(name + what, no_reach);
    return;
  }
  const double duration = experiment.at.back();
  const double shift = best_shift(0.3 * duration, [&](double s) { return relative_rms(run, experiment, s); });
  report.judge(name + "_raw", relative_rms(run, experiment));
  report.judge(name + "_shifted", relative_rms(run, experiment, shift));
  report.judge(name + "_time_shift", shift / duration);
}

}  // namespace molten::study
