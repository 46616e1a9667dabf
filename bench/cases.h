// The states that benchmarks run on, and the naive check that each passes before it is timed. (The moving dam break is
// in dam_break.h.)
#pragma once

#include <string>
#include <vector>

#include "core/scene.h"
#include "core/state.h"

namespace molten::bench {

/// A run of a scene as it starts.
template <int Dim, class Real> State<Dim, Real> state_of(const Scene& scene, const Start& start);

/// What a run has come to, by particle: another run can go on from there.
struct Moment {
  Start start;
  std::vector<double> compression;
};
template <int Dim, class Real> Moment moment_of(const State<Dim, Real>& s);
template <int Dim, class Real> State<Dim, Real> state_of(const Scene& scene, const Moment& moment);

/// A tank three times as long as the block of water in it; h = `smoothing_ratio` spacings.
Scene tank(int dimensions, double smoothing_ratio);

/// A block of about `count` particles in that tank or another scene, each moved at random by up to a tenth of the
/// spacing, in random slow motion.
template <int Dim, class Real> State<Dim, Real> block_in(const Scene& scene, long long count);

/// The block of water in the tank, c = 10 √(2 g H).
template <int Dim, class Real> State<Dim, Real> jittered_block(long long count, double smoothing_ratio);

/// The same with every column that a term reads: temperatures, viscosities, stresses and compressions at random.
template <int Dim, class Real> State<Dim, Real> full_block(long long count, double smoothing_ratio);

/// scenes/bunny.toml as it starts.
template <class Real> State<3, Real> bunny();

/// Finds the rates and compares those of some particles with the naive twin; returns an empty string or what differs.
template <int Dim, class Real> std::string check_rates(State<Dim, Real>& s);

}  // namespace molten::bench
