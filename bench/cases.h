// The states that benchmarks run on, and the naive check that each passes before it is timed. (The moving dam break is
// in dam_break.h.)
#pragma once

#include <string>

#include "core/state.h"

namespace molten::bench {

/// A block of water of about `count` particles, each moved at random by up to a tenth of the spacing, in random slow
/// motion, in a tank three times as long; h = `smoothing_ratio` spacings, c = 10 √(2 g H).
template <int Dim, class Real> State<Dim, Real> jittered_block(long long count, double smoothing_ratio);

/// scenes/bunny.toml as it starts, or a ball of as many particles where the model was not fetched.
template <class Real> State<3, Real> bunny();

/// Finds the rates and compares those of some particles with the naive twin; returns an empty string or what differs.
template <int Dim, class Real> std::string check_rates(State<Dim, Real>& s);

}  // namespace molten::bench
