#include "bench/cases.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <type_traits>

#include "bench/naive.h"
#include "bench/terms.h"
#include "core/step.h"
#include "io/geometry/assemble.h"
#include "io/scene/scene_file.h"

namespace molten::bench {

template <int Dim, class Real> State<Dim, Real> state_of(const Scene& scene, const Start& start) {
  const Parameters<Dim> p = parameters_of<Dim>(scene, start);
  return make_state<Dim, Real>(features_of(scene), p, build_surroundings(scene, start, p), start);
}

template <int Dim, class Real> Moment moment_of(const State<Dim, Real>& s) {
  const Particles<Dim, Real>& p = s.particles;
  Moment m;
  m.start.spacing = s.parameters.spacing;
  m.start.measure = p.count() * s.parameters.particle_mass / s.parameters.eos.rest_density;
  m.start.position.resize(p.count());
  m.start.velocity.resize(p.count());
  m.start.temperature.resize(p.has(temperature) ? p.count() : 0);
  m.compression.resize(p.count());
  for (std::size_t slot = 0; slot < p.slots(); ++slot) {
    if (p.is_padding(slot)) continue;
    const auto k = static_cast<std::size_t>(p[id][0][slot]);
    for (int d = 0; d < Dim; ++d) {
      m.start.position.at(k)[d] = p[position][d][slot];
      m.start.velocity[k][d] = p[velocity][d][slot];
    }
    if (p.has(temperature)) m.start.temperature[k] = p[temperature][0][slot];
    m.compression[k] = p[compression][0][slot];
  }
  return m;
}

template <int Dim, class Real> State<Dim, Real> state_of(const Scene& scene, const Moment& moment) {
  auto s = state_of<Dim, Real>(scene, moment.start);
  Particles<Dim, Real>& p = s.particles;
  for (std::size_t slot = 0; slot < p.slots(); ++slot) {
    if (p.is_padding(slot)) continue;
    const auto value = static_cast<Real>(moment.compression.at(static_cast<std::size_t>(p[id][0][slot])));
    p[compression][0][slot] = value;
    if (p.has(half_compression)) p[half_compression][0][slot] = value;
  }
  prepare(s);
  return s;
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

template <int Dim, class Real> State<Dim, Real> block_in(const Scene& scene, long long count) {
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
  if (scene.fluid.heat) start.temperature.assign(start.position.size(), scene.fluid.heat->initial_bottom);
  return state_of<Dim, Real>(scene, start);
}

template <int Dim, class Real> State<Dim, Real> jittered_block(long long count, double smoothing_ratio) {
  return block_in<Dim, Real>(tank(Dim, smoothing_ratio), count);
}

template <int Dim, class Real> State<Dim, Real> full_block(long long count, double smoothing_ratio) {
  Scene scene = tank(Dim, smoothing_ratio);
  scene.fluid.rheology.model = Rheology::Model::smd;
  scene.fluid.heat = Heat{1e-5, std::nullopt, 20, 20};
  scene.numerics.xsph = Xsph{};
  State<Dim, Real> s = block_in<Dim, Real>(scene, count);
  const Particles<Dim, Real>& p = s.particles;
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> of(-1, 1);
  for (std::size_t slot = 0; slot < p.slots(); ++slot) {
    if (p.is_padding(slot)) continue;
    p[compression][0][slot] = static_cast<Real>(0.01 * of(random));
    p[temperature][0][slot] = 20 + 10 * of(random);
    p[viscosity][0][slot] = static_cast<Real>(50 + 40 * of(random));
    for (Real* stresses : p[stress].c) stresses[slot] = static_cast<Real>(1e-3 * of(random));
  }
  prepare(s);
  return s;
}

template <class Real> State<3, Real> bunny() {
  // one evaluation a step
  const Scene scene =
      read_scene(std::filesystem::path(MOLTEN_SOURCE_DIR) / "scenes/bunny.toml", {"numerics.time_step_levels=0"});
  return state_of<3, Real>(scene, fill_bodies(scene, features_of(scene)));
}

namespace {

/// The particles of a state that are compared: spread over all, no nearer to a wall than it may add to their rates.
template <int Dim, class Real> std::vector<std::size_t> samples(const State<Dim, Real>& s) {
  constexpr std::size_t wanted = 20;
  std::vector<std::size_t> found;
  for (std::size_t slot = 0; slot < s.particles.slots(); ++slot) {
    if (s.particles.is_padding(slot)) continue;
    Point<Dim> x;
    for (int d = 0; d < Dim; ++d) x[d] = s.particles[position][d][slot];
    if (!s.contact.may_touch(x, s.parameters.support_radius)) found.push_back(slot);
  }
  std::vector<std::size_t> spread;
  for (std::size_t k = 0; k < std::min(wanted, found.size()); ++k)
    spread.push_back(found[k * found.size() / std::min(wanted, found.size())]);
  return spread;
}

/// What the rates pass makes of a sum, and beside it of the sum's scale.
template <int Dim, class Real>
void finish(const State<Dim, Real>& s, CompressionRate, int, double& sum, double& scale) {
  sum /= s.parameters.eos.rest_density;
  scale /= s.parameters.eos.rest_density;
}
template <int Dim, class Real> void finish(const State<Dim, Real>& s, Acceleration, int k, double& sum, double& scale) {
  sum += s.parameters.gravity[k];
  scale += std::abs(s.parameters.gravity[k]);
}
template <int Dim, class Real, class F> void finish(const State<Dim, Real>&, F, int, double&, double&) {}

}  // namespace

template <int Dim, class Real> std::string check_rates(State<Dim, Real>& s) {
  if (s.features.stress) find_viscosity(s);
  find_rates(s);
  // Round-off of sums of some 100 terms, and positions good to 1e-6 spacings (in double 1e-12).
  constexpr double tolerance = sizeof(Real) == 4 ? 2e-5 : 3e-11;
  const std::vector<std::size_t> slots = samples(s);
  if (slots.empty()) return "no particle is far enough from walls to be checked";
  std::string wrong;
  for (const std::size_t i : slots)
    with_rate_terms(s, [&](const auto&... terms) {
      const NaiveSums<Dim, std::decay_t<decltype(terms)>...> naive(s, i, terms...);
      for_each_component<Dim>(naive.fields, [&](auto field, int k) {
        if (!s.particles.has(field)) return;
        const double got = s.particles[field][k][i];
        double wanted = component(naive.value[field], k).v, scale = component(naive.scale[field], k).v;
        finish(s, field, k, wanted, scale);
        if (!(std::abs(got - wanted) <= tolerance * scale))
          wrong = fmt::format("particle {}: {} is {} instead of {}", s.particles[id][0][i], field.name, got, wanted);
      });
    });
  return wrong;
}

template State<2, float> state_of(const Scene&, const Start&);
template State<2, double> state_of(const Scene&, const Start&);
template State<3, float> state_of(const Scene&, const Start&);
template State<3, double> state_of(const Scene&, const Start&);
template Moment moment_of(const State<2, float>&);
template Moment moment_of(const State<3, float>&);
template State<2, float> state_of(const Scene&, const Moment&);
template State<2, double> state_of(const Scene&, const Moment&);
template State<3, float> state_of(const Scene&, const Moment&);
template State<3, double> state_of(const Scene&, const Moment&);
template State<3, float> block_in(const Scene&, long long);
template State<2, float> jittered_block(long long, double);
template State<2, double> jittered_block(long long, double);
template State<3, float> jittered_block(long long, double);
template State<3, double> jittered_block(long long, double);
template State<3, float> full_block(long long, double);
template State<3, double> full_block(long long, double);
template State<3, float> bunny();
template State<3, double> bunny();
template std::string check_rates(State<2, float>&);
template std::string check_rates(State<2, double>&);
template std::string check_rates(State<3, float>&);
template std::string check_rates(State<3, double>&);

}  // namespace molten::bench
