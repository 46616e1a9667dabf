#include "bench/study/channel.h"

#include <algorithm>
#include <cmath>

#include "bench/study/list.h"
#include "bench/study/metrics.h"
#include "bench/study/particles.h"
#include "bench/study/scene_text.h"

namespace molten::study {

namespace {

constexpr int parts = 20000;  // of the half gap

double strain_at(const std::function<double(double)>& stress_of, double stress) {
  double low = 0, high = 1;
  while (stress_of(high) < stress) high *= 2;
  for (int k = 0; k < 100; ++k) {
    const double middle = (low + high) / 2;
    (stress_of(middle) < stress ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

ChannelProfile::ChannelProfile(const std::function<double(double)>& stress_of, double wall_stress)
    : velocity_(parts + 1, 0.0) {
  for (int k = parts; k > 0; --k)
    velocity_[k - 1] = velocity_[k] + strain_at(stress_of, wall_stress * (k - 0.5) / parts) / parts;
}

double ChannelProfile::at(double y) const {
  const double k = std::min(std::abs(y), 1.0) * parts;
  const int low = std::min(static_cast<int>(k), parts - 1);
  return velocity_[low] + (k - low) * (velocity_[low + 1] - velocity_[low]);
}

double ChannelProfile::mean() const {
  double sum = 0;
  for (int k = 0; k < parts; ++k) sum += (velocity_[k] + velocity_[k + 1]) / 2 / parts;
  return sum;
}

double smd_stress(double strain, double jump_number, double flow_index) {
  return -std::expm1(-(jump_number + 1) * strain) * (std::pow(strain, flow_index) + 1);
}

namespace {

// A periodic box of height 4 whose halves are driven opposite ways: the velocity vanishes where they meet, so each half
// is a channel between no-slip walls without one.

double from_middle(double y) { return std::fmod(y + 4, 2) - 1; }
double way(double y) { return std::fmod(y + 4, 4) < 2 ? 1 : -1; }

Setup set_up(const Request& r, const std::string& rheology, const ChannelProfile& profile) {
  const double spacing = 1.0 / static_cast<double>(r.size);
  const Triple size{8 * spacing, 4, 0};
  Setup s;
  s.scene = scene_head(2, {}, periodic_text(2, {}, size, "xy")) + fluid_text(2, spacing, 1, rheology) +
            sound_speed_text(std::max(20.0, 10 * profile.at(0)));
  s.start = lattice(2, {}, size, spacing);
  perturb(s.start, 2, r["perturbation"]);
  if (r["from_rest"] == 0)
    set_velocity(s.start, [&](const Triple& x) { return Triple{way(x[1]) * profile.at(from_middle(x[1])), 0, 0}; });
  const double force = r["wall_stress"];
  s.force = [force](const Triple& x) { return Triple{force * way(x[1]), 0, 0}; };
  return s;
}

void run_channel(const Request& r, Report& report, const std::string& rheology, const ChannelProfile& profile) {
  report.expect("profile_rms", 0.01);
  report.expect("mean_velocity", 0.01);
  const auto simulation = Simulation::make(r, set_up(r, rheology, profile), report);
  simulation->run_until(r["end_time"]);

  const Cloud c = simulation->cloud();
  double sum2 = 0, flow = 0;
  for (std::size_t k = 0; k < c.count(); ++k) {
    const double y = c.position[k][1], u = way(y) * c.velocity[k][0];
    sum2 += std::pow(u - profile.at(from_middle(y)), 2);
    flow += u;
  }
  const auto n = static_cast<double>(c.count());
  report.judge("profile_rms", std::sqrt(sum2 / n) / profile.mean());
  report.judge("mean_velocity", std::abs(flow / n / profile.mean() - 1));
}

void run_smd(const Request& r, Report& report) {
  const double jump = r["jump_number"], n = r["n"];
  run_channel(
      r, report,
      fmt::format("[fluid.rheology]\nmodel = \"smd\"\nn = {:.17g}\njump_number = {:.17g}\ndimensionless = true\n", n,
                  jump),
      ChannelProfile([=](double strain) { return smd_stress(strain, jump, n); }, r["wall_stress"]));
}

}  // namespace

Case smd_channel() {
  return {"smd-channel",
          "steady flow of the SMD fluid between plates, in units of the half gap, the yield stress and γ̇₁; rms of the "
          "profile over the mean velocity, mean velocity",
          "particles a half gap",
          32,
          4,
          {{"jump_number", 15, "J"},
           {"n", 0.5, "flow index"},
           {"wall_stress", 2, "yield stresses"},
           {"end_time", 1, "time to become steady"},
           {"from_rest", 0, "1: starts at rest; 0: with the exact profile"},
           {"perturbation", 0, "width of the random displacements at the start, spacings"}},
          run_smd};
}

}  // namespace molten::study
