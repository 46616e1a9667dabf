// Particles for a case to start from.
#pragma once

#include <cmath>
#include <functional>
#include <random>

#include "bench/study/simulation.h"

namespace molten::study {

/// A lattice that fills the box from `lower` to `upper` (m); the box is a whole number of spacings along each axis.
inline Start lattice(int dimensions, const Triple& lower, const Triple& upper, double spacing) {
  Start start;
  start.spacing = spacing;
  std::array<long, 3> cells{1, 1, 1};
  for (int d = 0; d < dimensions; ++d) cells[d] = std::lround((upper[d] - lower[d]) / spacing);
  for (long k = 0; k < cells[2]; ++k)
    for (long j = 0; j < cells[1]; ++j)
      for (long i = 0; i < cells[0]; ++i)
        start.position.push_back({lower[0] + (i + 0.5) * spacing, lower[1] + (j + 0.5) * spacing,
                                  dimensions == 3 ? lower[2] + (k + 0.5) * spacing : 0.0});
  start.velocity.assign(start.position.size(), Triple{});
  start.measure = static_cast<double>(start.position.size()) * std::pow(spacing, dimensions);
  return start;
}

/// Moves every particle by a random way of at most half `width` (spacings) along each axis; the same ways every time.
inline void perturb(Start& start, int dimensions, double width) {
  std::mt19937_64 random(1);
  for (Triple& x : start.position)
    for (int d = 0; d < dimensions; ++d)
      x[d] += width * start.spacing * (static_cast<double>(random() >> 11U) * 0x1p-53 - 0.5);
}

/// Moves the slices of a lattice across y along x, by at most half `width` (spacings) and each by another way, so that
/// they do not arrive anywhere together.
inline void stagger(Start& start, double width) {
  constexpr double golden = 0.6180339887498949;  // parts of its multiples are spread evenly, also over a few slices
  for (Triple& x : start.position) {
    const double turns = std::floor(x[1] / start.spacing) * golden;
    x[0] += width * start.spacing * (turns - std::floor(turns) - 0.5);
  }
}

/// Gives every particle the velocity (m/s) of its place.
inline void set_velocity(Start& start, const std::function<Triple(const Triple&)>& of) {
  for (std::size_t k = 0; k < start.position.size(); ++k) start.velocity[k] = of(start.position[k]);
}

}  // namespace molten::study
