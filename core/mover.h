// Moves particles, bouncing them off walls, where walls are near.
#pragma once

#include <cmath>
#include <span>

#include "core/state.h"

namespace molten {

template <int Dim, class Real> class Mover {
 public:
  explicit Mover(const State<Dim, Real>& s)
      : s_(s), always_collide_(s.features.contact && longest_way() > s.parameters.spacing) {}

  /// Moves one particle by a step along its rate; says whether it bounced. `kicks`: what bodies give to it is added.
  bool move(std::size_t slot, Motion<Dim>& m, std::span<Kick<Dim>> kicks = {}) const {
    if (always_collide_ || s_.near_wall[slot / cluster_size]) return s_.contact.move(m, s_.clock.dt, kicks) > 0;
    m.position += s_.clock.dt * m.rate;
    return false;
  }

 private:
  /// No particle gets further from where it was sorted than this (m), and no body nearer to it.
  double longest_way() const {
    const double flow = std::sqrt(s_.extremes.speed2), dt = s_.clock.dt;
    const double fastest = (s_.features.shifting ? 1.5 : 1) * flow + dt * std::sqrt(s_.extremes.acceleration2) +
                           std::abs(s_.parameters.xsph) * std::sqrt(s_.extremes.xsph2);
    return s_.neighbours.displacement() + 2 * fastest * dt + s_.bodies.way();
  }

  const State<Dim, Real>& s_;
  bool always_collide_;
};

}  // namespace molten
