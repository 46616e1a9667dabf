// The moving dam break that whole steps are timed in: the column of scenes/dam-break-2d.toml and -3d.toml (h = a given
// number of spacings, c = 10 √(2 g H), Courant number 0.2, α = 0.1) as it is at t = ½ √(H/g).
//
// Running millions of particles up to there takes an hour, so only a coarse column (10 000 particles in 2-D, 100 000 in
// 3-D) is run from rest. A finer one starts from it: the coarse particles' displacements, velocities and compressions,
// smoothed over neighbours, are interpolated on the lattice that the column starts as, so that the fine particles have
// the coarse run's free surface, strain and speeds at their own spacing; then it takes 200 steps of its own before it
// is timed. (Against the same column run from rest, 99 238 particles refined tenfold like this have the same number of
// neighbours within 0.1 % and take the same time a step within 1 %; their lists last 5 to 10 % less long.)
//
// What is prepared is kept in states/ beside the program (or the folder that MOLTEN_BENCH_STATES names), independent of
// how the solver stores particles, so that two builds can start from the same bits.
#pragma once

#include "core/scene.h"
#include "core/state.h"

namespace molten::bench {

template <int Dim> Scene dam_break_scene(long long count, double smoothing_ratio);

/// About `count` particles, h = `smoothing_ratio` spacings.
template <int Dim, class Real> State<Dim, Real> moving_dam_break(long long count, double smoothing_ratio);

}  // namespace molten::bench
