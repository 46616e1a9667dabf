// Fronts of dam breaks against experiments: Cruchaga et al. 2007 and Lobovský et al. 2014 as Dias 2017 tables them,
// Lobovský's own record, Martin & Moyce 1952, Koshizuka & Oka 1996. Experiments have a gate and walls with friction, so
// each series is judged raw and after one shift in time.
#include <algorithm>
#include <cmath>

#include "bench/study/dam_break.h"
#include "bench/study/list.h"
#include "bench/study/reference.h"
#include "bench/study/scene_text.h"

namespace molten::study {

namespace {

const Parameter slip{"slip", 1, "of the walls: 1 free slip, 0 no-slip"};

struct Record {
  Series front, height;  // m over s
};

/// Runs until `end` (s) and records the front and the depth beside the closed wall, over a tenth of the column.
Record record(const Request& r, Report& report, const DamBreak& d, double end) {
  const auto simulation = Simulation::make(r, dam_break(d), report);
  Record series;
  simulation->run_until(end, end / 300, [&](const Cloud& c) {
    series.front.add(c.time, front_of(c));
    const double half = std::max(0.05 * d.column[0], d.spacing);
    series.height.add(c.time, depth_at(c, 2, {half, 0, 0}, {half, 0, 0}));
  });
  return series;
}

// ---- Cruchaga et al. 2007 -------------------------------------------------------------------------------------------

/// `reach` is the mean deviation of [D]'s own better run.
void run_cruchaga(const Request& r, Report& report, const Series& experiment, double reach) {
  report.expect("front_mean", reach);
  for (const double t : experiment.at) report.expect(fmt::format("front_{}s", t), no_reach);
  const double width = r["width"];
  const DamBreak d{2,          {width, r["height"], 0}, {0.42, 0.44, 0}, width / static_cast<double>(r.size), r["slip"],
                   gate_of(r), r["perturbation"]};
  const Series front = record(r, report, d, experiment.at.back()).front;
  report.judge("front_mean", mean_deviation(front, experiment));
  for (std::size_t k = 0; k < experiment.at.size(); ++k)
    report.judge(fmt::format("front_{}s", experiment.at[k]),
                 std::abs(front(experiment.at[k]) / experiment.value[k] - 1));
}

void run_cruchaga_a(const Request& r, Report& report) {
  run_cruchaga(r, report, {{0.1, 0.2}, {0.190, 0.290}}, (0.015 + 0.001) / (0.190 + 0.290));
}
void run_cruchaga_b(const Request& r, Report& report) {
  run_cruchaga(r, report, {{0.1, 0.2}, {0.220, 0.360}}, (0.029 + 0.002) / (0.220 + 0.360));
}

Case cruchaga(const std::string& name, double height, void (*run)(const Request&, Report&)) {
  return {name,
          "column of Cruchaga et al. (2007) in a tank of 0.42 m; mean deviation of the front at 0.1 and 0.2 s over the "
          "mean front (reach: Dias 2017)",
          "particles across the column",
          36,
          6,
          {{"width", 0.114, "of the column, m"},
           {"height", height, "of the column, m"},
           slip,
           gate_parameter(),
           perturbation_parameter()},
          run};
}

// ---- Lobovský et al. 2014 -------------------------------------------------------------------------------------------

void run_lobovsky_front(const Request& r, Report& report) {
  const double height = r["height"], unit = std::sqrt(height / 9.81), wall = 1.61;
  const auto experiment = reference("dambreak/lobovsky2014_fig12_front_H600mm.csv", "T", "Z");
  if (experiment) {
    expect_series(report, "front", 0.06, no_reach);
    report.expect("wall_arrival", 0.05);
  }
  const DamBreak d{2,         {0.6, height, 0}, {wall, 1.5 * height, 0}, height / static_cast<double>(r.size),
                   r["slip"], gate_of(r),       r["perturbation"]};
  const Series front = record(r, report, d, 2 * unit).front;
  if (!experiment) return;
  // Z = 1 + (x − 0.6 m)/H
  Series scaled;
  for (std::size_t k = 0; k < front.at.size(); ++k) scaled.add(front.at[k] / unit, 1 + (front.value[k] - 0.6) / height);
  const double at_wall = 1 + (wall - 0.6) / height - 0.01;
  const double arrival = experiment->first_reaches(at_wall);
  judge_series(report, "front", scaled, experiment->between(0.1, arrival));
  report.judge("wall_arrival", std::abs(scaled.first_reaches(at_wall) / arrival - 1));
}

// ---- Martin & Moyce 1952 --------------------------------------------------------------------------------------------

void run_martin_moyce(const Request& r, Report& report) {
  const double a = r["width"], ratio = r["aspect_ratio"], unit = std::sqrt(a / (2 * 9.81));
  const auto front = reference("dambreak/martin_moyce1952_table2_front_n2_2_a2.25in.csv", "T", "Z");
  const auto height = reference("dambreak/martin_moyce1952_table6_height_n2_2_a2.25in.csv", "tau", "H");
  if (front) expect_series(report, "front", no_reach, 0.04);
  if (height) expect_series(report, "height", no_reach, 0.04);
  const DamBreak d{
      2,          {a, ratio * a, 0}, {16 * a, 1.2 * ratio * a, 0}, a / static_cast<double>(r.size), r["slip"],
      gate_of(r), r["perturbation"]};
  const double end = r["end_time"];
  const Record run = record(r, report, d, end * unit);
  if (front) judge_series(report, "front", run.front.scaled(1 / unit, 1 / a), front->between(0, end));
  if (!height) return;
  const double root = std::sqrt(2.0);  // T = √2 τ
  judge_series(report, "height", run.height.scaled(1 / (root * unit), 1 / (ratio * a)), height->between(0, end / root));
}

// ---- Koshizuka & Oka 1996 -------------------------------------------------------------------------------------------

void run_koshizuka(const Request& r, Report& report) {
  const auto experiment = reference("dambreak/koshizuka_oka1996_exp_front_dualsphysics.csv", "t_s", "x_tip_m");
  if (experiment) expect_series(report, "front", no_reach, 0.04);
  const double width = r["width"], ratio = r["aspect_ratio"], unit = std::sqrt(width);
  const DamBreak d{2,
                   {width, ratio * width, 0},
                   {4 * width, 2 * ratio * width, 0},
                   width / static_cast<double>(r.size),
                   r["slip"],
                   gate_of(r),
                   r["perturbation"]};
  const Series front = record(r, report, d, 0.75 * unit).front;
  if (!experiment) return;
  // As far as 3.9 widths: there is the wall.
  const Series before_wall = experiment->between(0, experiment->first_reaches(3.9));
  judge_series(report, "front", front.scaled(1 / unit, 1 / width), before_wall);
}

}  // namespace

Case cruchaga_a() { return cruchaga("cruchaga-a", 0.114, run_cruchaga_a); }
Case cruchaga_b() { return cruchaga("cruchaga-b", 0.228, run_cruchaga_b); }

Case lobovsky_front() {
  return {"lobovsky-front",
          "column 0.6 m wide in a tank of 1.61 m (Lobovský et al. 2014); relative rms of the front, raw and after a "
          "shift in time, and the arrival at the wall",
          "particles a height of the column",
          120,
          8,
          {{"height", 0.6, "of the column, m"}, slip, gate_parameter(4.53), perturbation_parameter()},
          run_lobovsky_front};
}

Case martin_moyce() {
  return {"martin-moyce",
          "column with n² = 2 (Martin & Moyce 1952); relative rms of front and height, raw and after a shift in time",
          "particles across the column",
          30,
          6,
          {{"width", 0.05715, "of the column, m"},
           {"aspect_ratio", 2, "height over width"},
           {"end_time", 3.4, "√(width/2g)"},
           slip,
           gate_parameter(),
           perturbation_parameter()},
          run_martin_moyce};
}

Case koshizuka() {
  return {"koshizuka",
          "column twice as high as wide in a tank 4 widths long (Koshizuka & Oka 1996); relative rms of the front, raw "
          "and after a shift in time",
          "particles across the column",
          40,
          6,
          {{"width", 1, "of the column, m"},
           {"aspect_ratio", 2, "height over width"},
           slip,
           gate_parameter(),
           perturbation_parameter()},
          run_koshizuka};
}

}  // namespace molten::study
