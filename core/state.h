// What a run owns. No globals, no singletons: everything a step touches hangs here.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/bodies.h"
#include "core/boundary/boundary_particles.h"
#include "core/boundary/contact.h"
#include "core/boundary/repulsion.h"
#include "core/boundary/wall_support.h"
#include "core/features.h"
#include "core/free_way.h"
#include "core/levels.h"
#include "core/neighbours.h"
#include "core/parameters.h"
#include "core/particles.h"
#include "core/sleep.h"
#include "core/timer.h"
#include "core/vents.h"

namespace molten {

/// Which bound set the time step.
enum class Limit : int { sound, viscous, force, conduction, fixed, output, density_diffusion };
const char* name_of(Limit limit);

struct Clock {
  double time = 0;  // s
  std::int64_t step = 0;
  double dt = 0;           // s; of this step, once chosen
  double previous_dt = 0;  // s; of the step before
  Limit limit = Limit::sound;
  double stop = 1e300;  // s; the next time that a step must end on
};

/// The largest values that the last rates saw; they bound the next time step.
struct Extremes {
  double speed2 = 0;               // m²/s²
  double acceleration2 = 0;        // m²/s⁴
  double kinematic_viscosity = 0;  // m²/s
  double xsph2 = 0;                // m²/s²
  bool finite = true;
};

/// What surrounds the fluid.
template <int Dim> struct Surroundings {
  Surroundings(Contact<Dim> walls, Bodies<Dim> moving = {}, Vents<Dim> open = {})
      : contact(std::move(walls)), bodies(std::move(moving)), vents(std::move(open)) {}

  Contact<Dim> contact;
  Bodies<Dim> bodies;
  Vents<Dim> vents;
  std::vector<HeldPoint<Dim>> held{};  // boundary particles that take part
  Repulsion<Dim> repulsion{};          // of those that push
};

template <int Dim, class Real> struct State {
  Features features;  // fixed for the run
  Parameters<Dim> parameters;
  Contact<Dim> contact;
  Bodies<Dim> bodies;
  Vents<Dim> vents;
  Particles<Dim, Real> particles;
  Neighbours<Dim, Real> neighbours;  // good between sorts
  FreeWay free_way;                  // to the walls, as of the last sort; empty without contact
  WallSupport<Dim> wall_support;     // empty without the feature
  Clock clock;                       // this step
  Extremes extremes;
  Timer timer;
  Sleep sleep{};
  Levels levels{};                 // empty without the feature
  Repulsion<Dim> repulsion{};      // empty without the feature
  std::size_t boundary_count = 0;  // of the particles, those that are walls

  void archive(Archive& a);
  std::size_t bytes() const {
    return particles.bytes() + neighbours.bytes() + free_way.bytes() + wall_support.bytes() + sleep.still.capacity() +
           sleep.cold.capacity() + levels.bytes() + repulsion.bytes();
  }
};

/// The start of a run, sorted and listed.
template <int Dim, class Real>
State<Dim, Real> make_state(const Features& features, const Parameters<Dim>& parameters, Surroundings<Dim> around,
                            const Start& start);

}  // namespace molten
