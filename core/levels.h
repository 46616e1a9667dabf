// Time steps by region, where the viscosity varies: a stiff crust on hot lava. The largest stable step of a cluster's
// viscous forces goes as 1/ν. Steps may exceed the smallest one by 2^N; the clusters that it is too long for, by up to
// 2, 4, 8 … times, are at levels 1, 2, 3 …, the others at level 0. All else is evaluated once a step; the viscous
// forces of pairs with a cluster above level 0, in stages within it: both particles of a pair across levels feel it at
// the finer one, as one impulse, so that momentum is conserved to round-off.
//
// The stages are those of the Runge-Kutta-Legendre method of first order (RKL1: Meyer, Balsara and Aslam 2012, MNRAS
// 422, 2102), with the viscosities, densities and places of the step's start, so that the forces are linear in the
// velocities Y: with τ the time for which the accelerations a act,
//   Y_j = μ_j Y_{j−1} + (1 − μ_j) Y_{j−2} + μ_j w τ a(Y_{j−1}), μ_j = (2j − 1)/j, w = 2/(s² + s).
// s of them are stable for τ up to (s² + s)/λ, λ the fastest damping, s steps of Euler's method for 2 s/λ: so they are
// as many as √(2^level), not 2^level. The integrator gets the mean acceleration (Y_s − Y_0)/τ and knows nothing of
// them. What is summed is how the stages differ from the acceleration a at the step's start, e_j = Y_j − Y_0 − c_j τ a,
// so that a particle without such pairs keeps that bit for bit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/cluster_list.h"

namespace molten {

inline constexpr int most_levels = 16;

struct Levels {
  std::array<std::int64_t, most_levels + 1> particles{};  // by level, of the last step
  int stages = 0;                                         // of the last step; 0: all was at level 0

  // While there are stages:
  std::vector<std::uint8_t> of;             // level by cluster
  std::vector<PartialChunk> stiff, beside;  // by chunk: the clusters above level 0; those at level 0 that meet them

  std::size_t bytes() const;
};

}  // namespace molten
