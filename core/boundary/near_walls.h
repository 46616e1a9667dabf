// The particles that walls may concern. Most are far from any, so runs of slots are asked for first: particles that
// follow one another are near each other.
#pragma once

#include <algorithm>

#include "core/boundary/contact.h"
#include "core/particle_pass.h"
#include "core/particles.h"

namespace molten {

/// Calls f(slot, x) in parallel for the particles from `first_slot` on that a wall may be within `reach` (m) of, and
/// for some more; those of a cluster on one thread.
template <int Dim, class Real, class F>
void for_each_near_walls(const Particles<Dim, Real>& particles, const Contact<Dim>& contact, std::size_t first_slot,
                         double reach, F&& f) {
  constexpr std::size_t run = 8 * cluster_size;
  const auto x = particles[position];
  const std::size_t last = particles.slots();
  const auto point = [&](std::size_t slot) {
    Point<Dim> at;
    for (int d = 0; d < Dim; ++d) at[d] = x[d][slot];
    return at;
  };
  for_each_slot((last - first_slot + run - 1) / run, [&](std::size_t k) {
    const std::size_t begin = first_slot + k * run, end = std::min(begin + run, last);
    Point<Dim> lower = Point<Dim>::Constant(HUGE_VAL), upper = -lower;
    for (std::size_t slot = begin; slot < end; ++slot) {
      if (particles.is_padding(slot)) continue;
      lower = lower.cwiseMin(point(slot));
      upper = upper.cwiseMax(point(slot));
    }
    if (!(lower[0] <= upper[0]) || !contact.may_touch_in(lower, upper, reach)) return;
    for (std::size_t slot = begin; slot < end; ++slot)
      if (!particles.is_padding(slot)) f(slot, point(slot));
  });
}

}  // namespace molten
