#include "bench/study/channel_profile.h"

#include <algorithm>
#include <cmath>

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

double poiseuille_velocity(double y, double time, double gap, double kinematic_viscosity, double force) {
  double velocity = force / (2 * kinematic_viscosity) * y * (gap - y);
  for (int n = 0; n < 200; ++n) {
    const double k = (2 * n + 1) * M_PI / gap;
    velocity -= 4 * force / (kinematic_viscosity * gap * k * k * k) * std::sin(k * y) *
                std::exp(-kinematic_viscosity * k * k * time);
  }
  return velocity;
}

double couette_velocity(double y, double time, double gap, double kinematic_viscosity, double wall_speed) {
  double velocity = wall_speed * y / gap;
  for (int n = 1; n < 400; ++n) {
    const double k = n * M_PI / gap;
    velocity += 2 * wall_speed / (n * M_PI) * (n % 2 == 0 ? 1 : -1) * std::sin(k * y) *
                std::exp(-kinematic_viscosity * k * k * time);
  }
  return velocity;
}

}  // namespace molten::study
