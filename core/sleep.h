// Sleep: regions where nothing moves or changes cost nothing. A particle is at rest once its speed and its rate of
// density have stayed within bounds for a while, and its heat is at rest once its rate of temperature has. Cells of
// about the list's reach are active if they, or cells next to them, hold a particle that is not at rest. Of the others,
// those that so have heat that is not at rest are warm: only heat is conducted there, as seldom as is stable. The rest
// are asleep: they keep their places in the sums of others, with velocity and rates zero; nothing is summed for them,
// and they are neither moved nor sorted.
//
// What may be missed: between a particle asleep and one not at rest lies at least the reach of a list, all of it awake.
// So one asleep is denied only the forces of neighbours at rest, and what would set it moving first moves those around
// it, which wakes it. A wall that moves wakes what it touches; a free body keeps it awake. Falling asleep takes at most
// ½ m v² of energy and m v of momentum from it, v being the bound on speed; its mean acceleration over the time at rest
// was below 2 v over that time. Where the viscosity varies, a warm particle wakes once its temperature has changed by a
// bound since it was last active. Heat is conserved between active and warm particles but for what temperatures change
// meanwhile; one asleep is denied heat at about the bound on the rate of temperature, since what would heat it faster
// first heats those around it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/archive.h"

namespace molten {

/// Bounds within which a particle is at rest.
struct RestBounds {
  double speed = 0;             // m/s
  double density_rate = 0;      // 1/s; rate of compression
  double temperature_rate = 0;  // K/s
  double temperature = 0;       // K; by which it may change while nothing moves, where the viscosity varies
  double after = 0;             // s at rest before it may sleep
};

/// What sleep keeps between steps.
struct Sleep {
  std::int64_t asleep = 0;  // particles that do not move; of them
  std::int64_t warm = 0;    // those whose heat is awake
  double taken_energy = 0;  // J (2-D: J per m); kinetic energy that falling asleep has taken so far
  double viscosity = 0;     // m²/s; largest kinematic viscosity among those asleep
  double travel = 0;        // m; how far sound has gone since the last look
  double waste = 0;         // particle-steps spent on particles that might sleep, since the last sort of all
  double warm_time = 0;     // s; for which warm particles have not been heated yet
  std::int64_t looked = 0;  // step of the last look
  std::vector<std::uint8_t> still, cold;  // by cell: somebody does not move there; is asleep, heat too

  void archive(Archive& a);
};

template <int Dim, class Real> struct State;

/// Looks, no more often than a disturbance needs to come near, who must wake and who may sleep. Wakes at once; puts to
/// sleep when what it has cost to keep them awake outweighs a sort of all.
template <int Dim, class Real> void wake_and_rest(State<Dim, Real>& s);

/// Sorts the active particles alone, or all where some have left the grid.
template <int Dim, class Real> void sort_active(State<Dim, Real>& s);

/// Conducts heat among warm particles, for as long as they have waited.
template <int Dim, class Real> void conduct_at_rest(State<Dim, Real>& s);

/// Marks the cells where particles sleep; for a state that was loaded.
template <int Dim, class Real> void mark_sleepers(State<Dim, Real>& s);

}  // namespace molten
