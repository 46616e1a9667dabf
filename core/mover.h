// How particles move: at what rate, and bouncing off walls where walls are near.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "core/cluster_motion.h"
#include "core/state.h"

namespace molten {

/// The rate of a particle's place beside its velocity: XSPH and shifting. T: double, or ClusterLanes for a cluster from
/// its first slot.
template <int Dim, class Real> class Drift {
 public:
  explicit Drift(const State<Dim, Real>& s)
      : shift_(s.particles[shift_velocity]),
        xsph_(s.particles[xsph_velocity]),
        strength_(s.features.xsph ? s.parameters.xsph : 0),
        overwrites_(s.parameters.xsph_form == Xsph::Form::velocity) {}

  /// From a velocity (m/s) to the rate of the place.
  template <class T> T rate(T v, int d, std::size_t slot) const {
    if (shift_[d]) v += read<T>(shift_[d] + slot);
    return with_xsph(v, d, slot);
  }
  /// The velocity with what XSPH adds to it itself, if the scene wants that (m/s).
  template <class T> T overwritten(T v, int d, std::size_t slot) const {
    return overwrites_ ? with_xsph(v, d, slot) : v;
  }

 private:
  template <class T> T with_xsph(T v, int d, std::size_t slot) const {
    if (strength_ != 0) v += T(strength_) * read<T>(xsph_[d] + slot);
    return v;
  }
  template <class T> static T read(const Real* from) {
    if constexpr (std::is_same_v<T, double>)
      return *from;
    else
      return load_double<cluster_size>(from);
  }

  Column<ShiftVelocity, Dim, Real> shift_;
  Column<XsphVelocity, Dim, Real> xsph_;
  double strength_;
  bool overwrites_;
};

template <int Dim, class Real> class Mover {
 public:
  explicit Mover(const State<Dim, Real>& s)
      : s_(s),
        contact_(s.features.contact),
        way_(longest_way() / s.parameters.spacing),
        part_(FreeWay::part_of(std::min(way_, FreeWay::longest))) {}

  /// Moves one particle by a step along its rate; says whether it bounced.
  bool move(std::size_t slot, Motion<Dim>& m) const {
    if (contact_ && may_bounce(slot)) return s_.contact.move(m, s_.clock.dt) > 0;
    m.position += s_.clock.dt * m.rate;
    return false;
  }

  /// May any of a cluster meet a wall in this step?
  bool may_collide(std::size_t cluster) const {
    return contact_ && (way_ > FreeWay::longest || s_.free_way.any_within(part_, cluster));
  }

  /// The same for all of a cluster: 1 for those that bounced, else 0. Padding, and what a vent or a wall moves, does
  /// not count. `kicks`: what bodies give to particles is added.
  ClusterLanes move_cluster(std::size_t cluster, ClusterMotion<Dim>& m, std::span<Kick<Dim>> kicks) const {
    const bool may_meet = may_collide(cluster);
    if (may_meet && way_ <= FreeWay::face_reach && !held_)
      if (const std::int32_t face = s_.free_way.face(cluster); face != FreeWay::no_face)
        if (const auto bounced = s_.contact.bounce_off(face, m, s_.clock.dt)) return *bounced;
    const Vec<Dim, ClusterLanes> before = m.position;
    m.position += ClusterLanes(s_.clock.dt) * m.rate;
    ClusterLanes bounced(0.0);
    if (!may_meet) return bounced;
    for (int n = 0; n < cluster_size; ++n)
      if (may_bounce(cluster * cluster_size + n)) set_lane(bounced, n, double(collide(before, m, n, kicks)));
    return bounced;
  }

 private:
  bool may_bounce(std::size_t slot) const {
    return (way_ > FreeWay::longest || s_.free_way.within(part_, slot)) && !s_.particles.is_padding(slot) &&
           !(inlet_ && inlet_[slot] >= 0) && !(held_ && held_[slot] > 0);
  }

  bool collide(const Vec<Dim, ClusterLanes>& before, ClusterMotion<Dim>& of, int n, std::span<Kick<Dim>> kicks) const {
    Motion<Dim> m;
    for (int d = 0; d < Dim; ++d) {
      m.position[d] = lane(before[d], n);
      m.velocity[d] = lane(of.velocity[d], n);
      m.rate[d] = lane(of.rate[d], n);
    }
    const bool bounced = s_.contact.move(m, s_.clock.dt, kicks) > 0;
    for (int d = 0; d < Dim; ++d) {
      set_lane(of.position[d], n, m.position[d]);
      set_lane(of.velocity[d], n, m.velocity[d]);
    }
    return bounced;
  }

  /// No particle gets further from where it was sorted than this (m), and no body nearer to it.
  double longest_way() const {
    const double flow = std::sqrt(s_.extremes.speed2), dt = s_.clock.dt;
    const double fastest = (s_.features.shifting ? 1.5 : 1) * flow + dt * std::sqrt(s_.extremes.acceleration2) +
                           std::abs(s_.parameters.xsph) * std::sqrt(s_.extremes.xsph2);
    return s_.neighbours.displacement() + 2 * fastest * dt + s_.bodies.way();
  }

  const State<Dim, Real>& s_;
  bool contact_;
  double way_;         // spacings; no particle gets further from where it was sorted by the end of this step
  std::uint8_t part_;  // the same for the free ways
  const std::int64_t* inlet_ = s_.particles[inlet][0];  // null without vents
  const Real* held_ = s_.particles[held][0];            // null without boundary particles
};

}  // namespace molten
