// How messages name a place.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "core/boundary/point.h"

namespace molten {

/// Such as "(0.1, 0, 2) m"; what is round-off beside the other coordinates is 0.
template <int Dim> std::string in_metres(const Point<Dim>& x) {
  const auto shown = [&](double c) { return std::abs(c) < 1e-12 * x.norm() ? 0.0 : c; };
  return Dim == 3 ? fmt::format("({:.6g}, {:.6g}, {:.6g}) m", shown(x[0]), shown(x[1]), shown(x[Dim - 1]))
                  : fmt::format("({:.6g}, {:.6g}) m", shown(x[0]), shown(x[1]));
}

}  // namespace molten
