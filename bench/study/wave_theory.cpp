#include "bench/study/wave_theory.h"

#include <Eigen/Dense>
#include <cmath>

namespace molten::study {

namespace {

/// Vorticity Ω(y) sin kx and vertical velocity V(y) cos kx on rows y = n/rows:
///   Ω' = ν (Ω_yy − k² Ω),  V_yy − k² V = k Ω,  V_y = −k U (U sin kx the velocity along x),
/// at the bottom Ω = V = 0; at the surface no shear stress, Ω = −2 k V, its height η' = V, and by the momentum along it
/// with the pressure g η + 2 ν V_y there U' = k (η + 2 ν V_y) − ν Ω_y. The state is Ω within, U at the surface, η.
class Rows {
 public:
  Rows(double k, double viscosity) : k_(k), viscosity_(viscosity), from_state_(rows + 2, rows + 1) {
    from_state_.setZero();
    for (int n = 1; n < rows; ++n) from_state_(n, n - 1) = 1;
    from_state_(rows + 1, rows - 1) = 1;
    find_velocity();
    from_state_.row(rows) = -2 * k_ * velocity_.row(rows);
  }

  /// Of the state.
  Eigen::MatrixXd rates() const {
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(rows + 1, rows + 1);
    for (int n = 1; n < rows; ++n)
      m.row(n - 1) =
          viscosity_ * ((from_state_.row(n - 1) - 2 * from_state_.row(n) + from_state_.row(n + 1)) * rows * rows -
                        k_ * k_ * from_state_.row(n));
    m.row(rows - 1) = -viscosity_ * rows *
                      (1.5 * from_state_.row(rows) - 2 * from_state_.row(rows - 1) + 0.5 * from_state_.row(rows - 2));
    m(rows - 1, rows - 1) -= 2 * viscosity_ * k_ * k_;
    m(rows - 1, rows) += k_;
    m.row(rows) = velocity_.row(rows);
    return m;
  }

  static Eigen::VectorXd start() { return Eigen::VectorXd::Unit(rows + 1, rows - 1); }

  double kinetic_energy(const Eigen::VectorXd& state) const {
    const Eigen::VectorXd v = velocity_ * state;
    double sum = 0;
    for (int n = 0; n < rows; ++n)
      sum += std::pow((v[n + 1] - v[n]) * rows / k_, 2) + std::pow((v[n] + v[n + 1]) / 2, 2);
    return sum / rows;
  }

 private:
  static constexpr int rows = 200;

  /// V from the state.
  void find_velocity() {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows + 1, rows + 1), b = Eigen::MatrixXd::Zero(rows + 1, rows + 2);
    a(0, 0) = 1;
    for (int n = 1; n < rows; ++n) {
      a(n, n - 1) = a(n, n + 1) = rows * rows;
      a(n, n) = -2 * rows * rows - k_ * k_;
      b(n, n) = k_;
    }
    a(rows, rows) = 1.5 * rows, a(rows, rows - 1) = -2 * rows, a(rows, rows - 2) = 0.5 * rows;
    b(rows, rows + 1) = -k_;
    velocity_ = a.partialPivLu().solve(b) * from_state_;
  }

  double k_, viscosity_;
  Eigen::MatrixXd from_state_, velocity_;  // state → (Ω of all rows, U); state → V of all rows
};

}  // namespace

Series ViscousWave::kinetic_energy(double end, double every) const {
  constexpr int parts = 4;  // steps of the trapezoidal rule a sample
  const Rows rows(wave_number, viscosity);
  const Eigen::MatrixXd half = every / parts / 2 * rows.rates(),
                        one = Eigen::MatrixXd::Identity(half.rows(), half.cols());
  const Eigen::MatrixXd step = (one - half).partialPivLu().solve(one + half);
  Eigen::VectorXd state = Rows::start();
  Series energy;
  for (double t = 0; t <= end; t += every) {
    energy.add(t, rows.kinetic_energy(state));
    for (int n = 0; n < parts; ++n) state = step * state;
  }
  return energy;
}

}  // namespace molten::study
