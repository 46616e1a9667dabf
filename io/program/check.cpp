#include <fmt/format.h>
#include <omp.h>

#include <chrono>

#include "core/diagnostics.h"
#include "core/step.h"
#include "io/geometry/assemble.h"
#include "io/geometry/bodies.h"
#include "io/geometry/leak.h"
#include "io/geometry/mesh_defects.h"
#include "io/geometry/mesh_file.h"
#include "io/geometry/point_text.h"
#include "io/geometry/vents.h"
#include "io/geometry/warnings.h"
#include "io/program/commands.h"
#include "io/program/progress.h"
#include "io/scene/scene_file.h"

namespace molten {

namespace {

/// Places are those in the scene. How many defects there are.
std::size_t print_mesh(const Scene& scene, const MeshFile& file, Stages& stages) {
  stages.begin("reading " + file.path);
  const TriangleMesh mesh = placed_mesh(scene, file, [&] { stages.tick(); });
  stages.begin("looking for defects of " + file.path);
  const MeshReport r = inspect(mesh);
  const std::vector<Defect> defects = find_defects(mesh);
  stages.finish();
  fmt::print(
      "mesh              {}: {} vertices, {} triangles, {} open edges, {} flipped edges, {} degenerate triangles\n",
      file.path, mesh.vertices.size(), mesh.triangles.size(), r.open_edges, r.flipped_edges, r.degenerate_triangles);
  for (const Defect& d : defects) fmt::print("                  {} at {}: {}\n", d.what, in_metres<3>(d.place), d.cure);
  return defects.size();
}

/// Whether there is one.
template <int Dim>
bool print_leak(const Scene& scene, const Start& start, const std::vector<Wall<Dim>>& walls,
                const Contact<Dim>& contact, Stages& stages) {
  stages.begin("looking for leaks");
  const auto leak = find_leak<Dim>(scene, start, walls, contact);
  stages.finish();
  if (!leak) return false;
  fmt::print(
      "leak              fluid can get out of the walls at {}, the way is narrowest near {}: close the hole, or "
      "give an [[outflow]] if it is meant\n",
      in_metres<Dim>(leak->exit), in_metres<Dim>(leak->narrowest));
  return true;
}

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& w : words) all += (all.empty() ? "" : ", ") + w;
  return all;
}

std::size_t print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& w : warnings) fmt::print("warning           {}\n", w);
  return warnings.size();
}

/// By the default Courant numbers, which the state has from then on.
template <int Dim, class Real> double advised_time_step(State<Dim, Real>& s) {
  const Numerics standard;
  s.parameters.courant_sound = standard.courant_sound, s.parameters.courant_force = standard.courant_force;
  s.parameters.courant_viscous = standard.courant_viscous;
  s.parameters.courant_conduction = standard.courant_conduction;
  s.parameters.fixed_dt.reset();
  choose_time_step(s);
  return s.clock.dt;
}

/// Steps longer than the default Courant numbers would choose.
template <int Dim, class Real> std::vector<std::string> step_warnings(State<Dim, Real>& s, const Numerics& numerics) {
  constexpr double most = 2;
  const double chosen = s.clock.dt, advised = advised_time_step(s);
  if (!(chosen > most * advised)) return {};
  return {
      fmt::format("numerics.{}: steps of {:.3g} s are {:.3g} times those of the default Courant numbers, by the {} "
                  "limit; the run may blow up",
                  numerics.fixed_dt ? "fixed_dt" : "courant", chosen, chosen / advised, name_of(s.clock.limit))};
}

