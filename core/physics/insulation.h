// What insulating walls hide of the neighbourhoods of particles beside them. The fluid behind such a wall would be its
// mirror image: no heat passes, and along the wall it conducts as the fluid does. With h = ∫_solid W dV behind them,
// pairs conduct (f_i + f_j)/2 times as much, f = 1/(1 − h): over a layer along a wall that adds up to what the whole
// neighbourhoods would conduct, and what i takes j gives. (f_i in its place, as Ferrand et al. 2013 have it, loses a
// fifth of the heat of a row at a wall while that spreads.) Walls with a temperature, also behind a layer, hide
// nothing: their own flux makes the sum exact for linear temperatures, which factors beside them would spoil.
#pragma once

#include <algorithm>
#include <type_traits>

#include "core/fields.h"

namespace molten {

/// The most that may be hidden, as in a cleft that hardly leaves room to the fluid.
inline constexpr double most_hidden = 0.9;

/// f of one particle.
inline double heat_completion_at(double hidden) { return 1 / (1 - std::clamp(hidden, 0.0, most_hidden)); }

/// (f_i + f_j)/2
template <class I, class J> [[gnu::always_inline]] inline auto heat_completion_of(const I& i, const J& j) {
  using L = std::decay_t<decltype(i[heat_completion])>;
  return L(0.5) * (i[heat_completion] + j[heat_completion]);
}

}  // namespace molten
