#include "core/parameters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/physics/density_coupling.h"

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

double norm(const std::array<double, 3>& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/// The fastest that a wall's surface moves (m/s), at the start or between key frames; what turns reaches `arm` (m) from
/// its axis.
double speed_of(const Boundary& b, double arm) {
  const auto whirl = [arm](const std::array<double, 3>& spin) { return norm(spin) * (std::numbers::pi / 180) * arm; };
  double fastest = norm(b.velocity);
  if (b.body) fastest = std::max(fastest, norm(b.body->velocity) + whirl(b.body->spin));
  if (!b.motion) return fastest;
  fastest = std::max(fastest, norm(b.motion->velocity) + whirl(b.motion->spin));
  for (std::size_t k = 1; k < b.motion->key_frames.size(); ++k) {
    const auto &from = b.motion->key_frames[k - 1], &to = b.motion->key_frames[k];
    const double dt = to[0] - from[0];
    fastest = std::max(fastest, norm({(to[1] - from[1]) / dt, (to[2] - from[2]) / dt, (to[3] - from[3]) / dt}) +
                                    whirl({(to[4] - from[4]) / dt, (to[5] - from[5]) / dt, (to[6] - from[6]) / dt}));
  }
  return fastest;
}

/// m
double diagonal_of(const Scene& scene, const Extent& extent) {
  double diagonal2 = 0;
  for (int d = 0; d < scene.dimensions; ++d) diagonal2 += std::pow(extent.upper[d] - extent.lower[d], 2);
  return std::sqrt(diagonal2);
}

/// Turning walls are taken as large as the fluid around them (m).
double arm_of(const Scene& scene, const Extent& extent) { return diagonal_of(scene, extent) / 2; }

/// The fluid follows what drives it, and what is much faster than sound counts as a run that blew up.
void require_slow(const Scene& scene, const std::string& key, double speed, double sound_speed) {
  constexpr double fastest = 3e8, most = 30;  // m/s, of light; sound speeds
  if (!(speed < fastest))
    refuse(scene, key, "moves faster than light; give lengths in m, times in s and spins in degrees/s");
  if (speed > most * sound_speed)
    refuse(scene, key,
           "moves at " + std::to_string(speed) + " m/s, more than 30 times the sound speed of " +
               std::to_string(sound_speed) + " m/s; slow it down or raise numerics.sound_speed");
}

void require_slow_drives(const Scene& scene, const Start& start, const Extent& extent, double sound_speed) {
  for (std::size_t k = 0; k < scene.boundaries.size(); ++k) {
    const Boundary& b = scene.boundaries[k];
    const std::string key = "boundary." + std::to_string(k) + (b.motion ? ".motion" : b.body ? ".body" : ".velocity");
    require_slow(scene, key, speed_of(b, arm_of(scene, extent)), sound_speed);
  }
  require_slow(scene, "vent", start.vent_speed, sound_speed);
}

/// Ten times the speed that the fluid reaches by falling its own height, or that fluid, walls or vents start with.
double default_sound_speed(const Scene& scene, const Start& start, const Extent& extent) {
  double fall = 0;  // g · height, m²/s²
  for (int d = 0; d < scene.dimensions; ++d)
    fall += std::abs(scene.gravity[d]) * (extent.upper[d] - extent.lower[d] + start.spacing);
  double fastest = start.vent_speed;
  for (const auto& v : start.velocity) fastest = std::max(fastest, norm(v));
  for (const Boundary& b : scene.boundaries) fastest = std::max(fastest, speed_of(b, arm_of(scene, extent)));
  return 10 * std::sqrt(2 * fall + fastest * fastest + 1e-12);
}

/// −g·x of a surface half a spacing above the highest particle.
double surface_potential(const Scene& scene, const Start& start) {
  double highest = -1e300, g2 = 0;
  for (int d = 0; d < scene.dimensions; ++d) g2 += scene.gravity[d] * scene.gravity[d];
  for (const auto& x : start.position) {
    double potential = 0;
    for (int d = 0; d < scene.dimensions; ++d) potential -= scene.gravity[d] * x[d];
    highest = std::max(highest, potential);
  }
  return highest + std::sqrt(g2) * start.spacing / 2;
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

/// A particle meets each neighbour once, not also from behind.
void require_wide_periods(const Scene& scene, double support_radius) {
  for (int d = 0; d < scene.dimensions; ++d) {
    if (!scene.periodic[d] || !scene.domain) continue;
    const double period = scene.domain->max[d] - scene.domain->min[d];
    if (period >= 2 * support_radius) continue;
    refuse(scene, "scene.domain",
           "is periodic and only " + std::to_string(period) + " m long there, but must be twice the support of " +
               std::to_string(support_radius) + " m at least; enlarge it or lower fluid.spacing");
  }
}

/// The temperatures that a scene starts with, keeps at its walls and lets in.
struct Temperatures {
  double low = 1e300, high = -1e300;

  Temperatures(const Scene& scene, const Start& start) {
    for (const double T : start.temperature) add(T);
    for (const Boundary& boundary : scene.boundaries)
      if (boundary.temperature) add(*boundary.temperature);
    if (scene.fluid.heat)
      for (const Vent& vent : scene.vents)
        for (const Vent::Entry& entry : vent.table) add(entry.temperature);
  }
  void add(double T) { low = std::min(low, T), high = std::max(high, T); }
  double range() const { return std::max(high - low, 0.0); }
  double middle() const { return (low + high) / 2; }
  double largest() const { return high < low ? 0 : std::max(std::abs(low), std::abs(high)); }
};

/// Thrown up, a particle is slower than the bound for twice speed/|g|, and nothing else about it tells that from rest:
/// twice that, and as long as sound needs to cross forty smoothing lengths.
template <int Dim> double rest_time_of(const Scene& scene, const Parameters<Dim>& p, double speed) {
  double g2 = 0;
  for (const double g : p.gravity) g2 += g * g;
  const double turning = g2 > 0 ? 4 * speed / std::sqrt(g2) : 0;
  const auto& asked = scene.numerics.sleep->after;
  if (asked && *asked < turning)
    refuse(scene, "numerics.sleep.after",
           std::to_string(*asked) +
               " s is too short to tell rest from the top of a throw; give at least 4 speed/|g|, " +
               std::to_string(turning) + " s, or lower numerics.sleep.speed");
  return asked.value_or(std::max(40 * p.smoothing_length / p.eos.sound_speed, turning));
}

/// A thousandth of the sound speed, so a hundredth of the fastest flow; the density rate of a particle that moves so
/// against its neighbours; a thousandth of the temperatures' range in the time that heat takes to cross the fluid, of
/// `size` (m) (a smoothing length in its place stops what heats a pool from one side); a hundredth of that range, and
/// more than what rounds away in single precision.
template <int Dim>
RestBounds rest_bounds(const Scene& scene, const Parameters<Dim>& p, const Temperatures& temperatures, double size) {
  const SleepBounds& asked = *scene.numerics.sleep;
  RestBounds r;
  const double h = p.smoothing_length, way = std::max(size, h);
  r.speed = asked.speed.value_or(1e-3 * p.eos.sound_speed);
  r.density_rate = asked.density_rate.value_or(r.speed / h);
  r.temperature_rate = asked.temperature_rate.value_or(1e-3 * temperatures.range() * p.diffusivity / (way * way));
  r.temperature = std::max(asked.temperature.value_or(0.01 * temperatures.range()), 1e-6 * temperatures.largest());
  r.after = rest_time_of(scene, p, r.speed);
  return r;
}

/// ∫ W r² dV (m²), by Simpson's rule.
template <int Dim> double second_moment(const Parameters<Dim>& p) {
  constexpr int parts = 1000;
  const double shell = Dim == 2 ? 2 * std::numbers::pi : 4 * std::numbers::pi, width = p.support_radius / parts;
  return with_kernel<double>(p.kernel, Dim, p.smoothing_length, 1.0, [&](const auto& kernel) {
    double sum = 0;
    for (int n = 1; n < parts; ++n) {  // nothing at either end
      const double r = n * width;
      sum += (n % 2 ? 4 : 2) * shell * std::pow(r, Dim + 1) * kernel(Lanes<double, 1>(r)).w.v;
    }
    return sum * width / 3;
  });
}

/// The concentration (density_coupling.h) of a square lattice at the rest density.
template <int Dim> double lattice_concentration(const Parameters<Dim>& p) {
  return with_kernel<double>(p.kernel, Dim, p.smoothing_length, p.particle_mass, [&](const auto& kernel) {
    const int reach = static_cast<int>(p.support_radius / p.spacing) + 1, side = 2 * reach + 1;
    double sum = 0, trace = 0;
    for (int n = 0; n < (Dim == 2 ? side * side : side * side * side); ++n) {
      const int a = n % side - reach, b = n / side % side - reach, c = Dim == 2 ? 0 : n / side / side - reach;
      const double r2 = (a * a + b * b + c * c) * p.spacing * p.spacing;
      const auto at = kernel(Lanes<double, 1>(std::sqrt(r2 + 1e-30 * p.spacing * p.spacing)));
      sum += at.w.v, trace -= at.slope.v * r2;
    }
    return concentration_of<Dim>(sum / p.eos.rest_density, trace / p.eos.rest_density);
  });
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
  require_wide_periods(scene, p.support_radius);
  // Walls with support hold particles by their pressure, further off than this; contact is for what goes too fast.
  p.contact_radius = n.wall_support ? start.spacing / 4 : start.spacing / 2;
  if (n.boundary_particles && !scene.boundaries.empty()) {
    p.contact_radius = start.spacing / 100;  // for what gets through between the particles of a wall
    p.boundary_every = n.boundary_particles->every;
  }
  p.particle_mass = scene.fluid.density * measure_of_particle(scene, start);
  p.outflows = scene.outflows;
  for (int d = 0; d < Dim; ++d) p.gravity[d] = scene.gravity[d];
  p.kernel = n.kernel;
  p.eos = {n.state_equation, scene.fluid.density, n.sound_speed.value_or(default_sound_speed(scene, start, extent)),
           n.gamma};
  if (n.state_equation == StateEquation::ideal_gas)
    p.eos.sound_speed = std::sqrt(n.stiffness.value_or(p.eos.sound_speed * p.eos.sound_speed));
  require_slow_drives(scene, start, extent, p.eos.sound_speed);
  if (scene.fluid.hydrostatic) p.surface_potential = surface_potential(scene, start);
  const Rheology& r = scene.fluid.rheology;
  p.viscosity = r.viscosity;
  p.kernel_second_moment = second_moment(p);
  p.rheology = r;
  if (r.model == Rheology::Model::smd) p.smd = Smd(r.flow_index, r.yield_stress, r.consistency, r.jump_number);
  if (scene.fluid.heat) {
    p.diffusivity = scene.fluid.heat->diffusivity;
    if (scene.fluid.heat->melting_range) {
      p.smd.melting_low = (*scene.fluid.heat->melting_range)[0];
      p.smd.melting_high = (*scene.fluid.heat->melting_range)[1];
    }
    p.reference_temperature = Temperatures(scene, start).middle();
    // What vents let in has the scene's.
    if (!start.conductivity.empty() && scene.vents.empty()) p.largest_conductivity = 0;
    for (const double ratio : start.conductivity) p.largest_conductivity = std::max(p.largest_conductivity, ratio);
  }
  p.artificial_viscosity = n.artificial_viscosity;
  p.density_diffusion = n.density_diffusion;
  if (n.xsph)
    p.xsph = n.xsph->epsilon, p.xsph_form = n.xsph->form, p.xsph_neighbour_density = n.xsph->neighbour_density;
  p.density_kernel = n.density_kernel.value_or(n.kernel);
  p.energy_surplus = n.energy_surplus;
  if (n.density_filter) p.density_filter = *n.density_filter;
  if (n.shifting) p.shifting = n.shifting->strength, p.density_coupling = n.shifting->coupling;
  if (p.density_coupling > 0) p.lattice_concentration = lattice_concentration(p);
  p.courant_sound = n.courant_sound;
  p.courant_viscous = n.courant_viscous;
  p.courant_force = n.courant_force;
  p.courant_conduction = n.courant_conduction;
  p.fixed_dt = n.fixed_dt;
  p.time_step_levels = static_cast<int>(n.time_step_levels);
  p.sort_each_step = n.resort == Resort::each_step;
  if (n.sleep) p.rest = rest_bounds(scene, p, Temperatures(scene, start), diagonal_of(scene, extent));
  p.domain = domain_of<Dim>(scene, extent, start.spacing);
  return p;
}

template Parameters<2> parameters_of<2>(const Scene&, const Start&);
template Parameters<3> parameters_of<3>(const Scene&, const Start&);

}  // namespace molten
