// Dias 2017 ([D]), chapter 6: its own dam breaks in 2-D at its numbers of particles, with its lattice (two particles a
// cell) in a tank that is open at the top. Its walls are dynamic boundary particles; numerics other than preset "dias"
// take their own.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "bench/study/dam_break.h"
#include "bench/study/list.h"
#include "bench/study/scene_text.h"

namespace molten::study {

namespace {

/// A tank and a column in cells of [D]'s lattice. Its rows at whole cells, and those half a cell lower between them,
/// are as many as its numbers of particles say.
struct Tank {
  double cell = 0;            // m
  int width = 0, height = 0;  // cells
  int columns = 0, rows = 0, lower_rows = 0;
  double sound_speed = 30;  // m/s

  /// The same with `columns` columns.
  Tank refined(long long to) const {
    const double factor = static_cast<double>(to) / columns;
    const auto times = [&](int n) { return static_cast<int>(std::lround(n * factor)); };
    return {cell / factor, times(width),      times(height), static_cast<int>(to),
            times(rows),   times(lower_rows), sound_speed};
  }
};

constexpr Tank figure_tank{0.03, 133, 133, 33, 66, 67}, tank_a{0.0032, 131, 137, 36, 36, 36},
    tank_b{0.0032, 131, 137, 36, 71, 71}, tank_lobovsky{0.0032, 503, 188, 187, 94, 94};

Start column_of(const Tank& t) {
  Start start;
  for (int k = 1; k <= t.rows; ++k)
    for (int i = 1; i <= t.columns; ++i) start.position.push_back({i * t.cell, k * t.cell, 0});
  for (int k = 1; k <= t.lower_rows; ++k)
    for (int i = 1; i < t.columns; ++i) start.position.push_back({(i + 0.5) * t.cell, (k - 0.5) * t.cell, 0});
  start.velocity.assign(start.position.size(), Triple{});
  start.spacing = t.cell / std::numbers::sqrt2;
  start.measure = static_cast<double>(start.position.size()) * start.spacing * start.spacing;
  return start;
}

Setup setup_of(const Request& r, const Tank& t) {
  const bool as_dias = r.numerics == "dias";
  const double right = t.width * t.cell, top = t.height * t.cell;
  const double spacing = t.cell / std::numbers::sqrt2;
  Setup s;
  s.scene = scene_head(2, {0, -9.81, 0}) + fluid_text(2, spacing, 1000, "hydrostatic = true") +
            fmt::format(
                "[[boundary]]\npolygon = {{ points = [[0, {1}], [0, 0], [{0}, 0], [{0}, {1}]], open = true }}\n"
                "inside = true\nslip = {2}\n",
                right, top, r["slip"]);
  if (gate_of(r) > 0)
    s.scene += gate_text(t.columns * t.cell + spacing / 2, (t.rows + 4) * t.cell, spacing, gate_of(r));
  // h = 0.92 √2 of [D]'s cells.
  if (as_dias) s.scene += sound_speed_text(t.sound_speed) + "smoothing_ratio = 1.84\n";
  s.start = column_of(t);
  return s;
}

/// The fifth-farthest particle (m), as [D] reads its fronts, or another one.
double front_particle(const Cloud& c, std::ptrdiff_t farthest = 5) { return front_of(c, farthest) - c.spacing / 2; }

const Parameter slip{"slip", 1, "of the walls: 1 free slip, 0 no-slip; boundary particles hold by themselves"};

// ---- tables 6.2 to 6.4 ----------------------------------------------------------------------------------------------

/// Fronts at three or two times: measured, and [D]'s own with these artificial viscosities.
struct Table {
  Series experiment;
  std::vector<std::pair<double, std::vector<double>>> own;  // α, m
};

const Table table_a{{{0.1, 0.2}, {0.190, 0.290}}, {{0.2, {0.177, 0.297}}, {0.3, {0.175, 0.291}}}};
const Table table_b{{{0.1, 0.2}, {0.220, 0.360}}, {{0.2, {0.191, 0.362}}, {0.3, {0.185, 0.349}}}};
const Table table_lobovsky{{{0.16, 0.27, 0.37}, {0.865, 1.140, 1.362}}, {{0.1, {0.827, 1.100, 1.394}}}};

/// Mean of |x_run(t − shift) − x| over the mean of x.
double shifted_deviation(const Series& run, const Series& experiment, double shift) {
  Series later = run;
  for (double& t : later.at) t += shift;
  return mean_deviation(later, experiment);
}

/// The shift (s) with the least deviation.
double least_shift(const Series& run, const Series& experiment) {
  const double most = 0.3 * experiment.at.back();
  double best = 0;
  for (int k = -300; k <= 300; ++k)
    if (const double shift = k * most / 300;
        shifted_deviation(run, experiment, shift) < shifted_deviation(run, experiment, best))
      best = shift;
  return best;
}

void run_table(const Request& r, Report& report, const Tank& tank, const Table& table) {
  const double alpha = r["alpha"];
  const auto own = std::find_if(table.own.begin(), table.own.end(), [&](const auto& o) { return o.first == alpha; });
  const bool compare = own != table.own.end();
  const auto name = [](const char* what, double t) { return fmt::format("{}_{}s", what, t); };
  report.expect("front_mean", no_reach);
  report.expect("front_shifted", no_reach);
  report.expect("time_shift_s", no_reach);
  for (const double t : table.experiment.at) {
    report.expect(name("position_m", t), no_reach);
    report.expect(name("position_by_volume_m", t), no_reach);
    if (compare) report.expect(name("from_dias", t), 0.02);
  }
  Request request = r;
  if (r.numerics == "dias") request.scene_overrides.push_back(fmt::format("numerics.artificial_viscosity={}", alpha));
  const auto simulation = Simulation::make(request, setup_of(r, tank.refined(r.size)), report);
  const double end = table.experiment.at.back() * 1.3;
  // With as much fluid ahead as in [D]'s five particles, whatever the size: the tongue that five particles make thins.
  const double five = 5 * std::pow(static_cast<double>(r.size) / tank.columns, 2);
  const auto as_much = std::max(std::lround(five), 1L);
  Series front, front_by_volume;
  simulation->run_until(end, end / 300, [&](const Cloud& c) {
    front.add(c.time, front_particle(c));
    front_by_volume.add(c.time, front_particle(c, as_much));
  });
  const double shift = least_shift(front, table.experiment);
  report.judge("front_mean", mean_deviation(front, table.experiment));
  report.judge("front_shifted", shifted_deviation(front, table.experiment, shift));
  report.judge("time_shift_s", shift);
  for (std::size_t k = 0; k < table.experiment.at.size(); ++k) {
    const double t = table.experiment.at[k];
    report.judge(name("position_m", t), front(t));
    report.judge(name("position_by_volume_m", t), front_by_volume(t));
    if (compare) report.judge(name("from_dias", t), std::abs(front(t) / own->second[k] - 1));
  }
}

Case table_case(const std::string& name, const std::string& what, const Tank& tank, double alpha,
                void (*run)(const Request&, Report&)) {
  return {name,
          what +
              "; mean deviation of the front over the mean front, raw and after a shift in time, the fronts "
              "themselves, by the fifth-farthest particle and by the volume of five of Dias' particles, and how far "
              "they are from Dias' own",
          "columns of Dias' lattice",
          tank.columns,
          8,
          {{"alpha", alpha, "artificial viscosity of preset dias"}, slip, gate_parameter()},
          run};
}

// ---- figures 6.1 to 6.5 ---------------------------------------------------------------------------------------------

double mean_of(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (const double p : a) sum += p;
  for (const double p : b) sum += p;
  return sum / static_cast<double>(a.size() + b.size());
}

/// Standard deviation of the particles' pressures (Pa) against their mean over a kernel's support around each.
double roughness(const Cloud& c) {
  double square = 0;
  for (std::size_t k = 0; k < c.count(); ++k) square += std::pow(c.pressure[k] - pressure_at(c, 2, c.position[k]), 2);
  return std::sqrt(square / static_cast<double>(c.count()));
}

/// Standard deviation of a series against its moving mean over ±half (in its abscissa).
double noise_of(const Series& s, double half) {
  double square = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < s.at.size(); ++k) {
    if (s.at[k] < s.at.front() + half || s.at[k] > s.at.back() - half) continue;
    const Series near = s.between(s.at[k] - half, s.at[k] + half);
    double mean = 0;
    for (const double v : near.value) mean += v / static_cast<double>(near.value.size());
    square += std::pow(s.value[k] - mean, 2);
    ++count;
  }
  return std::sqrt(square / static_cast<double>(count));
}

void run_figures(const Request& r, Report& report) {
  static const std::vector<double> samples{0.49, 1.59, 3.09};  // s, of [D]'s table 6.1
  const double alpha = r["alpha"], end = r["end_time"];
  report.expect("wall_arrival_s", no_reach);
  report.expect("wall_arrival", 0.02);
  report.expect("pressure_noise_Pa", no_reach);
  report.expect("pressure_roughness_Pa", no_reach);
  for (const double t : samples) {
    if (t > end) continue;
    report.expect(fmt::format("mean_pressure_{}s_Pa", t), no_reach);
    report.expect(fmt::format("mean_with_walls_{}s_Pa", t), no_reach);
  }
  Request request = r;
  if (r.numerics == "dias") request.scene_overrides.push_back(fmt::format("numerics.artificial_viscosity={}", alpha));
  const Tank tank = figure_tank.refined(r.size);
  const auto simulation = Simulation::make(request, setup_of(r, tank), report);
  Series front, mean, mean_with_walls, probe;
  std::optional<double> rough;
  simulation->run_until(end, 0.002, [&](const Cloud& c) {
    front.add(c.time, front_particle(c));
    mean.add(c.time, mean_of(c.pressure, {}));
    mean_with_walls.add(c.time, mean_of(c.pressure, c.wall_pressure));
    probe.add(c.time, pressure_at(c, 2, {2 * tank.cell, 0.2, 0}));
    if (!rough && c.time >= samples.front()) rough = roughness(c);
  });
  const double own = alpha > 0 ? 0.77 : 0.67, arrival = front.first_reaches((tank.width - 1) * tank.cell);
  report.judge("wall_arrival_s", arrival);
  report.judge("wall_arrival", std::abs(arrival / own - 1));
  report.judge("pressure_noise_Pa", noise_of(probe.between(0.1, std::min(end, 0.7)), 0.02));
  report.judge("pressure_roughness_Pa", rough.value_or(no_reach));
  for (const double t : samples) {
    if (t > end) continue;
    report.judge(fmt::format("mean_pressure_{}s_Pa", t), mean(t));
    report.judge(fmt::format("mean_with_walls_{}s_Pa", t), mean_with_walls(t));
  }
}

}  // namespace