/// How many warnings there are.
template <int Dim, class Real>
std::size_t print_run(const Scene& scene, const Features& features, const Start& start, Stages& stages) {
  const Parameters<Dim> p = parameters_of<Dim>(scene, start);
  stages.begin("building the walls");
  const std::vector<Wall<Dim>> walls = build_walls<Dim>(scene, start.spacing);
  Surroundings<Dim> around = build_surroundings(scene, start, p, walls);
  stages.begin("looking for particles inside walls");
  require_no_overlap(scene, start, walls, around.contact);
  require_open_vents(scene, start, walls, around.contact);
  std::size_t warnings = print_leak(scene, start, walls, around.contact, stages);
  stages.begin("looking for what is seldom meant");
  const std::vector<std::string> seldom_meant = warnings_of(scene, start, walls);
  stages.finish();
  warnings += print_warnings(seldom_meant);
  stages.begin("timing some steps");
  State<Dim, Real> s = make_state<Dim, Real>(features, p, std::move(around), start);
  // A few steps tell the time step, its limit and the speed of this machine.
  step(s);
  const auto begun = std::chrono::steady_clock::now();
  constexpr int trial_steps = 10;
  for (int k = 0; k < trial_steps; ++k) step(s);
  const double a_step = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count() / trial_steps;
  stages.finish();
  const double steps = scene.run.end_time / s.clock.dt;
  const double frame =
      static_cast<double>(start.position.size()) * 4 * (8 + static_cast<double>(available_fields(features).size()) + 2);
  fmt::print("particles         {} (mass {:.4g} kg each, spacing {:.4g} m)\n", s.particles.count(), p.particle_mass,
             p.spacing);
  if (features.boundary_particles)
    fmt::print("of these          {} of fluid, {} of boundaries\n", s.particles.count() - s.boundary_count,
               s.boundary_count);
  if (features.repulsion) fmt::print("beside them       {} that boundaries push with\n", s.repulsion.count());
  fmt::print("smoothing length  {:.4g} m, support radius {:.4g} m, {:.1f} neighbours on average\n", p.smoothing_length,
             p.support_radius, static_cast<double>(count_pairs(s)) / static_cast<double>(s.particles.count()));
  fmt::print("sound speed       {:.4g} m/s\n", p.eos.sound_speed);
  fmt::print("time step         {:.3g} s at the start, set by the {} limit\n", s.clock.dt, name_of(s.clock.limit));
  fmt::print("steps             about {:.3g}\n", steps);
  fmt::print("run time          about {} on {} threads, if the time step stays\n", in_words(steps * a_step),
             omp_get_max_threads());
  fmt::print("memory            {:.3g} MB of state ({:.0f} bytes a particle)\n", static_cast<double>(s.bytes()) / 1e6,
             static_cast<double>(s.bytes()) / static_cast<double>(s.particles.count()));
  fmt::print("frames            {:.0f}, about {:.3g} MB in all\n",
             scene.run.end_time * scene.output.frames_per_second + 1,
             (scene.run.end_time * scene.output.frames_per_second + 1) * frame / 1e6);
  return warnings + print_warnings(step_warnings(s, scene.numerics));
}

}  // namespace

ExitCode check_scene(const Scene& scene) {
  const Features features = features_of(scene);
  require_fields(scene, features);
  Stages stages;
  std::size_t found = 0;
  for (const Body& body : scene.fluid.bodies)
    if (body.shape.mesh) found += print_mesh(scene, *body.shape.mesh, stages);
  for (const Boundary& boundary : scene.boundaries)
    if (boundary.shape.mesh) found += print_mesh(scene, *boundary.shape.mesh, stages);
  for (const Vent& vent : scene.vents)
    if (vent.mesh) found += print_mesh(scene, *vent.mesh, stages);
  stages.begin("filling the bodies");
  const Start start = fill_bodies(scene, features);
  stages.finish();
  fmt::print("scene             {}{}\n", scene.file, scene.title.empty() ? "" : ": " + scene.title);
  fmt::print("features          {}\n", joined(features.names()));
  fmt::print("passes a step     {}\n", joined(features.passes()));
  const bool single = scene.numerics.precision == Precision::single;
  if (scene.dimensions == 2)
    found += single ? print_run<2, float>(scene, features, start, stages)
                    : print_run<2, double>(scene, features, start, stages);
  else
    found += single ? print_run<3, float>(scene, features, start, stages)
                    : print_run<3, double>(scene, features, start, stages);
  if (found == 0)
    fmt::print("no errors found\n");
  else
    fmt::print("it can be run, but see the {} above\n", found == 1 ? "finding" : fmt::format("{} findings", found));
  return ExitCode::done;
}

}  // namespace molten
