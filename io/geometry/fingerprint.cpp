// The hash that tells whether a run may go on from a checkpoint.
#include "io/geometry/assemble.h"
#include "io/hash.h"

namespace molten {

namespace {

template <int Dim> void add_walls(Hash& hash, const Scene& scene, double spacing) {
  for (const Wall<Dim>& wall : build_walls<Dim>(scene, spacing)) {
    for (const auto& v : wall.vertices) hash.add(v.data(), Dim);
    for (const auto& f : wall.facets) hash.add(f.data(), Dim);
    hash.add(wall.plane_point.data(), Dim);
    hash.add(wall.plane_normal.data(), Dim);
    hash.add(wall.response.restitution);
    hash.add(wall.response.slip);
    hash.add(wall.skin.velocity.data(), Dim);
    for (const double number :
         {wall.skin.temperature.value_or(1e300), wall.skin.layer_diffusivity, wall.skin.layer_thickness})
      hash.add(number);
    if (wall.response.grip) hash.add(wall.response.grip->friction), hash.add(wall.response.grip->hold);
    hash.add(wall.two_sided);
  }
}

void add_motion(Hash& hash, const Boundary& boundary) {
  if (boundary.motion) {
    hash.add(boundary.motion->velocity);
    hash.add(boundary.motion->spin);
    if (boundary.motion->centre) hash.add(*boundary.motion->centre);
    hash.add(boundary.motion->key_frames.data(), boundary.motion->key_frames.size());
  }
  if (boundary.body) hash.add(boundary.body->density), hash.add(boundary.body->velocity), hash.add(boundary.body->spin);
}

void add_numerics(Hash& hash, const Numerics& n) {
  hash.add(static_cast<int>(n.precision));
  hash.add(static_cast<int>(n.resort));
  hash.add(static_cast<int>(n.kernel));
  hash.add(static_cast<int>(n.integrator));
  hash.add(static_cast<int>(n.state_equation));
  hash.add(n.xsph ? 1 + static_cast<int>(n.xsph->form) : 0);
  for (const double number :
       {n.smoothing_ratio, n.skin, n.gamma, n.sound_speed.value_or(0), n.artificial_viscosity,
        n.xsph ? n.xsph->epsilon : 0, n.courant_sound, n.courant_viscous, n.courant_force, n.courant_conduction,
        n.fixed_dt.value_or(0), n.density_diffusion, n.wall_support ? 1.0 : 0.0})
    hash.add(number);
  if (n.sleep)
    for (const auto& bound :
         {n.sleep->speed, n.sleep->density_rate, n.sleep->temperature_rate, n.sleep->temperature, n.sleep->after})
      hash.add(bound.value_or(-1));
}

}  // namespace

std::string fingerprint(const Scene& scene, const Start& start) {
  Hash hash;
  hash.add(scene.dimensions);
  hash.add(start.spacing);
  hash.add(start.position.data(), start.position.size());
  hash.add(start.velocity.data(), start.velocity.size());
  hash.add(start.temperature.data(), start.temperature.size());
  const Rheology& r = scene.fluid.rheology;
  hash.add(static_cast<int>(r.model));
  for (const double number :
       {scene.fluid.density, r.viscosity, r.flow_index, r.jump_number[0], r.jump_number[1], r.yield_stress,
        r.consistency, scene.gravity[0], scene.gravity[1], scene.gravity[2], scene.fluid.hydrostatic ? 1.0 : 0.0})
    hash.add(number);
  if (scene.fluid.heat) {
    hash.add(scene.fluid.heat->diffusivity);
    hash.add(scene.fluid.heat->melting_range.value_or(std::array<double, 2>{}).data(), 2);
  }
  if (scene.domain) hash.add(scene.domain->min), hash.add(scene.domain->max), hash.add(scene.periodic);
  scene.dimensions == 2 ? add_walls<2>(hash, scene, start.spacing) : add_walls<3>(hash, scene, start.spacing);
  for (const Boundary& boundary : scene.boundaries) add_motion(hash, boundary);
  for (const Vent& vent : scene.vents) {
    hash.add(vent.centre);
    hash.add(vent.normal);
    hash.add(vent.radius);
    hash.add(vent.table.data(), vent.table.size());
  }
  hash.add(start.vents.data(), start.vents.size());
  for (const Plane& plane : scene.outflows) hash.add(plane.point), hash.add(plane.normal);
  add_numerics(hash, scene.numerics);
  return hash.text();
}

}  // namespace molten
