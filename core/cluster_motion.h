// The particles of a cluster in motion, for arithmetic in double.
#pragma once

#include "core/particles.h"
#include "core/simd.h"
#include "core/vec.h"

namespace molten {

using ClusterLanes = Lanes<double, cluster_size>;

/// `rate` is what moves the position (velocity, or velocity + XSPH).
template <int Dim> struct ClusterMotion {
  Vec<Dim, ClusterLanes> position, velocity, rate;  // m, m/s, m/s
};

}  // namespace molten
