// The steady flow in a square cavity with a sliding lid, by differences: what the particles are held against.
#pragma once

#include "bench/study/metrics.h"

namespace molten::study {

/// Velocities on the centre lines of the cavity [0, 1]² whose lid at y = 1 slides with speed 1.
struct CentreLines {
  Series u;  // along x, over y at x = ½
  Series v;  // along y, over x at y = ½
};

/// Stream function and vorticity, second-order central differences with Jensen's vorticity at the walls, by Newton's
/// method on grids of `cells` and 2 `cells` a side, extrapolated (Richardson). `cells` is even.
CentreLines cavity_flow(double reynolds, int cells);

}  // namespace molten::study
