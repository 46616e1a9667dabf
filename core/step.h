// START HERE: one time step.
#pragma once

#include "core/state.h"

namespace molten {

/// Advances the run by one step: at most to clock.stop.
template <int Dim, class Real> void step(State<Dim, Real>& s);

// ---- what a step is made of, in its order ---------------------------------------------------------------------------

/// Sorts the particles and lists their neighbours anew; marks the clusters near walls.
template <int Dim, class Real> void sort_and_list(State<Dim, Real>& s);
template <int Dim, class Real> void mark_near_wall(State<Dim, Real>& s);

/// Lets a vent's next layer of particles in when there is room for it; puts the first ones in at the start of a run.
template <int Dim, class Real> void emit(State<Dim, Real>& s);
template <int Dim, class Real> void open_vents(State<Dim, Real>& s);

/// Strain rate → viscosity and stress ([P] alg. 3, lines 3-6). Only where the viscosity varies.
template <int Dim, class Real> void find_viscosity(State<Dim, Real>& s);

/// Rates of compression, velocity and temperature ([P] alg. 3, lines 7-11), and the extremes that bound the time step.
template <int Dim, class Real> void find_rates(State<Dim, Real>& s);

/// Throws Error(diverged), naming the particle, the field and the likely cause, if the rates are not finite or the run
/// blew up. The state is still that before the step.
template <int Dim, class Real> void require_sane(const State<Dim, Real>& s);

/// The largest stable time step and what limits it (physics: [P] 6-17 with a coefficient for each limit).
template <int Dim, class Real> void choose_time_step(State<Dim, Real>& s);

/// Moves the particles and bodies, bouncing the particles off walls ([P] alg. 3, lines 12-16); prepares what the next
/// passes read.
template <int Dim, class Real> void integrate_and_collide(State<Dim, Real>& s);

/// Temperature and pressure columns that passes read, from the state; for the start of a run.
template <int Dim, class Real> void prepare(State<Dim, Real>& s);

}  // namespace molten
