// The cell grid that orders the particles: columns of 2 spacings across, running along the last axis (3-D:
// columns along z; 2-D: strips along y), cut along that axis into segments whose middles are the origins that local
// positions refer to.
#pragma once

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

  std::array<double, Dim> lower{}, width{};  // m; of a column across, of a segment along
  std::array<std::int32_t, Dim> cells{};
  double quantum = 0;  // m; local positions and shifts are its multiples, so their sums and differences are exact
  std::array<bool, Dim> periodic{};

  std::int32_t index(int d, double x) const {
    const double k = std::floor((x - lower[d]) / width[d]);
    if (!(k > 0)) return 0;  // not a number, too
    return k >= cells[d] ? cells[d] - 1 : static_cast<std::int32_t>(k);
  }
  std::size_t columns() const {
    std::size_t n = 1;
    for (int d = 0; d < along; ++d) n *= static_cast<std::size_t>(cells[d]);
    return n;
  }
  /// Number of the column of a cell; x fastest.
  template <class C> std::size_t column(const C& cell) const {
    std::size_t n = 0;
    for (int d = along - 1; d >= 0; --d) n = n * cells[d] + cell[d];
    return n;
  }
  double origin(int d, std::int32_t cell) const { return lower[d] + (cell + 0.5) * width[d]; }

  /// Rounds to the quantum.
  template <class T> T on_quantum(const T& x) const {
    const T magic(6755399441055744.0 * quantum);  // 1.5 · 2⁵²: adding it leaves multiples of the quantum
    return (x + magic) - magic;
  }
  /// Where a cell `offset` cells further along axis d has its origin (m).
  double shift(int d, int offset) const { return on_quantum(offset * width[d]); }
};

}  // namespace molten
