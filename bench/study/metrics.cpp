#include "bench/study/metrics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace molten::study {

double Series::operator()(double a) const {
  const auto next = std::upper_bound(at.begin(), at.end(), a);
  if (next == at.begin()) return value.front();
  if (next == at.end()) return value.back();
  const std::size_t k = next - at.begin();
  return value[k - 1] + (value[k] - value[k - 1]) * (a - at[k - 1]) / (at[k] - at[k - 1]);
}

double Series::first_reaches(double level) const {
  for (std::size_t k = 0; k < at.size(); ++k) {
    if (value[k] < level) continue;
    if (k == 0) return at[0];
    return at[k - 1] + (at[k] - at[k - 1]) * (level - value[k - 1]) / (value[k] - value[k - 1]);
  }
  return std::numeric_limits<double>::infinity();
}

Series Series::scaled(double at_factor, double value_factor) const {
  Series s;
  for (std::size_t k = 0; k < at.size(); ++k) s.add(at[k] * at_factor, value[k] * value_factor);
  return s;
}

Series Series::between(double from, double to) const {
  Series s;
  for (std::size_t k = 0; k < at.size(); ++k)
    if (at[k] >= from && at[k] <= to) s.add(at[k], value[k]);
  return s;
}

double relative_rms(const Series& run, const Series& reference, double shift) {
  double sum = 0;
  for (std::size_t k = 0; k < reference.at.size(); ++k)
    sum += std::pow(run(reference.at[k] - shift) / reference.value[k] - 1, 2);
  return std::sqrt(sum / static_cast<double>(reference.at.size()));
}

double mean_deviation(const Series& run, const Series& reference) {
  FieldError error;
  for (std::size_t k = 0; k < reference.at.size(); ++k) error.add(run(reference.at[k]), reference.value[k]);
  return error.l1();
}

double best_shift(double most, const std::function<double(double shift)>& error) {
  constexpr int parts = 1000;
  double best = 0, least = error(0);
  for (int k = -parts; k <= parts; ++k) {
    const double shift = most * k / parts, here = error(shift);
    if (here < least) least = here, best = shift;
  }
  return best;
}

void FieldError::add(double value, double exact) {
  difference1_ += std::abs(value - exact);
  exact1_ += std::abs(exact);
  difference2_ += (value - exact) * (value - exact);
  exact2_ += exact * exact;
}

double FieldError::l2() const { return std::sqrt(difference2_ / exact2_); }

double depth_at(const Cloud& cloud, int dimensions, const Triple& place, const Triple& half) {
  double sum = 0, area = 1;
  for (int d = 0; d + 1 < dimensions; ++d) area *= 2 * half[d];
  for (std::size_t k = 0; k < cloud.count(); ++k) {
    const double volume = cloud.mass / cloud.density[k], side = std::pow(volume, 1.0 / dimensions);
    double over = 1;
    for (int d = 0; d + 1 < dimensions; ++d) {
      const double aside = cloud.position[k][d] - place[d];
      const double low = std::max(aside - side / 2, -half[d]), high = std::min(aside + side / 2, half[d]);
      over *= std::max(high - low, 0.0) / side;
    }
    sum += over * volume;
  }
  return sum / area;
}

namespace {

/// Wendland C2 as W/W(0), by r/h below 2.
double shape(double q) { return std::pow(1 - q / 2, 4) * (2 * q + 1); }

/// Its integral over the whole support.
double shape_integral(double smoothing_length, int dimensions) {
  return dimensions == 2 ? 4 * M_PI / 7 * std::pow(smoothing_length, 2)
                         : 16 * M_PI / 21 * std::pow(smoothing_length, 3);
}

/// Calls f(k, weight, offset from the point) for the particles within a support of a point; Wendland C2 as W/W(0).
template <class F> void near(const Cloud& cloud, int dimensions, const Triple& point, F&& f) {
  const double support = 2 * cloud.smoothing_length;
  for (std::size_t k = 0; k < cloud.count(); ++k) {
    Triple offset{};
    double r2 = 0;
    for (int d = 0; d < dimensions; ++d) offset[d] = cloud.position[k][d] - point[d], r2 += offset[d] * offset[d];
    if (r2 >= support * support) continue;
    const double q = std::sqrt(r2) / cloud.smoothing_length;
    f(k, shape(q), offset);
  }
}

/// Weighted least squares of a value over powers of the offset from a point, over h.
class Fit {
 public:
  explicit Fit(int terms) : moments_(Matrix::Zero(terms, terms)), sums_(Vector::Zero(terms)) {}

