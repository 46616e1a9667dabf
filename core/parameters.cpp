#include "core/parameters.h"

#include <algorithm>
#include <cmath>

namespace molten {

namespace {

struct Extent {
  std::array<double, 3> lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
};

/// Of the fluid at the start and of where it will enter.
Extent extent_of(const Start& start) {
  Extent e;
  const auto extend = [&](const std::array<double, 3>& x) {
    for (int d = 0; d < 3; ++d) e.lower[d] = std::min(e.lower[d], x[d]), e.upper[d] = std::max(e.upper[d], x[d]);
  };
  for (const auto& x : start.position) extend(x);
  for (const auto& x : start.vents) extend(x);
  return e;
}

/// Of a moving wall's centre (m²/s²): at the start, or the highest between key frames.
double square_of_speed(const Boundary& b) {
  const auto square = [](const std::array<double, 3>& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; };
  if (b.body) return square(b.body->velocity);
  if (!b.motion) return 0;
  double fastest2 = square(b.motion->velocity);
  for (std::size_t k = 1; k < b.motion->key_frames.size(); ++k) {
    const auto &from = b.motion->key_frames[k - 1], &to = b.motion->key_frames[k];
    const double dt = to[0] - from[0];
    fastest2 = std::max(fastest2, square({(to[1] - from[1]) / dt, (to[2] - from[2]) / dt, (to[3] - from[3]) / dt}));
  }
  return fastest2;
}

/// Ten times the speed that the fluid reaches by falling its own height, or that fluid, walls or vents start with.
double default_sound_speed(const Scene& scene, const Start& start, const Extent& extent) {
  double fall = 0, fastest2 = 0;  // g · height, m²/s²
  for (int d = 0; d < scene.dimensions; ++d)
    fall += std::abs(scene.gravity[d]) * (extent.upper[d] - extent.lower[d] + start.spacing);
  for (const auto& v : start.velocity) fastest2 = std::max(fastest2, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  fastest2 = std::max(fastest2, start.vent_speed * start.vent_speed);
  for (const Boundary& b : scene.boundaries) fastest2 = std::max(fastest2, square_of_speed(b));
  return 10 * std::sqrt(2 * fall + fastest2 + 1e-12);
}

/// Between the coldest and the hottest that there will be.
double middle_temperature(const Scene& scene, const Start& start) {
  double low = 1e300, high = -1e300;
  const auto extend = [&](double t) { low = std::min(low, t), high = std::max(high, t); };
  for (const double t : start.temperature) extend(t);
  for (const Vent& vent : scene.vents)
    for (const Vent::Entry& entry : vent.table) extend(entry.temperature);
  return (low + high) / 2;
}

/// A hundred extents of the fluid to each side: far enough that only what has escaped is dropped.
template <int Dim> Domain<Dim> domain_of(const Scene& scene, const Extent& extent, double spacing) {
  Domain<Dim> domain;
  double size = 10 * spacing;
  for (int d = 0; d < Dim; ++d) size = std::max(size, extent.upper[d] - extent.lower[d]);
  for (int d = 0; d < Dim; ++d) {
    domain.lower[d] = scene.domain ? scene.domain->min[d] : extent.lower[d] - 100 * size;
    domain.upper[d] = scene.domain ? scene.domain->max[d] : extent.upper[d] + 100 * size;
    if (!scene.periodic[d]) continue;
    domain.periodic.lower[d] = domain.lower[d];
    domain.periodic.period[d] = domain.upper[d] - domain.lower[d];
  }
  return domain;
}

}  // namespace

double measure_of_particle(const Scene& scene, const Start& start) {
  if (start.position.empty()) return std::pow(start.spacing, scene.dimensions);
  return start.measure / static_cast<double>(start.position.size());
}

template <int Dim> Parameters<Dim> parameters_of(const Scene& scene, const Start& start) {
  const Extent extent = extent_of(start);
  const Numerics& n = scene.numerics;
  Parameters<Dim> p;
  p.spacing = start.spacing;
  p.smoothing_length = n.smoothing_ratio * start.spacing;
  p.support_radius = kernel_reach(n.kernel) * p.smoothing_length;
  p.skin = n.skin * start.spacing;
  p.particle_mass = scene.fluid.density * measure_of_particle(scene, start);
  p.outflows = scene.outflows;
  for (int d = 0; d < Dim; ++d) p.gravity[d] = scene.gravity[d];
  p.kernel = n.kernel;
  p.eos = {n.state_equation, scene.fluid.density, n.sound_speed.value_or(default_sound_speed(scene, start, extent)),
           n.gamma};
  const Rheology& r = scene.fluid.rheology;
  p.viscosity = r.viscosity;
  if (r.model == Rheology::Model::smd) p.smd = Smd(r.flow_index, r.yield_stress, r.consistency, r.jump_number);
  if (scene.fluid.heat) {
    p.diffusivity = scene.fluid.heat->diffusivity;
    if (scene.fluid.heat->melting_range) {
      p.smd.melting_low = (*scene.fluid.heat->melting_range)[0];
      p.smd.melting_high = (*scene.fluid.heat->melting_range)[1];
    }
    p.reference_temperature = middle_temperature(scene, start);
  }
  p.artificial_viscosity = n.artificial_viscosity;
  if (n.xsph) p.xsph = n.xsph->epsilon, p.xsph_form = n.xsph->form;
  p.courant_sound = n.courant_sound;
  p.courant_viscous = n.courant_viscous;
  p.courant_force = n.courant_force;
  p.courant_conduction = n.courant_conduction;
  p.fixed_dt = n.fixed_dt;
  p.sort_each_step = n.resort == Resort::each_step;
  p.domain = domain_of<Dim>(scene, extent, start.spacing);
  return p;
}

template Parameters<2> parameters_of<2>(const Scene&, const Start&);
template Parameters<3> parameters_of<3>(const Scene&, const Start&);

}  // namespace molten
