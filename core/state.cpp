#include "core/state.h"

#include <limits>
#include <optional>

#include "core/hydrostatic.h"
#include "core/particle_pass.h"
#include "core/step.h"

namespace molten {

const char* name_of(Limit limit) {
  switch (limit) {
    case Limit::sound:
      return "sound";
    case Limit::viscous:
      return "viscous";
    case Limit::force:
      return "force";
    case Limit::conduction:
      return "conduction";
    case Limit::fixed:
      return "fixed";
    case Limit::output:
      return "output";
    case Limit::density_diffusion:
      return "density diffusion";
  }
  return "";
}

template <int Dim, class Real> void State<Dim, Real>::archive(Archive& a) {
  a.value("clock/time", clock.time);
  a.value("clock/step", clock.step);
  a.value("clock/dt", clock.dt);
  a.value("clock/previous_dt", clock.previous_dt);
  auto limit = static_cast<std::int64_t>(clock.limit);
  a.value("clock/limit", limit);
  clock.limit = static_cast<Limit>(limit);
  if (features.reuses_rates()) {
    a.value("extremes/speed2", extremes.speed2);
    a.value("extremes/acceleration2", extremes.acceleration2);
    a.value("extremes/kinematic_viscosity", extremes.kinematic_viscosity);
    a.value("extremes/xsph2", extremes.xsph2);
  }
  bodies.archive(a);
  vents.archive(a);
  particles.archive(a);
  neighbours.archive(a);
  free_way.archive(a);  // as of the last sort: where the particles are now tells otherwise
  if (features.wall_support) wall_support.archive(a);
  if (a.loading()) neighbours.relist(particles);
  if (features.sleep) sleep.archive(a);
  if (features.sleep && a.loading()) mark_sleepers(*this);
}

namespace {

template <int Dim, class Real> void compress(Particles<Dim, Real>& p, std::size_t slot, double value) {
  p[compression][0][slot] = static_cast<Real>(value);
  if (p.has(half_compression)) p[half_compression][0][slot] = p[compression][0][slot];
}

/// Puts boundary particles into the slots from `first` on. At first they have the pressure of the fluid at rest beside
/// them, if the fluid starts with that.
template <int Dim, class Real>
void hold(State<Dim, Real>& s, const std::vector<HeldPoint<Dim>>& points, std::size_t first, const Start& start,
          const std::optional<FluidAtRest<Dim>>& at_rest) {
  Particles<Dim, Real>& p = s.particles;
  const Parameters<Dim>& q = s.parameters;
  Point<Dim> lower = Point<Dim>::Constant(std::numeric_limits<double>::max()), upper = -lower;
  for (const auto& x : start.position)
    for (int d = 0; d < Dim; ++d) lower[d] = std::min(lower[d], x[d]), upper[d] = std::max(upper[d], x[d]);
  const Point<Dim> margin = Point<Dim>::Constant(q.smoothing_length);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t slot = first + k;
    const HeldPoint<Dim>& point = points[k];
    const Point<Dim> x =
        point.body < 0 ? point.at : s.bodies.motion(static_cast<std::size_t>(point.body)).start.to_world(point.at);
    p[id][0][slot] = static_cast<std::int64_t>(slot);
    p[held][0][slot] = static_cast<Real>(point.body + 2);
    for (int d = 0; d < Dim; ++d) p[position][d][slot] = x[d];
    const bool beside = ((x - lower + margin).array() >= 0).all() && ((upper + margin - x).array() >= 0).all();
    if (at_rest && beside) compress(p, slot, at_rest->compression(x));
  }
}

}  // namespace

template <int Dim, class Real>
State<Dim, Real> make_state(const Features& features, const Parameters<Dim>& parameters, Surroundings<Dim> around,
                            const Start& start) {
  State<Dim, Real> s{
      features,
      parameters,
      std::move(around.contact),
      std::move(around.bodies),
      std::move(around.vents),
      Particles<Dim, Real>(features.columns()),
      Neighbours<Dim, Real>({parameters.spacing, parameters.support_radius, parameters.skin}, parameters.domain),
      {},
      {},
      {},
      {},
      {}};
  if (features.wall_support) s.wall_support = {s.contact, s.bodies, parameters};
  Particles<Dim, Real>& p = s.particles;
  const std::size_t fluid = start.position.size(), count = fluid + around.held.size();
  s.repulsion = std::move(around.repulsion);
  s.boundary_count = around.held.size();
  p.resize((count + cluster_size - 1) / cluster_size * cluster_size, count);
  for_each_field([&]<class F>(F) {
    if (!p.has(F{})) return;
    for (auto* column : p[F{}].c) std::fill_n(column, p.slots(), std::remove_pointer_t<decltype(column)>(0));
  });
  std::fill_n(p[id][0], p.slots(), padding_id);
  // Boundary particles are not squeezed with the fluid.
  std::optional<FluidAtRest<Dim>> at_rest;
  if (parameters.surface_potential) at_rest.emplace(parameters, start, !features.boundary_particles);
  for (std::size_t k = 0; k < fluid; ++k) {
    p[id][0][k] = static_cast<std::int64_t>(k);
    for (int d = 0; d < Dim; ++d) {
      p[position][d][k] = start.position[k][d];
      p[velocity][d][k] = static_cast<Real>(start.velocity[k][d]);
      if (p.has(half_velocity)) p[half_velocity][d][k] = p[velocity][d][k];
    }
    if (p.has(temperature)) p[temperature][0][k] = start.temperature[k];
    if (p.has(conductivity)) p[conductivity][0][k] = static_cast<Real>(start.conductivity[k]);
    if (!at_rest) continue;
    const Point<Dim> x = at_rest->place(start, k);
    for (int d = 0; d < Dim; ++d) p[position][d][k] = x[d];
    compress(p, k, at_rest->compression(x));
  }
  if (features.boundary_particles) hold(s, around.held, fluid, start, at_rest);
  if (features.vents) open_vents(s);
  sort_and_list(s);
  return s;
}

#define MOLTEN_INSTANTIATE(Dim, Real) \
  template struct State<Dim, Real>;   \
  template State<Dim, Real> make_state(const Features&, const Parameters<Dim>&, Surroundings<Dim>, const Start&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
