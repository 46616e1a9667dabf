// Exact flow between parallel walls.
#pragma once

#include <functional>
#include <vector>

namespace molten::study {

/// Steady velocity over y from the middle (0) to the wall (1) of a generalised Newtonian fluid, whose shear stress is
/// τ_w y: the strain rate that carries it, integrated from the wall. `stress_of` rises with the strain rate.
class ChannelProfile {
 public:
  ChannelProfile(const std::function<double(double)>& stress_of, double wall_stress);

  double at(double y) const;
  double mean() const;

 private:
  std::vector<double> velocity_;
};

/// Shear stress of the SMD fluid in units of τ0 over the strain rate in units of γ̇1 ([P] 6-1).
double smd_stress(double strain, double jump_number, double flow_index);

/// Start-up of plane Poiseuille flow under a force (m/s²) between walls at y = 0 and y = `gap` (Morris, Fox & Zhu
/// 1997).
double poiseuille_velocity(double y, double time, double gap, double kinematic_viscosity, double force);

/// Start-up of plane Couette flow between a wall at rest at y = 0 and one of speed `wall_speed` at y = `gap` (same).
double couette_velocity(double y, double time, double gap, double kinematic_viscosity, double wall_speed);

}  // namespace molten::study
