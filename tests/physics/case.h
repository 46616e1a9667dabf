// Small runs that the physics tests make by hand: a lattice, a scene's numbers, and a state that steps.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/step.h"
#include "io/geometry/assemble.h"
#include "io/scene/scene_file.h"
#include "tests/flavours.h"
#include "tests/particle_sets.h"
#include "tests/with_threads.h"

namespace molten::physics_case {

/// Small runs are quicker without threads, and a busy machine does not slow them.
struct OneThread : WithThreads {
  OneThread() : WithThreads(1) {}
};

using Triple = std::array<double, 3>;

/// A lattice of `cells` particles along each axis, its first cell at the origin; heat is for the caller to fill in.
inline Start lattice(int dimensions, const std::array<int, 3>& cells, double spacing) {
  return particle_sets::start_of(particle_sets::plain_scene(dimensions),
                                 particle_sets::lattice({cells.begin(), cells.begin() + dimensions}, spacing), spacing);
}

inline void jitter(Start& start, int dimensions, double part) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-part * start.spacing, part * start.spacing);
  for (Triple& x : start.position)
    for (int d = 0; d < dimensions; ++d) x[d] += any(random);
}

/// A scene of these dimensions without gravity and artificial viscosity; the fluid's shape is a stand-in, as the
/// particles come from a lattice.
inline Scene plain_scene(int dimensions) {
  Scene scene = particle_sets::plain_scene(dimensions);
  scene.file = "test";
  scene.numerics.sound_speed = 1;
  return scene;
}

/// All axes close on themselves after `size` (m).
inline void make_periodic(Scene& scene, const Triple& size) {
  scene.domain = Box{{0, 0, 0}, size};
  for (int d = 0; d < scene.dimensions; ++d) scene.periodic[d] = true;
}

template <int Dim, class Real> State<Dim, Real> state_of(const Scene& scene, const Start& start) {
  const Parameters<Dim> p = parameters_of<Dim>(scene, start);
  return make_state<Dim, Real>(features_of(scene), p, build_surroundings(scene, start, p), start);
}

/// f(slot) for every particle.
template <int Dim, class Real, class F> void for_each_particle(const State<Dim, Real>& s, F&& f) {
  particle_sets::for_each_particle(s.particles, [&](std::size_t slot, const auto&) { f(slot); });
}

template <int Dim, class Real> void run_until(State<Dim, Real>& s, double time) {
  s.clock.stop = time;
  while (s.clock.time < time) step(s);
}

}  // namespace molten::physics_case
