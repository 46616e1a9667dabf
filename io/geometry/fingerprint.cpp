// The hash that tells whether a run may go on from a checkpoint: of all that a scene says but where it stands, what it
// is called, and what it writes. Each struct is taken apart into all of its members, so that a new one does not compile
// until it is named here.
#include <type_traits>

#include "io/geometry/assemble.h"
#include "io/hash.h"

namespace molten {

namespace {

template <class... T> void add(Hash& hash, const T&... values);

void add_one(Hash& hash, const GroundLayer& g) {
  const auto& [diffusivity, thickness] = g;
  add(hash, diffusivity, thickness);
}

void add_one(Hash& hash, const ThermalViscosity& t) {
  const auto& [kind, activation_temperature, reference_temperature, a, b, c] = t;
  add(hash, kind, activation_temperature, reference_temperature, a, b, c);
}

void add_one(Hash& hash, const Rheology& r) {
  const auto& [model, viscosity, flow_index, jump_number, yield_stress, consistency, regularisation, fast_viscosity,
               relaxation_time, largest_viscosity, thermal] = r;
  add(hash, model, viscosity, flow_index, jump_number, yield_stress, consistency, regularisation, fast_viscosity,
      relaxation_time, largest_viscosity, thermal);
}

void add_one(Hash& hash, const Heat& h) {
  const auto& [diffusivity, melting_range, initial_bottom, initial_top] = h;
  add(hash, diffusivity, melting_range, initial_bottom, initial_top);
}

/// Without the bodies and their number, which the start has.
void add_one(Hash& hash, const Fluid& f) {
  const auto& [bodies, particles, spacing, density, hydrostatic, rheology, heat, place] = f;
  add(hash, density, hydrostatic, rheology, heat);
}

void add_one(Hash& hash, const Movement& m) {
  const auto& [velocity, spin, key_frames, centre] = m;
  add(hash, velocity, spin, key_frames, centre);
}

void add_one(Hash& hash, const FreeBody& b) {
  const auto& [density, velocity, spin] = b;
  add(hash, density, velocity, spin);
}

void add_one(Hash& hash, const Vent::Entry& e) {
  const auto& [time, rate, temperature] = e;
  add(hash, time, rate, temperature);
}

/// Without the mesh: the start has the vents' mouths.
void add_one(Hash& hash, const Vent& v) {
  const auto& [centre, normal, radius, mesh, table, place] = v;
  add(hash, centre, normal, radius, table);
}

void add_one(Hash& hash, const Plane& p) {
  const auto& [point, normal] = p;
  add(hash, point, normal);
}

/// Without the shape, which the walls have.
void add_one(Hash& hash, const Boundary& b) {
  const auto& [shape, motion, body, restitution, slip, friction, yield_stress, velocity, temperature, ground, inside,
               two_sided] = b;
  add(hash, motion, body, restitution, slip, friction, yield_stress, velocity, temperature, ground, inside, two_sided);
}

void add_one(Hash& hash, const Xsph& x) {
  const auto& [form, epsilon, neighbour_density] = x;
  add(hash, form, epsilon, neighbour_density);
}

void add_one(Hash& hash, const Shifting& s) {
  const auto& [strength, coupling] = s;
  add(hash, strength, coupling);
}

void add_one(Hash& hash, const DensityFilter& f) {
  const auto& [kind, every] = f;
  add(hash, kind, every);
}

void add_one(Hash& hash, const BoundaryParticles& b) {
  const auto& [kind, every] = b;
  add(hash, kind, every);
}

void add_one(Hash& hash, const SleepBounds& s) {
  const auto& [speed, density_rate, temperature_rate, temperature, after] = s;
  add(hash, speed, density_rate, temperature_rate, temperature, after);
}

/// Without the preset's name: its numbers count.
void add_one(Hash& hash, const Numerics& n) {
  const auto& [preset, precision, resort, kernel, smoothing_ratio, skin, integrator, state_equation, gamma, sound_speed,
               artificial_viscosity, particle_sound_speed, tensile_correction, viscosity_form, stress_form,
               internal_energy, xsph, stiffness, density_kernel, half_pressure, energy_surplus, density, density_filter,
               gradient_correction, laplacian, shifting, courant_sound, courant_viscous, courant_force,
               courant_conduction, density_diffusion, wall_support, boundary_particles, fixed_dt, time_step_levels,
               sleep] = n;
  add(hash, precision, resort, kernel, smoothing_ratio, skin, integrator, state_equation, gamma, sound_speed,
      artificial_viscosity, particle_sound_speed, tensile_correction, viscosity_form, stress_form, internal_energy,
      xsph, stiffness, density_kernel, half_pressure, energy_surplus, density, density_filter, gradient_correction,
      laplacian, shifting, courant_sound, courant_viscous, courant_force, courant_conduction, density_diffusion,
      wall_support, boundary_particles, fixed_dt, time_step_levels, sleep);
}

void add_one(Hash& hash, const Box& b) {
  const auto& [min, max] = b;
  add(hash, min, max);
}

void add_one(Hash& hash, const Scene& s) {
  const auto& [title, file, text, places, dimensions, gravity, periodic, domain, fluid, boundaries, vents, outflows,
               numerics, run, output] = s;
  add(hash, dimensions, gravity, periodic, domain, fluid, boundaries, vents, outflows, numerics);
}

void add_one(Hash& hash, const Start& s) {
  const auto& [spacing, measure, position, velocity, temperature, conductivity, vents, vent_speed] = s;
  add(hash, spacing, measure, position, velocity, temperature, conductivity, vents, vent_speed);
}

template <class T>
requires std::is_arithmetic_v<T> || std::is_enum_v<T>
void add_one(Hash& hash, const T& value) { hash.add(value); }

template <class T, std::size_t size> void add_one(Hash& hash, const std::array<T, size>& values) {
  for (const T& value : values) add_one(hash, value);
}

template <class T> void add_one(Hash& hash, const std::vector<T>& values) {
  hash.add(values.size());
  for (const T& value : values) add_one(hash, value);
}

template <class T> void add_one(Hash& hash, const std::optional<T>& value) {
  hash.add(value.has_value());
  if (value) add_one(hash, *value);
}

template <class... T> void add(Hash& hash, const T&... values) { (add_one(hash, values), ...); }

/// Where the walls are, with what their files hold.
template <int Dim> void add_walls(Hash& hash, const Scene& scene, double spacing) {
  for (const Wall<Dim>& wall : build_walls<Dim>(scene, spacing)) {
    hash.add(wall.vertices.size());
    for (const auto& v : wall.vertices) hash.add(v.data(), Dim);
    for (const auto& f : wall.facets) hash.add(f.data(), Dim);
    hash.add(wall.plane_point.data(), Dim);
    hash.add(wall.plane_normal.data(), Dim);
  }
}

}  // namespace

std::string fingerprint(const Scene& scene, const Start& start) {
  Hash hash;
  add(hash, scene, start);
  scene.dimensions == 2 ? add_walls<2>(hash, scene, start.spacing) : add_walls<3>(hash, scene, start.spacing);
  return hash.text();
}

}  // namespace molten
