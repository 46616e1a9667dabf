#include "core/step.h"

#include <algorithm>
#include <cmath>

#include "core/boundary/near_walls.h"
#include "core/diagnostics.h"
#include "core/error.h"
#include "core/particle_pass.h"
#include "core/runge_kutta.h"

namespace molten {

namespace {

template <int Dim, class Real> void find_wall_patches(State<Dim, Real>& s) {
  const auto scope = s.timer.scope("walls");
  s.wall_support.find_patches(s.particles, s.neighbours.first_slot(Block::active));
}

/// Viscous limits in a step from which on stages within it (levels.h) cost less than steps of that limit would, even
/// where all is stiff: two stages, which take as much as 2.2 steps.
constexpr double stages_pay_from = 3.2;

bool is_multiple(std::int64_t step, std::int64_t every) { return step > 0 && step % every == 0; }

/// Active particles beyond an outflow plane become padding; the sort that follows drops it.
template <int Dim, class Real> void remove_outflow(State<Dim, Real>& s) {
  if (s.neighbours.clusters() == 0) return;  // never sorted yet
  const auto x = s.particles[position];
  const auto ids = s.particles[id][0];
  const std::size_t first = s.neighbours.first_slot(Block::active);
  const auto is_beyond = [&](std::size_t slot, const Plane& plane) {
    double height = 0;
    for (int d = 0; d < Dim; ++d) height += (x[d][slot] - plane.point[d]) * plane.normal[d];
    return height > 0;
  };
  const std::size_t removed = reduce_slots(
      s.particles.slots() - first, std::size_t{0},
      [&](std::size_t k, std::size_t& count) {
        if (s.particles.is_padding(first + k)) return;
        for (const Plane& plane : s.parameters.outflows) {
          if (!is_beyond(first + k, plane)) continue;
          ids[first + k] = padding_id;
          ++count;
          return;
        }
      },
      [](std::size_t& a, std::size_t b) { a += b; });
  s.particles.forget(removed);
}

}  // namespace

template <int Dim, class Real> void step(State<Dim, Real>& s) {
  if (s.features.vents) emit(s);
  if (s.features.sleep) wake_and_rest(s);
  const bool filter = s.features.density_filter && is_multiple(s.clock.step, s.parameters.density_filter.every);
  if (filter) filter_density(s);
  if (!s.features.reuses_rates() || s.clock.step == 0 || filter) find_all_rates(s);
  require_sane(s);
  choose_time_step(s);
  for (int stage = 1; stage < s.features.stages(); ++stage) {
    go_to_stage(s, stage);
    find_all_rates(s);
    require_sane(s);
  }
  if (s.features.levels) take_stages(s);
  integrate_and_collide(s);
  s.clock.time = s.clock.limit == Limit::output && s.clock.time + s.clock.dt > s.clock.stop * (1 - 1e-14)
                     ? s.clock.stop
                     : s.clock.time + s.clock.dt;
  ++s.clock.step;
}

template <int Dim, class Real> void list_if_due(State<Dim, Real>& s) {
  const bool bodies_came = s.features.wall_support && s.bodies.way() > s.parameters.skin / 2;
  if (s.neighbours.is_due() || bodies_came || s.parameters.sort_each_step) sort_and_list(s);
}

template <int Dim, class Real> void find_all_rates(State<Dim, Real>& s) {
  list_if_due(s);
  if (s.features.wall_support) s.wall_support.place(s.bodies);
  if (s.features.density_sum) sum_density(s);
  if (s.features.gradient_correction) find_corrections(s);
  if (s.features.consistent_laplacian) find_laplacian_weights(s);
  if (s.features.varied_conduction) find_interfaces(s);
  const bool twice_at_walls = s.features.twice_at_walls();
  if (twice_at_walls) find_wall_patches(s);
  if (s.features.heat_at_walls()) find_heat_completions(s);
  if (s.features.stress) find_viscosity(s);
  find_rates(s);
  if (twice_at_walls) s.wall_support.forget_patches();
}

template <int Dim, class Real> void sort_and_list(State<Dim, Real>& s) {
  if (s.features.outflow) remove_outflow(s);
  if (s.features.sleep) return sort_active(s);
  const auto scope = s.timer.scope("sort and list");
  s.neighbours.rebuild(s.particles);
  look_for_walls(s);
  prepare(s);
}

template <int Dim, class Real> void look_for_walls(State<Dim, Real>& s) {
  if (!s.features.contact) return;
  s.free_way.reset(s.particles.slots());
  if (s.features.bodies) s.bodies.place(s.contact);
  const double spacing = s.parameters.spacing, longest = FreeWay::longest * spacing,
               face_reach = FreeWay::face_reach * spacing;
  const std::size_t first = s.neighbours.first_slot(Block::active);
  for_each_near_walls(s.particles, s.contact, first, longest, [&](std::size_t cluster) {
    const std::size_t slot = cluster * cluster_size;
    OneFace face;
    for_each_place(s.particles, slot, slot + cluster_size, [&](std::size_t k, const Point<Dim>& x) {
      const double way = s.contact.free_way(x, longest);
      s.free_way.set(k, way / spacing);
      face.add(way < face_reach ? s.contact.only_face(x, face_reach) : OneFace::any);
    });
    s.free_way.set_face(cluster, face.of_all());
  });
  if (s.features.wall_support)
    s.wall_support.mark(s.particles, s.neighbours.first_slot(Block::warm), s.bodies, s.contact);
}

template <int Dim, class Real> void require_sane(const State<Dim, Real>& s) {
  if (!s.extremes.finite) throw Error(ExitCode::diverged, find_non_finite(s));
  const double speed = std::sqrt(s.extremes.speed2), sound = s.parameters.eos.sound_speed;
  if (speed > 30 * sound)
    throw Error(ExitCode::diverged, "the run blew up: particle " + std::to_string(fastest_particle(s)) +
                                        " has a velocity of " + std::to_string(speed / sound) +
                                        " times the sound speed; raise numerics.sound_speed, lower numerics." +
                                        (s.parameters.fixed_dt ? "fixed_dt" : "courant") + " or add numerics.xsph");
}

template <int Dim, class Real> double viscous_limit(const State<Dim, Real>& s, double kinematic_viscosity) {
  const Parameters<Dim>& p = s.parameters;
  double viscous = p.courant_viscous;
  // Morris' form damps the shortest waves as fast as the Courant number is for. Of the pairs' tractions four thirds
  // count, and the particles' stresses beside them know nothing of such waves: 4/3 times as fast. What damps them
  // beside summed stresses knows the axis that they are along: 3/2 times as fast, at most (tests/levels_test.cpp).
  if (s.features.stress) viscous *= s.features.pairwise_stress ? 3.0 / 4 : 2.0 / 3;
  // (d + 2) cos² times what Morris' form makes of a pair.
  if (s.features.monaghan_viscosity) viscous /= Dim + 2;
  if (s.features.wall_support) viscous /= std::max(1.0, s.wall_support.viscous_stiffness());
  return viscous * p.smoothing_length * p.smoothing_length / kinematic_viscosity;
}

/// Symplectic Euler extrapolates the density's rate from three steps (core/integrate.cpp): |λ| dt < 0.32 is stable,
/// where leap-frog, from two, allows 0.5.
template <int Dim, class Real> double density_diffusion_limit(const State<Dim, Real>& s) {
  const Parameters<Dim>& p = s.parameters;
  const double part = s.features.integrator == IntegratorKind::symplectic_euler ? 0.64 : 1;
  return part * diffusion_limit(p, p.density_diffusion * p.smoothing_length * p.eos.sound_speed);
}

template <int Dim, class Real> void choose_time_step(State<Dim, Real>& s) {
  const Parameters<Dim>& p = s.parameters;
  const double h = p.smoothing_length;
  Clock& clock = s.clock;
  const auto limit = [&](double dt, Limit by) {
    if (dt < clock.dt) clock.dt = dt, clock.limit = by;
  };
  clock.previous_dt = clock.dt;
  clock.dt = 1e300;
  if (p.fixed_dt) {
    limit(*p.fixed_dt, Limit::fixed);
  } else {
    const double fastest = std::max(std::sqrt(s.extremes.speed2), s.bodies.fastest());
    limit(p.courant_sound * h / (p.eos.sound_speed + fastest), Limit::sound);
    limit(p.courant_force * std::sqrt(h / (std::sqrt(s.extremes.acceleration2) + 1e-300)), Limit::force);
    if (p.diffusivity > 0) limit(conduction_limit(p), Limit::conduction);
    if (p.density_diffusion > 0) limit(density_diffusion_limit(s), Limit::density_diffusion);
    if (s.extremes.kinematic_viscosity > 0) {
      const double viscous = viscous_limit(s, s.extremes.kinematic_viscosity);
      const double longest = std::ldexp(viscous, p.time_step_levels);
      limit(std::min(clock.dt, longest) < stages_pay_from * viscous ? viscous : longest, Limit::viscous);
    }
  }
  // Land on the stop; two halves rather than a step and a sliver. (The round-off of summed steps is no sliver.)
  const double left = clock.stop - clock.time;
  if (clock.dt >= left * (1 - 1e-9))
    clock.dt = left, clock.limit = Limit::output;
  else if (2 * clock.dt > left)
    limit(left / 2, Limit::output);
}

#define MOLTEN_INSTANTIATE(Dim, Real)                             \
  template void step(State<Dim, Real>&);                          \
  template void list_if_due(State<Dim, Real>&);                   \
  template void find_all_rates(State<Dim, Real>&);                \
  template void sort_and_list(State<Dim, Real>&);                 \
  template void look_for_walls(State<Dim, Real>&);                \
  template void require_sane(const State<Dim, Real>&);            \
  template double viscous_limit(const State<Dim, Real>&, double); \
  template void choose_time_step(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
