// Flow between parallel walls: steady flow of the SMD and of the Bingham fluid, start-up of plane Poiseuille flow.
// Without walls a periodic box is driven opposite ways in its two halves: the velocity vanishes where they meet, so
// each half is a channel between no-slip walls.
#include <algorithm>
#include <cmath>

#include "bench/study/channel_profile.h"
#include "bench/study/list.h"
#include "bench/study/metrics.h"
#include "bench/study/particles.h"
#include "bench/study/scene_text.h"

namespace molten::study {

namespace {

struct Channel {
  double half_gap = 1;     // m
  double force = 0;        // m/s², along x
  double density = 1;      // kg/m³
  double sound_speed = 0;  // m/s
  std::string rheology;    // TOML
  bool walls = false;
  double wall_speed = 0;  // m/s, of the upper wall

  double from_middle(double y) const { return std::fmod(y + 4 * half_gap, 2 * half_gap) - half_gap; }
  double way(double y) const { return std::fmod(y + 4 * half_gap, 4 * half_gap) < 2 * half_gap ? 1 : -1; }
};

std::string walls_text(double gap, double speed) {
  std::string text = fmt::format(
      "[[boundary]]\nplane = {{ point = [0, 0], normal = [0, 1] }}\n"
      "[[boundary]]\nplane = {{ point = [0, {:.17g}], normal = [0, -1] }}\n",
      gap);
  if (speed != 0) text += fmt::format("velocity = [{:.17g}, 0]\n", speed);
  return text;
}

Setup set_up(const Channel& c, double spacing) {
  const double gap = 2 * c.half_gap;
  const Triple size{8 * spacing, c.walls ? gap : 2 * gap, 0};
  Setup s;
  // With walls the domain is higher than the fluid, so that nothing is lost by touching its edge.
  const Triple lower{0, c.walls ? -gap : 0, 0}, upper{size[0], 2 * gap, 0};
  s.scene = scene_head(2, {c.walls ? c.force : 0, 0, 0}, periodic_text(2, lower, upper, c.walls ? "x" : "xy")) +
            fluid_text(2, spacing, c.density, c.rheology) + sound_speed_text(c.sound_speed);
  if (c.walls) s.scene += wall_support_text() + walls_text(gap, c.wall_speed);
  s.start = lattice(2, {}, size, spacing);
  if (!c.walls) s.force = [c](const Triple& x) { return Triple{c.force * c.way(x[1]), 0, 0}; };
  return s;
}

// ---- steady flow ----------------------------------------------------------------------------------------------------

const std::vector<Parameter> steady_parameters{
    {"wall_stress", 2, "over the yield stress"},
    {"end_time", 1, "time to become steady"},
    {"from_rest", 0, "1: starts at rest; 0: with the exact profile"},
    {"perturbation", 0, "width of the random displacements at the start, spacings"},
    {"walls", 0, "1: between walls; 0: halves of a periodic box"}};

std::vector<Parameter> joined(std::vector<Parameter> first, const std::vector<Parameter>& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

void run_steady(const Request& r, Report& report, const std::string& rheology, const ChannelProfile& profile) {
  report.expect("profile_rms", 0.01);
  report.expect("mean_velocity", 0.01);
  const Channel c{1, r["wall_stress"], 1, std::max(20.0, 10 * profile.at(0)), rheology, r["walls"] != 0, 0};
  Setup s = set_up(c, 1.0 / static_cast<double>(r.size));
  perturb(s.start, 2, r["perturbation"]);
  if (r["from_rest"] == 0)
    set_velocity(s.start, [&](const Triple& x) { return Triple{c.way(x[1]) * profile.at(c.from_middle(x[1])), 0, 0}; });
  const auto simulation = Simulation::make(r, s, report);
  simulation->run_until(r["end_time"]);

  const Cloud cloud = simulation->cloud();
  double sum2 = 0, flow = 0;
  for (std::size_t k = 0; k < cloud.count(); ++k) {
    const double y = cloud.position[k][1], u = c.way(y) * cloud.velocity[k][0];
    sum2 += std::pow(u - profile.at(c.from_middle(y)), 2);
    flow += u;
  }
  const auto n = static_cast<double>(cloud.count());
  report.judge("profile_rms", std::sqrt(sum2 / n) / profile.mean());
  report.judge("mean_velocity", std::abs(flow / n / profile.mean() - 1));
}

void run_smd(const Request& r, Report& report) {
  const double jump = r["jump_number"], n = r["n"];
  const std::string rheology = fmt::format(
      "[fluid.rheology]\nmodel = \"smd\"\nn = {:.17g}\njump_number = {:.17g}\ndimensionless = true\n", n, jump);
  run_steady(r, report, rheology,
             ChannelProfile([=](double strain) { return smd_stress(strain, jump, n); }, r["wall_stress"]));
}

/// Papanastasiou's form, whose viscosity at rest is 1 + m; judged against the ideal Bingham fluid.
void run_bingham(const Request& r, Report& report) {
  const double m = r["regularisation"];
  const std::string rheology = fmt::format(
      "[fluid.rheology]\nmodel = \"bingham\"\nviscosity = 1\nyield_stress = 1\nregularisation = {:.17g}\n", m);
  // The ideal fluid: no strain below the yield stress; the slope stands for infinity.
  const auto ideal = [](double strain) { return std::min(1e12 * strain, 1 + strain); };
  run_steady(r, report, rheology, ChannelProfile(ideal, r["wall_stress"]));
}

// ---- start-up -------------------------------------------------------------------------------------------------------

constexpr double gap = 1e-3, kinematic_viscosity = 1e-6;  // m, m²/s

/// Judges the velocity, exact(y, t), at the times that Morris et al. give.
void run_start_up(const Request& r, Report& report, const Channel& c,
                  const std::function<double(double, double)>& exact) {
  const std::vector<double> times{0.0225, 0.045, 0.1125, 0.225, 1};  // s
  report.expect("profile_l2", 0.005);
  for (const double t : times) report.expect(fmt::format("profile_l2_{}s", t), no_reach);
  const auto simulation = Simulation::make(r, set_up(c, gap / static_cast<double>(r.size)), report);
  double worst = 0;
  for (const double t : times) {
    simulation->run_until(t);
    const Cloud cloud = simulation->cloud();
    FieldError error;
    for (std::size_t k = 0; k < cloud.count(); ++k) {
      const double y = cloud.position[k][1];
      error.add(c.way(y) * cloud.velocity[k][0], exact(c.from_middle(y) + gap / 2, t));
    }
    report.judge(fmt::format("profile_l2_{}s", t), error.l2());
    worst = std::max(worst, error.l2());
  }
  report.judge("profile_l2", worst);
}

void run_poiseuille(const Request& r, Report& report) {
  const double fastest = r["reynolds"] * kinematic_viscosity / gap;
  const double force = 8 * kinematic_viscosity * fastest / (gap * gap);
  const Channel c{gap / 2, force, 1000, 10 * fastest, newtonian_text(1000 * kinematic_viscosity), r["walls"] != 0, 0};
  run_start_up(r, report, c,
               [=](double y, double t) { return poiseuille_velocity(y, t, gap, kinematic_viscosity, force); });
}

void run_couette(const Request& r, Report& report) {
  const double speed = r["reynolds"] * kinematic_viscosity / gap;
  const Channel c{gap / 2, 0, 1000, 10 * speed, newtonian_text(1000 * kinematic_viscosity), true, speed};
  run_start_up(r, report, c,
               [=](double y, double t) { return couette_velocity(y, t, gap, kinematic_viscosity, speed); });
}

}  // namespace

Case smd_channel() {
  return {"smd-channel",
          "steady flow of the SMD fluid between plates, in units of the half gap, the yield stress and γ̇₁; rms of the "
          "profile over the mean velocity, mean velocity",
          "particles a half gap",
          32,
          4,
          joined({{"jump_number", 15, "J"}, {"n", 0.5, "flow index"}}, steady_parameters),
          run_smd};
}

Case poiseuille() {
  return {
      "poiseuille",
      "start-up of plane Poiseuille flow (Morris et al. 1997); largest relative L2 of the velocity at 0.0225, 0.045, "
      "0.1125, 0.225 and 1 s",
      "particles across the gap",
      32,
      6,
      {{"reynolds", 0.0125, "largest velocity × gap/ν"}, {"walls", 1, "1: between walls; 0: halves of a periodic box"}},
      run_poiseuille};
}

Case couette() {
  return {"couette",
          "start-up of plane Couette flow (Morris et al. 1997); as poiseuille",
          "particles across the gap",
          32,
          6,
          {{"reynolds", 0.0125, "speed of the wall × gap/ν"}},
          run_couette};
}

Case bingham_channel() {
  return {
      "bingham-channel",
      "steady flow of the Bingham fluid between plates, in units of the half gap, the yield stress and the viscosity; "
      "as smd-channel, against the ideal fluid",
      "particles a half gap",
      32,
      4,
      joined({{"regularisation", 400, "m of Papanastasiou"}}, steady_parameters),
      run_bingham};
}

}  // namespace molten::study
