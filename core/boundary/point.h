// Points, turns and spins in 2-D and 3-D, in double precision.
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace molten {

template <int Dim> using Point = Eigen::Matrix<double, Dim, 1>;

/// An angular velocity (rad/s), a turn (rad) or a torque: one number in 2-D, a vector in 3-D.
template <int Dim> using Spin = Eigen::Matrix<double, Dim == 2 ? 1 : 3, 1>;
template <int Dim> using Turn = Eigen::Matrix<double, Dim, Dim>;

/// The part first..last of 0..1 of the path from x along d that is within a box; false: none.
template <int Dim>
bool part_in_box(const Point<Dim>& lower, const Point<Dim>& upper, const Point<Dim>& x, const Point<Dim>& d,
                 double& first, double& last) {
  first = 0;
  last = 1;
  for (int k = 0; k < Dim; ++k) {
    const double a = lower[k] - x[k], b = upper[k] - x[k];
    if (d[k] == 0) {
      if (!(a <= 0 && b >= 0)) return false;
      continue;
    }
    first = std::max(first, std::min(a / d[k], b / d[k]));
    last = std::min(last, std::max(a / d[k], b / d[k]));
  }
  return first <= last;
}

}  // namespace molten
