// What insulating walls hide of the neighbourhoods of particles beside them. The fluid behind such a wall would be its
// mirror image: no heat passes, and along the wall it conducts as the fluid does. With h = ∫_solid W dV behind them,
// pairs conduct (f_i + f_j)/2 times as much, f = 1/(1 − h): over a layer along a wall that adds up to what the whole
// neighbourhoods would conduct, and what i takes j gives. (f_i in its place, as Ferrand et al. 2013 have it, loses a
// fifth of the heat of a row at a wall while that spreads.) Walls with a temperature, also behind a layer, hide
// nothing: their own flux makes the sum exact for linear temperatures, which factors beside them would spoil.
// Where one that hides g meets them, f² = (1 − g)/((1 − h)(1 − h − g)): at a right angle that is what f is far from the
// corner, as each wall's part of the solid there, a cone, lacks half of what both hide.
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/fields.h"

namespace molten {

/// The most that may be hidden, as in a cleft that hardly leaves room to the fluid.
inline constexpr double most_hidden = 0.9;

/// Parts of ∫ W dV.
struct HiddenFromHeat {
  double insulated = 0;  // behind walls without a temperature
  double heated = 0;     // behind the others
};

/// f of one particle.
inline double heat_completion_at(const HiddenFromHeat& hidden) {
  const double h = std::clamp(hidden.insulated, 0.0, most_hidden), g = std::clamp(hidden.heated, 0.0, most_hidden - h);
  return std::sqrt((1 - g) / ((1 - h) * (1 - h - g)));
}

/// (f_i + f_j)/2
template <class I, class J> [[gnu::always_inline]] inline auto heat_completion_of(const I& i, const J& j) {
  using L = std::decay_t<decltype(i[heat_completion])>;
  return L(0.5) * (i[heat_completion] + j[heat_completion]);
}

}  // namespace molten
