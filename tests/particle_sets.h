// Small sets of particles for tests of core: lattices, random clouds, and states made of them without a scene file.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "core/parameters.h"
#include "core/state.h"
#include "core/step.h"
#include "tests/flavours.h"

namespace molten::particle_sets {

using Points = std::vector<std::array<double, 3>>;

/// Lattice points in the middles of cells[0] × cells[1] (× cells[2]) cells from the origin on, each moved by up to
/// `jitter` spacings per axis.
inline Points lattice(std::vector<int> cells, double spacing, double jitter = 0, unsigned seed = 1) {
  cells.resize(3, 1);
  const bool flat = cells[2] == 1;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-jitter, jitter);
  Points points;
  for (int z = 0; z < cells[2]; ++z)
    for (int y = 0; y < cells[1]; ++y)
      for (int x = 0; x < cells[0]; ++x) {
        std::array<double, 3> p{(x + 0.5 + move(random)) * spacing, (y + 0.5 + move(random)) * spacing, 0};
        if (!flat) p[2] = (z + 0.5 + move(random)) * spacing;
        points.push_back(p);
      }
  return points;
}

template <int Dim> Points cube(int cells, double spacing, double jitter = 0, unsigned seed = 1) {
  return lattice(std::vector<int>(Dim, cells), spacing, jitter, seed);
}

/// A scene without gravity, walls, viscosity; water at c = 10 m/s.
inline Scene plain_scene(int dim) {
  Scene scene;
  scene.dimensions = dim;
  scene.gravity = {0, 0, 0};
  scene.fluid.density = 1000;
  scene.numerics.sound_speed = 10;
  scene.numerics.artificial_viscosity = 0;
  return scene;
}

/// Makes every axis periodic: a cube of `size` m from the origin on.
inline void make_periodic(Scene& scene, double size) {
  scene.domain = Box{{0, 0, 0}, {size, size, size}};
  for (int d = 0; d < scene.dimensions; ++d) scene.periodic[d] = true;
}

/// The points at rest, each with the volume of a lattice cell; with heat, at the scene's bottom temperature.
inline Start start_of(const Scene& scene, Points points, double spacing) {
  Start start;
  start.spacing = spacing;
  start.measure = static_cast<double>(points.size()) * std::pow(spacing, scene.dimensions);
  start.velocity.assign(points.size(), {0, 0, 0});
  if (scene.fluid.heat) start.temperature.assign(points.size(), scene.fluid.heat->initial_bottom);
  start.position = std::move(points);
  return start;
}

template <int Dim, class Real>
State<Dim, Real> state_of(const Scene& scene, const Start& start, std::vector<Wall<Dim>> walls = {}) {
  Features features = features_of(scene);
  features.contact = !walls.empty();
  features.wall_support = features.contact && scene.numerics.wall_support;
  return make_state<Dim, Real>(features, parameters_of<Dim>(scene, start),
                               Contact<Dim>(std::move(walls), start.spacing / 2, 2.6 * start.spacing), start);
}

template <int Dim, class Real> State<Dim, Real> state_of(const Scene& scene, Points points, double spacing) {
  return state_of<Dim, Real>(scene, start_of(scene, std::move(points), spacing));
}

/// Calls f(slot, x) for every particle, x its position (z = 0 in 2-D).
template <int Dim, class Real, class F> void for_each_particle(const Particles<Dim, Real>& p, F&& f) {
  for (std::size_t s = 0; s < p.slots(); ++s) {
    if (p.is_padding(s)) continue;
    std::array<double, 3> x{};
    for (int d = 0; d < Dim; ++d) x[d] = p[position][d][s];
    f(s, x);
  }
}

/// Gives every particle the velocity (m/s) of its place.
template <int Dim, class Real, class F> void set_velocity(State<Dim, Real>& s, F&& of) {
  for_each_particle(s.particles, [&](std::size_t k, const std::array<double, 3>& x) {
    const std::array<double, 3> v = of(x);
    for (int d = 0; d < Dim; ++d) s.particles[velocity][d][k] = Real(v[d]);
  });
}

/// m W and m W'/r of the run's kernel at a distance (m).
struct KernelValue {
  double mW, mF;
};
template <int Dim> KernelValue kernel_at(const Parameters<Dim>& p, double r) {
  const auto kernel = with_kernel<double>(p.kernel, Dim, p.smoothing_length, p.particle_mass,
                                          [&](const auto& k) { return k(Lanes<double, 1>(r)); });
  return {kernel.w.v, kernel.slope.v};
}

/// A pair by brute force, in double and from the true positions: mW = m_j W, mF = m_j W'(r)/r.
struct NaivePair {
  std::size_t i, j;
  std::array<double, 3> x;  // x_i − x_j, m; the nearest image
  double r, mW, mF;
};

/// Calls f(NaivePair) for all directed pairs within the support, a particle with itself left out.
template <int Dim, class Real, class F> void for_each_pair(const State<Dim, Real>& s, F&& f) {
  const Parameters<Dim>& q = s.parameters;
  for_each_particle(s.particles, [&](std::size_t i, const auto& xi) {
    for_each_particle(s.particles, [&](std::size_t j, const auto& xj) {
      NaivePair p{i, j, {}, 0, 0, 0};
      for (int d = 0; d < Dim; ++d) {
        const double period = q.domain.periodic.period[d];
        p.x[d] = xi[d] - xj[d];
        if (period > 0) p.x[d] -= period * std::round(p.x[d] / period);
      }
      p.r = std::hypot(p.x[0], p.x[1], p.x[2]);
      if (i == j || p.r >= q.support_radius) return;
      const KernelValue kernel = kernel_at(q, p.r);
      p.mW = kernel.mW;
      p.mF = kernel.mF;
      f(p);
    });
  });
}

/// Is x at least `margin` m inside the cube of `size` m?
template <int Dim> bool well_inside(const std::array<double, 3>& x, double size, double margin) {
  for (int d = 0; d < Dim; ++d)
    if (x[d] < margin || x[d] > size - margin) return false;
  return true;
}

}  // namespace molten::particle_sets
