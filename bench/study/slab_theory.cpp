#include "bench/study/slab_theory.h"

#include <cmath>

namespace molten::study {

double TwoSlabs::Mode::at(double x) const {
  return x < 0 ? left * std::cos(left_wave * (x + 1)) : right * std::cos(right_wave * (1 - x));
}

/// What the flux into the contact lacks of that out of it, for amplitudes that agree there: 0 for a mode.
double TwoSlabs::mismatch(double rate) const {
  const double a = rate / left_, b = rate / right_;
  return left_ * std::sin(a) * std::cos(b) + right_ * std::sin(b) * std::cos(a);
}

TwoSlabs::Mode TwoSlabs::mode_of(double rate) const {
  Mode m{rate, rate / left_, rate / right_, std::cos(rate / right_), std::cos(rate / left_)};
  // The same from the fluxes, for modes that are 0 at the contact.
  const double left = right_ * std::sin(m.right_wave), right = -left_ * std::sin(m.left_wave);
  if (std::abs(left) + std::abs(right) > std::abs(m.left) + std::abs(m.right)) m.left = left, m.right = right;
  return m;
}

TwoSlabs::TwoSlabs(double left, double right, double time) : left_(std::sqrt(left)), right_(std::sqrt(right)) {
  const double fastest = std::sqrt(40 / time), step = 1e-3 * std::min(left_, right_);
  const auto root_between = [&](double low, double high) {
    for (int k = 0; k < 60; ++k) {
      const double middle = (low + high) / 2;
      (mismatch(low) * mismatch(middle) <= 0 ? high : low) = middle;
    }
    return low;
  };
  // ∫ cos² and ∫ cos over a slab
  const auto square = [](double wave) { return 0.5 + std::sin(2 * wave) / (4 * wave); };
  const auto mean = [](double wave) { return std::sin(wave) / wave; };
  for (double low = step / 2; low < fastest; low += step) {
    if (mismatch(low) * mismatch(low + step) > 0) continue;
    Mode m = mode_of(root_between(low, low + step));
    const double norm = m.left * m.left * square(m.left_wave) + m.right * m.right * square(m.right_wave);
    const double share = (m.right * mean(m.right_wave) - m.left * mean(m.left_wave)) / norm;
    m.left *= share, m.right *= share;
    modes_.push_back(m);
  }
}

double TwoSlabs::temperature(double x, double time) const {
  double sum = 0;  // the mean of all, which lasts
  for (const Mode& m : modes_) sum += m.at(x) * std::exp(-m.rate * m.rate * time);
  return sum;
}

}  // namespace molten::study
