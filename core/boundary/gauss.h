// Gauss-Legendre quadrature.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace molten {

/// The nodes and weights on [−1, 1].
template <int n> struct Gauss {
  std::array<double, n> node, weight;

  Gauss() {
    for (int k = 0; k < n; ++k) {
      double x = std::cos(std::numbers::pi * (k + 0.75) / (n + 0.5)), slope = 1;
      for (int round = 0; round < 20; ++round) {  // Newton on P_n
        double p = x, before = 1;
        for (int m = 2; m <= n; ++m) before = std::exchange(p, ((2 * m - 1) * x * p - (m - 1) * before) / m);
        slope = n * (x * p - before) / (x * x - 1);
        x -= p / slope;
      }
      node[k] = x;
      weight[k] = 2 / ((1 - x * x) * slope * slope);
    }
  }
  /// ∫_a^b f
  template <class F> double operator()(double a, double b, F&& f) const {
    double sum = 0;
    for (int k = 0; k < n; ++k) sum += weight[k] * f((a + b) / 2 + (b - a) / 2 * node[k]);
    return sum * (b - a) / 2;
  }
};

}  // namespace molten
