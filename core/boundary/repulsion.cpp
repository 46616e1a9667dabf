#include "core/boundary/repulsion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace molten {

template <int Dim>
Repulsion<Dim>::Repulsion(std::vector<RepulsivePoint<Dim>> points, const Parameters<Dim>& p, const StillWater& water)
    : eos_(p.eos), smoothing_length_(p.smoothing_length), bottom_(water.bottom) {
  for (int d = 0; d < Dim; ++d) down_[d] = p.gravity[d];
  if (!(down_.norm() > 0) || !(water.surface > water.bottom))
    throw Error(ExitCode::usage,
                "numerics.boundary_particles: repulsive ones push by the depth of the still water; add gravity and "
                "fluid above the lowest boundary, or choose dynamic ones");
  depth_ = (water.surface - water.bottom) / down_.norm();
  fall_speed_ = std::sqrt(water.surface - water.bottom);
  if (points.empty()) return;
  double pitch = 0;
  Point<Dim> upper = points.front().at;
  lower_ = upper;
  for (const auto& b : points) {
    for (const double along : b.pitch) pitch = std::max(pitch, along);
    lower_ = lower_.cwiseMin(b.at);
    upper = upper.cwiseMax(b.at);
  }
  constexpr double most_cells = 1 << 22;
  width_ = std::hypot(2 * smoothing_length_, std::sqrt(Dim - 1.0) * pitch);
  width_ = std::max(width_, (upper - lower_).maxCoeff() / std::pow(most_cells, 1.0 / Dim));
  std::size_t cells = 1;
  for (int d = 0; d < Dim; ++d) {
    cells_[d] = static_cast<std::int64_t>((upper[d] - lower_[d]) / width_) + 1;
    cells *= static_cast<std::size_t>(cells_[d]);
  }
  const auto number = [&](const RepulsivePoint<Dim>& b) {
    std::size_t n = 0;
    const auto c = cell_of(b.at);
    for (int d = Dim - 1; d >= 0; --d) n = n * cells_[d] + static_cast<std::size_t>(c[d]);
    return n;
  };
  std::stable_sort(points.begin(), points.end(), [&](const auto& a, const auto& b) { return number(a) < number(b); });
  begin_.assign(cells + 1, 0);
  for (const auto& b : points) ++begin_[number(b) + 1];
  for (std::size_t c = 0; c < cells; ++c) begin_[c + 1] += begin_[c];
  points_ = std::move(points);
}

template <int Dim> std::array<std::int64_t, Dim> Repulsion<Dim>::cell_of(const Point<Dim>& x) const {
  std::array<std::int64_t, Dim> c;
  for (int d = 0; d < Dim; ++d)  // far away is beyond the neighbours of all cells
    c[d] = static_cast<std::int64_t>(std::floor(std::clamp((x[d] - lower_[d]) / width_, -4.0, cells_[d] + 4.0)));
  return c;
}

template <int Dim> template <class F> void Repulsion<Dim>::for_each_near(const Point<Dim>& x, F&& f) const {
  const auto middle = cell_of(x);
  for (int n = 0, cells = Dim == 2 ? 9 : 27; n < cells; ++n) {
    std::size_t number = 0, stride = 1;
    bool inside = true;
    for (int d = 0, rest = n; d < Dim; ++d, rest /= 3) {
      const std::int64_t c = middle[d] + rest % 3 - 1;
      inside = inside && c >= 0 && c < cells_[d];
      number += stride * static_cast<std::size_t>(c);
      stride *= static_cast<std::size_t>(cells_[d]);
    }
    if (!inside) continue;
    for (std::uint32_t k = begin_[number]; k < begin_[number + 1]; ++k) f(points_[k]);
  }
}

/// Above the lowest boundary particle, m.
template <int Dim> double Repulsion<Dim>::height(const Point<Dim>& x) const {
  return (-down_.dot(x) - bottom_) / down_.norm();
}

/// R P ε
template <int Dim>
double Repulsion<Dim>::strength(const RepulsivePoint<Dim>& b, const Point<Dim>& way, double normal_speed,
                                double sound_speed, double height) const {
  const double psi = way.dot(b.normal), q = psi / (2 * smoothing_length_);
  if (!(psi > 0) || q >= 1) return 0;
  double share = 1;
  for (int k = 0; k < Dim - 1; ++k) {
    const double aside = std::abs(way.dot(b.tangent[k]));
    if (aside >= b.pitch[k]) return 0;
    share *= (1 + std::cos(std::numbers::pi * aside / b.pitch[k])) / 2;
  }
  constexpr double least = 0.02;
  const double c0 = eos_.sound_speed, beta = c0 / (10 * fall_speed_);
  const double braked = normal_speed > 0 ? sound_speed * normal_speed / beta : 0;
  const double a = (0.01 * sound_speed * sound_speed / (beta * beta) - braked) / smoothing_length_;
  const double of_wall = this->height(b.at) / depth_;
  const double by_depth = of_wall < least ? 1 : least + (height > depth_ ? 0 : std::abs(1 - of_wall));
  const double by_speed = normal_speed < 0 ? std::min(1.0, -40 * normal_speed / c0) : 0;
  return a * (1 - q) / std::sqrt(q) * share * (by_depth + by_speed);
}

template <int Dim>
Point<Dim> Repulsion<Dim>::acceleration(const Point<Dim>& x, const Point<Dim>& v, double compression) const {
  const double exponent = eos_.kind == StateEquation::tait ? (eos_.gamma - 1) / 2 : 0;
  const double sound_speed = eos_.sound_speed * std::pow(1 + compression, exponent);
  const double z = height(x);
  Point<Dim> a = Point<Dim>::Zero();
  for_each_near(
      x, [&](const RepulsivePoint<Dim>& b) { a += strength(b, x - b.at, v.dot(b.normal), sound_speed, z) * b.normal; });
  return a;
}

template class Repulsion<2>;
template class Repulsion<3>;

}  // namespace molten