Case dias_a() {
  return table_case("dias-a",
                    "table 6.2 of Dias (2017): column A of Cruchaga et al. (2007), 2556 particles and 813 of "
                    "the tank",
                    tank_a, 0.2, [](const Request& r, Report& p) { run_table(r, p, tank_a, table_a); });
}
Case dias_b() {
  return table_case("dias-b", "table 6.3 of Dias (2017): column B, 5041 particles and 813 of the tank", tank_b, 0.2,
                    [](const Request& r, Report& p) { run_table(r, p, tank_b, table_b); });
}
Case dias_lobovsky() {
  return table_case("dias-lobovsky",
                    "table 6.4 of Dias (2017): column of Lobovský et al. (2014), H = 300 mm, 35062 particles and 1761 "
                    "of the tank",
                    tank_lobovsky, 0.1,
                    [](const Request& r, Report& p) { run_table(r, p, tank_lobovsky, table_lobovsky); });
}
Case dias_tank() {
  return {"dias-tank",
          "figures 6.1 to 6.5 of Dias (2017): column of 1 × 2 m in a tank of 4 × 4 m, 4322 particles and 801 of the "
          "tank; arrival at the wall, there 0.77 s and without artificial viscosity 0.67 s; standard deviation of the "
          "pressure beside the closed wall, 0.2 m high, against its moving mean over 0.04 s; that of the "
          "particles' pressures against their means over a kernel at 0.49 s; mean pressures of the fluid, "
          "and of fluid and boundary particles",
          "columns of Dias' lattice",
          figure_tank.columns,
          8,
          {{"alpha", 0.3, "artificial viscosity of preset dias"}, {"end_time", 1, "s"}, slip, gate_parameter()},
          run_figures};
}

}  // namespace molten::study
