// Heat between two slabs in contact whose conductivities differ, as a series of modes.
#pragma once

#include <vector>

namespace molten::study {

/// Slabs from −1 to 0 and from 0 to 1, insulated at the far ends, at first −1 and 1 warm; density times heat capacity
/// is 1 in both (Carslaw & Jaeger 1959, §14.3).
class TwoSlabs {
 public:
  /// Conductivities of both; `time`: the earliest at which it is asked, which decides how many modes count.
  TwoSlabs(double left, double right, double time);

  double temperature(double x, double time) const;

 private:
  struct Mode {
    double rate = 0;                       // μ, at which it decays as exp(−μ² t)
    double left_wave = 0, right_wave = 0;  // μ/√k
    double left = 0, right = 0;            // amplitudes
    double at(double x) const;
  };
  /// That of a root μ; without its share in the start.
  Mode mode_of(double rate) const;
  double mismatch(double rate) const;

  double left_, right_;  // √k
  std::vector<Mode> modes_;
};

}  // namespace molten::study
