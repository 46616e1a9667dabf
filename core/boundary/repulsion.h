// The force of repulsive boundary particles (Monaghan and Kos 1999; SPHysics 2.2; [D] 4.5.1). A particle in front of
// the boundary particle b, at the height ψ along its normal and ξ aside, is accelerated by n R(ψ) P(ξ) ε:
//   R = A (1 − q)/√q for q = ψ/2h < 1, A = (0.01 c²/β² − (c u⊥/β where u⊥ > 0))/h, β = c0/(10 √(gH)),
//   P = ½ (1 + cos πξ/Δb) within Δb, the distance to the next boundary particle, so that a row's sum is 1; in 3-D for
//   both tangents,
//   ε = ε_u + ε_z: ε_u = min(1, 40 |u⊥|/c0) for a particle that approaches; ε_z = 1 at the bottom (2 % of H), 0.02
//   for a particle above the still water, else 0.02 + |1 − z_b/H|.
// u⊥ is the velocity along the normal, c the particle's sound speed, H the depth of the still water above the lowest
// boundary particle.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/boundary/boundary_particles.h"
#include "core/parameters.h"
#include "core/particles.h"
#include "core/simd.h"

namespace molten {

/// Still water: its surface and the lowest boundary particle, as −g·x.
struct StillWater {
  double surface = 0, bottom = 0;  // m²/s²
};

template <int Dim> class Repulsion {
 public:
  Repulsion() = default;
  /// Throws Error(usage) without gravity or without water above the lowest point.
  Repulsion(std::vector<RepulsivePoint<Dim>> points, const Parameters<Dim>& parameters, const StillWater& water);

  bool empty() const { return points_.empty(); }
  std::size_t count() const { return points_.size(); }
  std::size_t bytes() const {
    return points_.capacity() * sizeof(RepulsivePoint<Dim>) + begin_.capacity() * sizeof(std::uint32_t);
  }

  /// What the boundary particles accelerate a fluid particle by (m/s²).
  Point<Dim> acceleration(const Point<Dim>& x, const Point<Dim>& v, double compression) const;

 private:
  double strength(const RepulsivePoint<Dim>& b, const Point<Dim>& way, double normal_speed, double sound_speed,
                  double height) const;
  double height(const Point<Dim>& x) const;
  std::array<std::int64_t, Dim> cell_of(const Point<Dim>& x) const;
  template <class F> void for_each_near(const Point<Dim>& x, F&& f) const;

  std::vector<RepulsivePoint<Dim>> points_;  // by cell
  std::vector<std::uint32_t> begin_;         // by cell, of the points in it
  Point<Dim> lower_ = Point<Dim>::Zero();    // m
  std::array<std::int64_t, Dim> cells_{};
  double width_ = 1;  // m, of a cell: no point reaches further
  EquationOfState eos_;
  Point<Dim> down_ = Point<Dim>::Zero();     // m/s²
  double smoothing_length_ = 0, depth_ = 0;  // m
  double bottom_ = 0, fall_speed_ = 0;       // m²/s²; √(gH), m/s
};

/// A finish of a pair pass that adds the repulsion first.
template <int Dim, class Real, class Finish> class WithRepulsion {
 public:
  WithRepulsion(const Repulsion<Dim>& repulsion, const Particles<Dim, Real>& particles, const Finish& finish)
      : repulsion_(repulsion), particles_(particles), finish_(finish) {}

  auto for_chunk(std::size_t number) const {
    return [this, inner = finish_.for_chunk(number)](std::size_t slot, const auto& sums) mutable {
      if (repulsion_.empty()) return inner(slot, sums);
      auto with = sums;
      add_to(with[Acceleration{}], slot);
      inner(slot, with);
    };
  }

 private:
  template <class L> void add_to(Vec<Dim, L>& acceleration, std::size_t first) const {
    const auto x = particles_[position];
    const auto v = particles_[velocity];
    for (int n = 0; n < static_cast<int>(sizeof(L) / sizeof(Real)); ++n) {
      const std::size_t slot = first + n;
      if (particles_.is_padding(slot)) continue;
      Point<Dim> place, speed;
      for (int d = 0; d < Dim; ++d) place[d] = x[d][slot], speed[d] = v[d][slot];
      const Point<Dim> a = repulsion_.acceleration(place, speed, particles_[compression][0][slot]);
      for (int d = 0; d < Dim; ++d) set_lane(acceleration[d], n, lane(acceleration[d], n) + static_cast<Real>(a[d]));
    }
  }

  const Repulsion<Dim>& repulsion_;
  const Particles<Dim, Real>& particles_;
  const Finish& finish_;
};

}  // namespace molten
