// The clusters that walls may concern. Most are far from any, so runs of them are asked for first: particles that
// follow one another are near each other. And what those of a cluster share.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/boundary/contact.h"
#include "core/free_way.h"
#include "core/particle_pass.h"
#include "core/particles.h"

namespace molten {

/// Calls f(slot, x) for the particles of slots begin..end.
template <int Dim, class Real, class F>
void for_each_place(const Particles<Dim, Real>& particles, std::size_t begin, std::size_t end, F&& f) {
  const auto x = particles[position];
  for (std::size_t slot = begin; slot < end; ++slot) {
    if (particles.is_padding(slot)) continue;
    Point<Dim> at;
    for (int d = 0; d < Dim; ++d) at[d] = x[d][slot];
    f(slot, at);
  }
}

/// The box around particles: lower > upper where there are none.
template <int Dim> struct PlacesBox {
  Point<Dim> lower = Point<Dim>::Constant(HUGE_VAL), upper = -lower;  // m

  template <class Real> PlacesBox(const Particles<Dim, Real>& particles, std::size_t begin, std::size_t end) {
    for_each_place(particles, begin, end, [&](std::size_t, const Point<Dim>& x) {
      lower = lower.cwiseMin(x);
      upper = upper.cwiseMax(x);
    });
  }
  bool empty() const { return !(lower[0] <= upper[0]); }
};

/// Calls f(cluster) in parallel for the clusters from `first_slot` on that a wall may be within `reach` (m) of, and for
/// some more.
template <int Dim, class Real, class F>
void for_each_near_walls(const Particles<Dim, Real>& particles, const Contact<Dim>& contact, std::size_t first_slot,
                         double reach, F&& f) {
  constexpr std::size_t run = 8 * cluster_size;
  const std::size_t last = particles.slots();
  for_each_slot((last - first_slot + run - 1) / run, [&](std::size_t k) {
    const std::size_t begin = first_slot + k * run, end = std::min(begin + run, last);
    const PlacesBox<Dim> box(particles, begin, end);
    if (box.empty() || !contact.may_touch_in(box.lower, box.upper, reach)) return;
    for (std::size_t cluster = begin / cluster_size; cluster < end / cluster_size; ++cluster) f(cluster);
  });
}

/// The face that is all that any of a whole cluster's particles can meet.
class OneFace {
 public:
  static constexpr std::int32_t any = -2;  // of a particle that can meet none

  void add(std::int32_t face) {
    ++count_;
    if (face == any) return;
    alone_ &= face_ == any || face_ == face;
    face_ = face;
  }
  std::int32_t of_all() const { return alone_ && face_ >= 0 && count_ == cluster_size ? face_ : FreeWay::no_face; }

 private:
  std::int32_t face_ = any;
  bool alone_ = true;
  int count_ = 0;
};

}  // namespace molten
