// The exact motion of an elliptic drop in its own pressure (Monaghan 1994): v = (A x, −A y).
#pragma once

namespace molten::study {

struct Ellipse {
  double a = 1, b = 1;  // semi-axes along x and y
  double stretch = 0;   // A
};

/// From the disc a = b = 1 with A = `stretch`.
Ellipse ellipse_at(double time, double stretch);

}  // namespace molten::study