  void add(double weight, const Eigen::VectorXd& powers, double value) {
    moments_ += weight * powers * powers.transpose();
    sums_ += weight * value * powers;
  }
  /// At the point itself; nothing where the points do not span the powers.
  std::optional<double> value() const {
    const Eigen::LDLT<Matrix> factors(moments_);
    if (factors.vectorD().minCoeff() <= 1e-6 * moments_(0, 0)) return std::nullopt;
    return factors.solve(sums_)[0];
  }

 private:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  Matrix moments_;
  Vector sums_;
};

/// All products of at most `order` (0 to 2) of the coordinates.
Eigen::VectorXd powers(const Triple& x, int dimensions, int order) {
  Eigen::VectorXd all(10);
  int n = 0;
  all[n++] = 1;
  for (int d = 0; order > 0 && d < dimensions; ++d) all[n++] = x[d];
  for (int d = 0; order > 1 && d < dimensions; ++d)
    for (int e = d; e < dimensions; ++e) all[n++] = x[d] * x[e];
  return all.head(n);
}

}  // namespace

double value_at(const Cloud& cloud, int dimensions, const Triple& point, const std::function<double(std::size_t)>& of) {
  for (int order = 2; order >= 0; --order) {
    Fit fit(static_cast<int>(powers({}, dimensions, order).size()));
    near(cloud, dimensions, point, [&](std::size_t k, double weight, Triple offset) {
      for (double& x : offset) x /= cloud.smoothing_length;
      fit.add(weight, powers(offset, dimensions, order), of(k));
    });
    if (const auto value = fit.value()) return *value;
  }
  return 0;
}

double pressure_at(const Cloud& cloud, int dimensions, const Triple& point) {
  double weights = 0, sum = 0;
  near(cloud, dimensions, point, [&](std::size_t k, double weight, const Triple&) {
    weights += weight;
    sum += weight * cloud.pressure[k];
  });
  // On a wall half of the support is fluid; a tenth of the full sum is a drop.
  const double full = shape_integral(cloud.smoothing_length / cloud.spacing, dimensions);
  return weights > 0.1 * full ? sum / weights : 0;
}

double WallSensor::part_inside(double smoothing_length, int dimensions) const {
  constexpr int cells = 40;  // across the support
  const double cell = 4 * smoothing_length / cells;
  const auto middle = [cell](int k) { return (k + 0.5) * cell - cells * cell / 2; };
  double sum = 0;
  for (int k = 0; k < (dimensions == 3 ? cells : 1); ++k)
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        const Triple offset{middle(i), middle(j), dimensions == 3 ? middle(k) : 0};
        double r2 = 0, inside = 1;
        for (int d = 0; d < dimensions; ++d) {
          r2 += offset[d] * offset[d];
          const double low = std::max(place_[d] + offset[d] - cell / 2, lower_[d]);
          const double high = std::min(place_[d] + offset[d] + cell / 2, upper_[d]);
          inside *= std::clamp((high - low) / cell, 0.0, 1.0);
        }
        const double q = std::sqrt(r2) / smoothing_length;
        if (q < 2) sum += inside * shape(q);
      }
  return sum * std::pow(cell, dimensions) / shape_integral(smoothing_length, dimensions);
}

double WallSensor::pressure(const Cloud& cloud, int dimensions) {
  if (cloud.smoothing_length != smoothing_length_) {
    smoothing_length_ = cloud.smoothing_length;
    part_ = part_inside(smoothing_length_, dimensions);
  }
  double sum = 0;
  near(cloud, dimensions, place_, [&](std::size_t k, double weight, const Triple&) {
    sum += weight * cloud.pressure[k] * cloud.mass / cloud.density[k];
  });
  return sum / (part_ * shape_integral(smoothing_length_, dimensions));
}

double kinetic_energy(const Cloud& cloud) {
  double sum = 0;
  for (const Triple& v : cloud.velocity) sum += v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  return cloud.mass * sum / 2;
}

double clumped_part(const Cloud& cloud, int dimensions) {
  std::vector<std::size_t> order(cloud.count());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return cloud.position[a][0] < cloud.position[b][0]; });
  const double near = cloud.spacing / 2;
  std::vector<bool> clumped(cloud.count(), false);
  for (std::size_t a = 0; a < order.size(); ++a) {
    const Triple& x = cloud.position[order[a]];
    for (std::size_t b = a + 1; b < order.size(); ++b) {
      const Triple& y = cloud.position[order[b]];
      if (y[0] - x[0] >= near) break;
      double r2 = 0;
      for (int d = 0; d < dimensions; ++d) r2 += (x[d] - y[d]) * (x[d] - y[d]);
      if (r2 < near * near) clumped[order[a]] = clumped[order[b]] = true;
    }
  }
  return static_cast<double>(std::count(clumped.begin(), clumped.end(), true)) / static_cast<double>(cloud.count());
}

}  // namespace molten::study
