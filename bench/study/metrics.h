// Measures of error that several cases share.
#pragma once

#include <functional>
#include <vector>

#include "bench/study/simulation.h"

namespace molten::study {

/// A quantity over time, or over place; abscissas rise.
struct Series {
  std::vector<double> at, value;

  void add(double a, double v) { at.push_back(a), value.push_back(v); }
  bool empty() const { return at.empty(); }
  /// Linear in between; the end values beyond the ends.
  double operator()(double a) const;
  /// The first abscissa at which the values reach `level` from below; infinite if they never do.
  double first_reaches(double level) const;
  Series scaled(double at_factor, double value_factor) const;
  /// The part with abscissas in [from, to].
  Series between(double from, double to) const;
};

/// √(mean (run(t − shift)/reference(t) − 1)²) over the reference's points.
double relative_rms(const Series& run, const Series& reference, double shift = 0);
/// Mean of |run(t) − reference(t)| over the mean of |reference|.
double mean_deviation(const Series& run, const Series& reference);
/// The shift in [−most, most] with the least error: by how much an experiment lags, as gates take time to open.
double best_shift(double most, const std::function<double(double shift)>& error);

/// Σ|value − exact| / Σ|exact| and √(Σ(value − exact)² / Σ exact²) over particles.
class FieldError {
 public:
  void add(double value, double exact);
  double l1() const { return difference1_ / exact1_; }
  double l2() const;

 private:
  double difference1_ = 0, exact1_ = 0, difference2_ = 0, exact2_ = 0;
};

/// Depth of fluid (m) over the rectangle (2-D: interval) of ±half (m) about a place: its volume over its area, as a
/// wire that is wet in part measures. A particle counts as a cube as far as it lies over the rectangle: by centres,
/// three rows of a lattice would count where there is room for two.
double depth_at(const Cloud& cloud, int dimensions, const Triple& place, const Triple& half);

/// A quantity of the particles (by their place in the cloud) at a point: moving least squares of second order over a
/// kernel's support, of a lower one where particles do not span it; 0 where there are none.
double value_at(const Cloud& cloud, int dimensions, const Triple& point, const std::function<double(std::size_t)>& of);

/// Pressure (Pa) at a point, by Shepard's mean over a kernel's support; 0 where there is hardly any fluid.
double pressure_at(const Cloud& cloud, int dimensions, const Triple& point);

/// A pressure sensor in a wall of a box of fluid, m. It feels the force of the fluid on the wall over its area:
/// Σ V p W over the part of the kernel that lies in the box. What is dry counts as without pressure there, so that a
/// drop that touches the wall isn't taken for a wall of water; the sum over the wall is what the fluid's momentum loses
/// to a wall with support (core/boundary/wall_terms.h).
class WallSensor {
 public:
  WallSensor(const Triple& place, const Triple& lower, const Triple& upper)
      : place_(place), lower_(lower), upper_(upper) {}
  double pressure(const Cloud& cloud, int dimensions);  // Pa

 private:
  double part_inside(double smoothing_length, int dimensions) const;

  Triple place_, lower_, upper_;
  double smoothing_length_ = 0, part_ = 0;  // the part of the kernel inside, for the smoothing length asked last
};

/// Kinetic energy (J; 2-D: J/m).
double kinetic_energy(const Cloud& cloud);

/// The part of the particles whose nearest neighbour is nearer than half a spacing.
double clumped_part(const Cloud& cloud, int dimensions);

}  // namespace molten::study
