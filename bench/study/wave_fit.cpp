#include "bench/study/wave_fit.h"

#include <Eigen/Dense>
#include <cmath>

namespace molten::study {

WaveFit fit_wave(const Series& energy, double frequency, double decay) {
  Eigen::Vector4d p(energy.value.front() / 2, frequency, 0, decay);  // E, ω, φ, β
  for (int round = 0; round < 50; ++round) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (std::size_t k = 0; k < energy.at.size(); ++k) {
      const double t = energy.at[k], phase = 2 * p[1] * t + p[2], fall = std::exp(-p[3] * t);
      const double shape = (1 + std::cos(phase)) * fall, turn = -p[0] * std::sin(phase) * fall;
      const Eigen::Vector4d slope(shape, 2 * t * turn, turn, -t * p[0] * shape);
      normal += slope * slope.transpose();
      right += slope * (energy.value[k] - p[0] * shape);
    }
    const Eigen::Vector4d move = normal.ldlt().solve(right);
    p += move;
    if (move.norm() < 1e-12 * p.norm()) break;
  }
  return {p[1], p[3]};
}

}  // namespace molten::study
