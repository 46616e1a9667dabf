// A facet as the half-spaces that it lies between, for quick answers about points: its plane and, square to that, one
// plane through each edge (3-D) or end (2-D).
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "core/boundary/sweep.h"

namespace molten {

template <int Dim> class FacetSides {
 public:
  explicit FacetSides(const Facet<Dim>& f) {
    rows_.setZero();
    offset_.setConstant(-HUGE_VAL);  // what has no plane is always inside
    set(0, f.normal, f.corner[0]);
    for (int k = 0; k < Dim; ++k) {
      const Point<Dim> e = (f.corner[(k + 1) % Dim] - f.corner[k]).normalized();
      if constexpr (Dim == 3)
        set(k + 1, f.normal.cross(e), f.corner[k]);
      else if (!f.normal.isZero(0))
        set(k + 1, e, f.corner[k]);
    }
  }

  /// How a point lies to the planes (m).
  struct At {
    double height;  // above the facet
    double inside;  // from the nearest edge; negative: beyond it
    /// True only if the facet is further away than `distance`.
    bool further_than(double distance) const {
      return std::abs(height) > distance || (inside < 0 && inside * inside > distance * distance - height * height);
    }
  };
  At at(const Point<Dim>& x) const {
    const Eigen::Vector4d q = rows_ * x - offset_;
    return {q[0], std::min(q[1], std::min(q[2], q[3]))};
  }

 private:
  void set(int row, const Point<Dim>& inwards, const Point<Dim>& through) {
    rows_.row(row) = inwards;
    offset_[row] = inwards.dot(through);
  }

  Eigen::Matrix<double, 4, Dim> rows_;
  Eigen::Vector4d offset_;  // m
};

}  // namespace molten
