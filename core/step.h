// START HERE: one time step.
#pragma once

#include "core/state.h"

namespace molten {

/// Advances the run by one step: at most to clock.stop.
template <int Dim, class Real> void step(State<Dim, Real>& s);

/// All rates where the particles are now, sorted and listed anew if that is due.
template <int Dim, class Real> void find_all_rates(State<Dim, Real>& s);

// ---- what a step is made of, in its order ---------------------------------------------------------------------------

/// Sorts the particles and lists their neighbours anew, if they have moved far enough since.
template <int Dim, class Real> void list_if_due(State<Dim, Real>& s);

/// Sorts the particles and lists their neighbours anew.
template <int Dim, class Real> void sort_and_list(State<Dim, Real>& s);

/// How far each particle may go before it meets a wall, and which clusters walls support; of those awake.
template <int Dim, class Real> void look_for_walls(State<Dim, Real>& s);

/// Replaces the density by its weighted mean; every so many steps, where the scene asks for it.
template <int Dim, class Real> void filter_density(State<Dim, Real>& s);

/// Density from the particles' places, where the scene wants it so.
template <int Dim, class Real> void sum_density(State<Dim, Real>& s);

/// The kernel-gradient correction and the velocity of shifting. Only where the scene asks for corrected gradients.
template <int Dim, class Real> void find_corrections(State<Dim, Real>& s);

/// What makes the weights of Laplacians exact for quadratic fields. Only where the scene asks for it.
template <int Dim, class Real> void find_laplacian_weights(State<Dim, Real>& s);

/// How far particles are from those that conduct differently. Only where bodies do.
template <int Dim, class Real> void find_interfaces(State<Dim, Real>& s);

/// What insulating walls hide of the particles' support. Only where heat meets walls with support.
template <int Dim, class Real> void find_heat_completions(State<Dim, Real>& s);

/// Lets a vent's next layer of particles in when there is room for it; puts the first ones in at the start of a run.
template <int Dim, class Real> void emit(State<Dim, Real>& s);
template <int Dim, class Real> void open_vents(State<Dim, Real>& s);

/// Strain rate → viscosity and stress ([P] alg. 3, lines 3-6). Only where the viscosity varies.
template <int Dim, class Real> void find_viscosity(State<Dim, Real>& s);

/// Rates of compression, velocity and temperature ([P] alg. 3, lines 7-11), and the extremes that bound the time step.
template <int Dim, class Real> void find_rates(State<Dim, Real>& s);

/// Throws Error(diverged), naming the particle, the field and the likely cause, if the rates are not finite or the run
/// blew up. The state is still that before the step, or at a stage of it.
template <int Dim, class Real> void require_sane(const State<Dim, Real>& s);

/// The largest stable time step and what limits it (physics: [P] 6-17 with a coefficient for each limit).
template <int Dim, class Real> void choose_time_step(State<Dim, Real>& s);

/// The largest time step (s) of forces of a kinematic viscosity (m²/s).
template <int Dim, class Real> double viscous_limit(const State<Dim, Real>& s, double kinematic_viscosity);

/// Where clusters are too stiff for the step: the mean of the accelerations over it, their viscous forces being taken
/// in stages (levels.h). Only where the scene asks for it.
template <int Dim, class Real> void take_stages(State<Dim, Real>& s);

/// For how long (s) the accelerations act on the velocities.
template <int Dim, class Real> double kick_time(const State<Dim, Real>& s);

/// Moves the particles and bodies, bouncing the particles off walls ([P] alg. 3, lines 12-16); prepares what the next
/// passes read.
template <int Dim, class Real> void integrate_and_collide(State<Dim, Real>& s);

/// Temperature and pressure columns that passes read, from the state, of the slots from `first_slot` on; for the start
/// of a run and after a sort.
template <int Dim, class Real> void prepare(State<Dim, Real>& s, std::size_t first_slot = 0);

}  // namespace molten
