// Pressures and heights of dam breaks against experiments: Lobovský et al. 2014, H = 300 mm, and Kleefsman et al. 2005
// (SPHERIC test 2) in 3-D.
#include <algorithm>
#include <cmath>

#include "bench/study/dam_break.h"
#include "bench/study/list.h"
#include "bench/study/reference.h"
#include "bench/study/scene_text.h"

namespace molten::study {

namespace {

/// Judges a pressure over time by the size of its peak and by when it first is a tenth of the experiment's peak.
void judge_impact(Report& report, const std::string& name, const Series& run, const Series& experiment) {
  if (run.at.empty() || experiment.at.empty()) {  // the run ends before the experiment's time begins
    report.judge(name + "_peak", no_reach);
    report.judge(name + "_arrival", no_reach);
    return;
  }
  const auto peak = [](const Series& s) { return *std::max_element(s.value.begin(), s.value.end()); };
  const double expected = peak(experiment), tenth = expected / 10;
  report.judge(name + "_peak", std::abs(peak(run) / expected - 1));
  report.judge(name + "_arrival", std::abs(run.first_reaches(tenth) / experiment.first_reaches(tenth) - 1));
}

// ---- Lobovský et al. 2014, H = 300 mm -------------------------------------------------------------------------------

/// The fronts that [D] tables, and the mean deviation of its own run.
const Series dias_front{{0.16, 0.27, 0.37}, {0.865, 1.140, 1.362}};
constexpr double dias_deviation = (0.038 + 0.040 + 0.032) / (0.865 + 1.140 + 1.362);

/// Samples a second of the experiment's sensors, 4.2 mm wide: less than a kernel.
constexpr double lobovsky_rate = 20000;

void run_lobovsky_pressure(const Request& r, Report& report) {
  const double height = r["height"], wall = 1.61;
  const double unit = std::sqrt(height / 9.81), pressure_unit = 1000 * 9.81 * height;
  const auto experiment = reference("dambreak/lobovsky2014_P1_z3mm.csv", "t", "v");
  report.expect("front_mean", dias_deviation);
  if (experiment) {
    report.expect("p1_peak", 0.15);
    report.expect("p1_arrival", 0.05);
  }
  const DamBreak d{2,         {0.6, height, 0}, {wall, 2 * height, 0}, height / static_cast<double>(r.size),
                   r["slip"], gate_of(r),       r["perturbation"]};
  const auto simulation = Simulation::make(r, dam_break(d), report);
  Series front, pressure;
  WallSensor sensor({wall, 0.003, 0}, {}, d.tank);
  simulation->run_until(r["end_time"] * unit, 1 / lobovsky_rate, [&](const Cloud& c) {
    front.add(c.time, front_of(c));
    pressure.add(c.time / unit, sensor.pressure(c, 2) / pressure_unit);
  });
  report.judge("front_mean", mean_deviation(front, dias_front));
  if (experiment) judge_impact(report, "p1", pressure, experiment->between(2, r["end_time"]));
}

// ---- Kleefsman et al. 2005 ------------------------------------------------------------------------------------------

const Triple kleefsman_tank{3.22, 1, 1}, kleefsman_water{1.228, 1, 0.55};
/// The closed wall behind the water is at x = 0 here, at 3.22 m there: x is mirrored.
double mirrored(double x) { return kleefsman_tank[0] - x; }

Setup kleefsman_setup(const Request& r) {
  const double volume = kleefsman_water[0] * kleefsman_water[1] * kleefsman_water[2];
  DamBreak d{3, kleefsman_water,   kleefsman_tank, std::cbrt(volume / static_cast<double>(r.size)), r["slip"],
             0, r["perturbation"], r["stagger"]};
  Setup s = dam_break(d);
  s.scene += fmt::format("[[boundary]]\nbox = {{ min = [{}, 0.2985, -0.1], max = [{}, 0.7015, 0.161] }}\nslip = {}\n",
                         mirrored(0.8245), mirrored(0.8245 - 0.161), r["slip"]);
  return s;
}

struct Gauge {
  std::string name;
  double reach;
  double place;  // m; of a depth: x, as in the experiment; of a pressure: z
  Series run;
  std::optional<Series> experiment;
};

/// Mean deviation of a depth over the water's at the start; the run is moved on by `shift`, s.
double depth_deviation(const Gauge& g, double shift) {
  const Series& e = *g.experiment;
  double sum = 0;
  for (std::size_t k = 0; k < e.at.size(); ++k) sum += std::abs(g.run(e.at[k] - shift) - e.value[k]);
  return sum / static_cast<double>(e.at.size()) / kleefsman_water[2];
}

/// Raw, and after the one shift in time that suits both depths best: the record need not start with the water.
void judge_depths(Report& report, const std::vector<Gauge>& depths, double end) {
  const auto sum = [&](double shift) { return depth_deviation(depths[0], shift) + depth_deviation(depths[1], shift); };
  const double shift = best_shift(std::min(0.1, end), sum);
  for (const Gauge& g : depths) {
    report.judge(g.name + "_mean", depth_deviation(g, 0));
    report.judge(g.name + "_shifted", depth_deviation(g, shift));
  }
  report.judge("time_shift", shift / end);
}

void run_kleefsman(const Request& r, Report& report) {
  const double end = r["end_time"];
  std::vector<Gauge> depths{{"h2", 0.03, 0.992, {}, {}}, {"h4", 0.03, 2.638, {}, {}}};
  const double peak_reach = r.size < 400000 ? 0.25 : 0.15;
  std::vector<Gauge> pressures{{"p1", peak_reach, 0.021, {}, {}}, {"p2", peak_reach, 0.061, {}, {}}};
  const auto read = [&](Gauge& g, const std::string& column) {
    g.experiment = reference("dambreak/spheric_test2_kleefsman_full_exp_data.csv", "t_s", column);
    if (g.experiment) g.experiment = g.experiment->between(0, end);
    return g.experiment.has_value();
  };
  for (Gauge& g : depths)
    if (read(g, g.name == "h2" ? "H2" : "H4"))
      report.expect(g.name + "_mean", g.reach), report.expect(g.name + "_shifted", g.reach);
  if (depths[0].experiment) report.expect("time_shift", no_reach);
  for (Gauge& g : pressures)
    if (read(g, g.name == "p1" ? "P1" : "P2"))
      report.expect(g.name + "_peak", g.reach), report.expect(g.name + "_arrival", no_reach);

  const auto simulation = Simulation::make(r, kleefsman_setup(r), report);
  // In front of the box; by the millisecond, as the experiment's record.
  const Triple front{mirrored(0.8245), kleefsman_tank[1], kleefsman_tank[2]};
  std::vector<WallSensor> sensors;
  for (const Gauge& g : pressures) sensors.push_back({{front[0], 0.5, g.place}, {}, front});
  simulation->run_until(end, 0.001, [&](const Cloud& c) {
    const double half = std::max(0.02, c.spacing);
    for (Gauge& g : depths) g.run.add(c.time, depth_at(c, 3, {mirrored(g.place), 0.5, 0}, {half, half, 0}));
    for (std::size_t k = 0; k < pressures.size(); ++k) pressures[k].run.add(c.time, sensors[k].pressure(c, 3));
  });
  if (depths[0].experiment) judge_depths(report, depths, end);
  for (const Gauge& g : pressures)
    if (g.experiment) judge_impact(report, g.name, g.run, *g.experiment);
}

}  // namespace

Case lobovsky_pressure() {
  return {"lobovsky-pressure",
          "column 0.6 m wide, 0.3 m high in a tank of 1.61 m (Lobovský et al. 2014); mean deviation of the front at "
          "0.16, 0.27 and 0.37 s (reach: Dias 2017), peak and arrival of the pressure 3 mm above the floor, the "
          "force on the wall over its area, dry parts counted",
          "particles a height of the column",
          60,
          8,
          {{"height", 0.3, "of the column, m"},
           {"end_time", 3.5, "√(height/g)"},
           {"slip", 1, "of the walls: 1 free slip, 0 no-slip"},
           gate_parameter(4.53),
           perturbation_parameter()},
          run_lobovsky_pressure};
}

Case kleefsman() {
  return {
      "kleefsman",
      "dam break on a box in 3-D (Kleefsman et al. 2005, SPHERIC test 2); mean deviation of the depths H2 and H4 over "
      "the water's depth, raw and after one shift in time, peaks and arrivals of the pressures P1 and P2, likewise",
      "particles",
      12000,
      500,
      {{"end_time", 2, "s; the experiment has 6"},
       {"slip", 1, "of the walls: 1 free slip, 0 no-slip"},
       perturbation_parameter(),
       {"stagger", 0.5, "width of the displacements along the tank of the slices across it at the start, spacings"}},
      run_kleefsman};
}

}  // namespace molten::study
