// Medians of what was taken in turn, with the interval that holds the median with 95 % confidence.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace molten::bench {

struct Ratio {
  double median, low, high;
};

inline double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

/// By order statistics, in the normal approximation of the binomial.
inline Ratio ratio_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  const auto margin = static_cast<std::size_t>(std::max(0.0, std::floor((n - 1.96 * std::sqrt(n)) / 2)));
  return {values[values.size() / 2], values[margin], values[values.size() - 1 - margin]};
}

}  // namespace molten::bench
