#include "bench/cases.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "core/kernel.h"
#include "core/step.h"
#include "io/geometry/assemble.h"
#include "io/scene/scene_file.h"

namespace molten::bench {

namespace {

template <int Dim, class Real> State<Dim, Real> state_of(const Scene& scene, const Start& start) {
  const Parameters<Dim> p = parameters_of<Dim>(scene, start);
  Contact<Dim> contact(build_walls<Dim>(scene, start.spacing), p.contact_radius, p.support_radius);
  return make_state<Dim, Real>(features_of(scene), p, std::move(contact), start);
}

Scene tank(int dimensions, double smoothing_ratio) {
  Scene scene;
  scene.dimensions = dimensions;
  if (dimensions == 2) scene.gravity = {0, -9.81, 0};
  scene.numerics.smoothing_ratio = smoothing_ratio;
  Boundary walls;
  walls.shape.box = Box{{0, 0, 0}, {3, dimensions == 2 ? 2.0 : 1.0, 2}};
  walls.inside = true;
  walls.slip = 1;
  scene.boundaries.push_back(walls);
  return scene;
}

}  // namespace

template <int Dim, class Real> State<Dim, Real> jittered_block(long long count, double smoothing_ratio) {
  const Scene scene = tank(Dim, smoothing_ratio);
  const auto side = static_cast<int>(std::lround(std::pow(static_cast<double>(count), 1.0 / Dim)));
  Start start;
  start.spacing = 1.0 / side;
  start.measure = 1;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> jitter(-0.1, 0.1);
  const int layers = Dim == 3 ? side : 1;
  for (int k = 0; k < layers; ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const auto at = [&](int n) { return (n + 0.5 + jitter(random)) * start.spacing; };
        start.position.push_back({at(i), at(j), Dim == 3 ? at(k) : 0.0});
        start.velocity.push_back({jitter(random), jitter(random), Dim == 3 ? jitter(random) : 0.0});
      }
  return state_of<Dim, Real>(scene, start);
}

template <class Real> State<3, Real> bunny() {
  const std::filesystem::path source = MOLTEN_SOURCE_DIR;
  std::vector<std::string> overrides;
  if (!std::filesystem::exists(source / "scenes/models/bunny.obj"))
    overrides = {"fluid.mesh=\"\"", "fluid.sphere={center=[0,0,0.08],radius=0.06}"};
  const Scene scene = read_scene(source / "scenes/bunny.toml", overrides);
  return state_of<3, Real>(scene, fill_bodies(scene, features_of(scene)));
}

template <int Dim, class Real> std::string check_rates(State<Dim, Real>& s) {
  find_rates(s);
  const Particles<Dim, Real>& p = s.particles;
  const Parameters<Dim>& q = s.parameters;
  const double h = q.smoothing_length, rho0 = q.eos.rest_density;
  const std::size_t stride = std::max<std::size_t>(1, p.slots() / 20);
  for (std::size_t i = 0; i < p.slots(); i += stride) {
    if (p.is_padding(i)) continue;
    double rate = 0, scale = 1e-30;
    for (std::size_t j = 0; j < p.slots(); ++j) {
      if (i == j || p.is_padding(j)) continue;
      double r2 = 0, vx = 0;
      for (int d = 0; d < Dim; ++d) {
        const double x = p[position][d][i] - p[position][d][j];
        r2 += x * x;
        vx += x * (double(p[velocity][d][i]) - p[velocity][d][j]);
      }
      if (r2 >= q.support_radius * q.support_radius) continue;
      const double t = 1 - std::sqrt(r2) / h / 2;
      const double slope = q.particle_mass * kernel_constant(q.kernel, Dim) / std::pow(h, Dim + 2) * -5 * t * t * t;
      rate += slope * vx / rho0;
      scale += std::abs(slope * vx / rho0);
    }
    const double got = p[compression_rate][0][i];
    if (std::abs(got - rate) > (sizeof(Real) == 4 ? 2e-5 : 2e-6) * scale)
      return fmt::format("particle {}: compression rate {} instead of {}", p[id][0][i], got, rate);
  }
  return "";
}

template State<2, float> jittered_block(long long, double);
template State<2, double> jittered_block(long long, double);
template State<3, float> jittered_block(long long, double);
template State<3, double> jittered_block(long long, double);
template State<3, float> bunny();
template State<3, double> bunny();
template std::string check_rates(State<2, float>&);
template std::string check_rates(State<2, double>&);
template std::string check_rates(State<3, float>&);
template std::string check_rates(State<3, double>&);

}  // namespace molten::bench
