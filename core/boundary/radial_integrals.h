// Integrals of one kernel along a radius and over planes, in tables.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/scene.h"

namespace molten {

/// W and H = r^−d ∫_r^R W s^{d−1} ds at a distance, 1/m^d, with their first derivative over r and their second one.
struct KernelBeyond {
  double kernel = 0, slope = 0, curvature = 0;
  double hidden = 0, hidden_slope = 0, hidden_curvature = 0;
};

/// Integrals of one kernel, as functions of a distance (m).
class RadialIntegrals {
 public:
  RadialIntegrals() = default;
  RadialIntegrals(KernelKind kernel, int dim, double smoothing_length);

  /// Of an infinite plane: ∫ W dS (1/m), and the part of ∫ W dV behind it.
  struct Plane {
    double weight = 0, hidden = 0;
  };
  /// At the height d (m) over the plane; zeros from 0 down and beyond the support.
  Plane plane(double d) const {
    const double s = d * per_entry_;
    const bool near = s > 0 && s < static_cast<double>(planes_.size() - 1);
    const auto k = near ? static_cast<std::size_t>(s) : planes_.size() - 2;  // zeros, without a branch
    const double part = near ? s - static_cast<double>(k) : 1;
    const Plane &a = planes_[k], &b = planes_[k + 1];
    return {a.weight + part * (b.weight - a.weight), a.hidden + part * (b.hidden - a.hidden)};
  }
  /// ∫_r^R W s ds, and in 3-D r ∫_r^R H s ds.
  double weight_beyond(double r) const { return at(weight_beyond_, r); }
  double hidden_beyond(double r) const { return at(hidden_beyond_, r); }
  double kernel(double r) const { return at(kernel_, r); }
  KernelBeyond around(double r) const;
  double reach() const { return reach_; }  // support radius, m

 private:
  using Table = std::vector<double>;
  double at(const Table& table, double r) const {
    const double s = r * per_entry_;
    if (!(s < static_cast<double>(table.size() - 1))) return 0;
    const auto k = static_cast<std::size_t>(s);
    return table[k] + (s - static_cast<double>(k)) * (table[k + 1] - table[k]);
  }
  void fill_planes_2d();
  void fill_planes_3d();

  int dim_ = 3;
  double reach_ = 0, per_entry_ = 0;  // m, 1/m
  Table kernel_, slope_, weight_beyond_, volume_beyond_, hidden_beyond_;
  std::vector<Plane> planes_;
};

inline KernelBeyond RadialIntegrals::around(double r) const {
  const double s = r * per_entry_;
  if (!(s < static_cast<double>(kernel_.size() - 1))) return {};
  const auto k = static_cast<std::size_t>(s);
  const double part = s - static_cast<double>(k), r2 = r * r;
  const auto between = [&](const Table& t) { return t[k] + part * (t[k + 1] - t[k]); };
  KernelBeyond v;
  v.kernel = between(kernel_);
  v.slope = between(slope_);
  v.curvature = v.slope + r * per_entry_ * (slope_[k + 1] - slope_[k]);
  v.hidden = dim_ == 2 ? between(weight_beyond_) / r2 : between(volume_beyond_) / (r2 * r);
  v.hidden_slope = -(dim_ * v.hidden + v.kernel) / r2;
  v.hidden_curvature = (dim_ + 1) * (dim_ * v.hidden + v.kernel) / r2 - v.slope;
  return v;
}

}  // namespace molten
