// Points, turns and spins in 2-D and 3-D, in double precision.
#pragma once

#include <Eigen/Core>

namespace molten {

template <int Dim> using Point = Eigen::Matrix<double, Dim, 1>;

/// An angular velocity (rad/s), a turn (rad) or a torque: one number in 2-D, a vector in 3-D.
template <int Dim> using Spin = Eigen::Matrix<double, Dim == 2 ? 1 : 3, 1>;
template <int Dim> using Turn = Eigen::Matrix<double, Dim, Dim>;

}  // namespace molten
