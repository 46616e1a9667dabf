// The cell grid that orders the particles: columns of 2 spacings across, running along the last axis (3-D:
// columns along z; 2-D: strips along y), cut along that axis into segments whose middles are the origins that local
// positions refer to.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/archive.h"
#include "core/vec.h"

namespace molten {

/// A periodic axis repeats every `period` m from `lower`; period 0: not periodic.
template <int Dim> struct Periodicity {
  std::array<double, Dim> lower{}, period{};

  bool along(int d) const { return period[d] > 0; }
  double wrapped(int d, double x) const {
    if (!along(d)) return x;
    const double y = x - period[d] * std::floor((x - lower[d]) / period[d]);
    return y < lower[d] + period[d] ? y : lower[d];
  }
};

template <int Dim> using Cell = std::array<std::int32_t, Dim>;  // column indices, then the segment

template <int Dim> struct Grid {
  static constexpr int along = Dim - 1;  // the axis of the columns
  /// Columns across a strip of them: three rows of one, which is what a row's particles meet, stay in a core's cache.
  static constexpr std::size_t strip_width = 6;

  std::array<double, Dim> lower{}, width{};  // m; of a column across, of a segment along
  std::array<std::int32_t, Dim> cells{};
  double quantum = 0;  // m; local positions and shifts are its multiples, so their sums and differences are exact
  std::array<bool, Dim> periodic{};

  std::int32_t index(int d, double x) const {
    const double k = std::floor((x - lower[d]) / width[d]);
    if (!(k > 0)) return 0;  // not a number, too
    return k >= cells[d] ? cells[d] - 1 : static_cast<std::int32_t>(k);
  }
  std::size_t columns() const { return static_cast<std::size_t>(cells[0]) * rows(); }
  /// Number of the column of a cell: strip after strip, in each row after row, x fastest.
  std::size_t column(const Cell<Dim>& cell) const {
    const std::size_t x = static_cast<std::size_t>(cell[0]), first = x / strip_width * strip_width;
    std::size_t row = 0;
    if constexpr (along > 1) row = static_cast<std::size_t>(cell[1]);
    return first * rows() + row * across_strip(first) + (x - first);
  }
  /// Puts where column n is into a cell, whose segment it leaves.
  void place(std::size_t n, Cell<Dim>& cell) const {
    const std::size_t first = n / (strip_width * rows()) * strip_width, rest = n - first * rows();
    cell[0] = static_cast<std::int32_t>(first + rest % across_strip(first));
    if constexpr (along > 1) cell[1] = static_cast<std::int32_t>(rest / across_strip(first));
  }
  double origin(int d, std::int32_t cell) const { return lower[d] + (cell + 0.5) * width[d]; }

  /// Rounds to the quantum.
  template <class T> T on_quantum(const T& x) const {
    const T magic(6755399441055744.0 * quantum);  // 1.5 · 2⁵²: adding it leaves multiples of the quantum
    return (x + magic) - magic;
  }
  /// Where a cell `offset` cells further along axis d has its origin (m).
  double shift(int d, int offset) const { return on_quantum(offset * width[d]); }

 private:
  std::size_t rows() const { return along > 1 ? static_cast<std::size_t>(cells[along - 1]) : 1; }
  /// Columns across the strip that begins with this one; the last may be narrower.
  std::size_t across_strip(std::size_t first) const {
    return std::min(strip_width, static_cast<std::size_t>(cells[0]) - first);
  }
};

}  // namespace molten
