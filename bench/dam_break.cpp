#include "bench/dam_break.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

#include "bench/cases.h"
#include "core/step.h"
#include "io/geometry/assemble.h"
#include "io/scene/scene_file.h"

namespace molten::bench {

template <int Dim> Scene dam_break_scene(long long count, double smoothing_ratio) {
  const std::filesystem::path source = MOLTEN_SOURCE_DIR;
  Scene scene = read_scene(source / fmt::format("scenes/dam-break-{}d.toml", Dim));
  scene.fluid.particles = count;
  scene.fluid.spacing.reset();
  Numerics& n = scene.numerics;
  n.kernel = KernelKind::wendland_c2;
  n.smoothing_ratio = smoothing_ratio;
  n.courant_sound = 0.2;
  n.artificial_viscosity = 0.1;
  n.xsph.reset();
  const Box& column = *scene.fluid.bodies[0].shape.box;
  n.sound_speed = 10 * std::sqrt(2 * 9.81 * (column.max[Dim - 1] - column.min[Dim - 1]));
  return scene;
}

namespace {

constexpr double usual_smoothing_ratio = 1.3;
constexpr int settling_steps = 200;
constexpr int recipe = 1;  // raised when the prepared states become others

/// What a dam break is known by, particle by particle in the order of the filling: 2 Dim + 1 numbers each (position, m;
/// velocity, m/s; compression).
template <int Dim> struct Motions {
  static constexpr int width = 2 * Dim + 1;
  double time = 0;  // s
  std::vector<std::array<double, width>> of;
};

/// ½ √(H/g), s
template <int Dim> double time_of_interest(const Scene& scene) {
  const Box& column = *scene.fluid.bodies[0].shape.box;
  return 0.5 * std::sqrt((column.max[Dim - 1] - column.min[Dim - 1]) / 9.81);
}

template <int Dim, class Real>
State<Dim, Real> state_in_motion(const Scene& scene, const Start& rest, const Motions<Dim>& motions) {
  Moment moment{rest, {}};
  for (std::size_t k = 0; k < motions.of.size(); ++k) {
    for (int d = 0; d < Dim; ++d) {
      moment.start.position[k][d] = motions.of[k][d];
      moment.start.velocity[k][d] = motions.of[k][Dim + d];
    }
    moment.compression.push_back(motions.of[k][2 * Dim]);
  }
  State<Dim, Real> s = state_of<Dim, Real>(scene, moment);
  s.clock.time = motions.time;
  return s;
}

template <int Dim, class Real> Motions<Dim> motions_of(const State<Dim, Real>& s) {
  const Particles<Dim, Real>& p = s.particles;
  Motions<Dim> motions{s.clock.time, {}};
  motions.of.resize(p.count());
  for (std::size_t slot = 0; slot < p.slots(); ++slot) {
    if (p.is_padding(slot)) continue;
    auto& of = motions.of.at(static_cast<std::size_t>(p[id][0][slot]));
    for (int d = 0; d < Dim; ++d) of[d] = p[position][d][slot], of[Dim + d] = p[velocity][d][slot];
    of[2 * Dim] = p[compression][0][slot];
  }
  return motions;
}

/// The motions of a coarse column as a field over the lattice that it started as.
template <int Dim> class CoarseField {
 public:
  using Value = std::array<double, 2 * Dim + 1>;  // displacement, velocity, compression

  CoarseField(const Start& rest, const Motions<Dim>& motions) : spacing_(rest.spacing) {
    lower_.fill(1e300);
    std::array<double, Dim> upper;
    upper.fill(-1e300);
    for (const auto& x : rest.position)
      for (int d = 0; d < Dim; ++d) lower_[d] = std::min(lower_[d], x[d]), upper[d] = std::max(upper[d], x[d]);
    std::size_t nodes = 1;
    for (int d = 0; d < Dim; ++d) {
      points_[d] = 1 + static_cast<int>(std::lround((upper[d] - lower_[d]) / spacing_));
      nodes *= points_[d];
    }
    values_.resize(nodes);
    for (std::size_t k = 0; k < rest.position.size(); ++k) {
      std::array<int, Dim> at;
      for (int d = 0; d < Dim; ++d) at[d] = static_cast<int>(std::lround((rest.position[k][d] - lower_[d]) / spacing_));
      values_[node(at)] = motions.of[k];
      for (int d = 0; d < Dim; ++d) values_[node(at)][d] -= rest.position[k][d];
    }
    for (int d = 0; d < Dim; ++d) smooth(d);
  }

  /// Linear between the lattice points, and beyond the outermost.
  Value at(const std::array<double, 3>& x) const {
    std::array<int, Dim> low;
    std::array<double, Dim> part;
    for (int d = 0; d < Dim; ++d) {
      const double along = (x[d] - lower_[d]) / spacing_;
      low[d] = std::clamp(static_cast<int>(std::floor(along)), 0, points_[d] - 2);
      part[d] = along - low[d];
    }
    Value sum{};
    for (int corner = 0; corner < 1 << Dim; ++corner) {
      double weight = 1;
      std::array<int, Dim> at = low;
      for (int d = 0; d < Dim; ++d) {
        const int step = corner >> d & 1;
        at[d] += step;
        weight *= step ? part[d] : 1 - part[d];
      }
      const Value& value = values_[node(at)];
      for (std::size_t k = 0; k < value.size(); ++k) sum[k] += weight * value[k];
    }
    return sum;
  }

 private:
  std::size_t node(const std::array<int, Dim>& at) const {
    std::size_t n = 0;
    for (int d = Dim - 1; d >= 0; --d) n = n * points_[d] + at[d];
    return n;
  }

  /// Weights ¼, ½, ¼ along one axis; the outermost points stay.
  void smooth(int axis) {
    std::size_t stride = 1;
    for (int d = 0; d < axis; ++d) stride *= points_[d];
    const std::vector<Value> before = values_;
    for (std::size_t n = 0; n < values_.size(); ++n) {
      const auto at = static_cast<int>(n / stride % points_[axis]);
      if (at == 0 || at == points_[axis] - 1) continue;
      for (std::size_t k = 0; k < values_[n].size(); ++k)
        values_[n][k] = (before[n - stride][k] + 2 * before[n][k] + before[n + stride][k]) / 4;
    }
  }

  double spacing_;  // m
  std::array<double, Dim> lower_;
  std::array<int, Dim> points_;
  std::vector<Value> values_;
};

template <int Dim> Motions<Dim> refined(const CoarseField<Dim>& coarse, const Start& rest, double time) {
  Motions<Dim> motions{time, {}};
  motions.of.reserve(rest.position.size());
  for (const auto& x : rest.position) {
    auto value = coarse.at(x);
    for (int d = 0; d < Dim; ++d) value[d] += x[d];
    motions.of.push_back(value);
  }
  return motions;
}

template <int Dim> Motions<Dim> from_rest(const Scene& scene, const Start& rest) {
  auto s = state_of<Dim, float>(scene, rest);
  s.clock.stop = time_of_interest<Dim>(scene);
  while (s.clock.time < s.clock.stop) step(s);
  return motions_of(s);
}

template <int Dim> Motions<Dim> settled(const Scene& scene, const Start& rest, const Motions<Dim>& start) {
  auto s = state_in_motion<Dim, float>(scene, rest, start);
  for (int k = 0; k < settling_steps; ++k) step(s);
  return motions_of(s);
}

// ---- kept states ----------------------------------------------------------------------------------------------------

std::filesystem::path states_folder() {
  if (const char* named = std::getenv("MOLTEN_BENCH_STATES")) return named;
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "states";
}

template <int Dim> bool load(const std::filesystem::path& file, std::size_t count, Motions<Dim>& motions) {
  std::ifstream in(file, std::ios::binary);
  motions.of.resize(count);
  in.read(reinterpret_cast<char*>(&motions.time), sizeof motions.time);
  in.read(reinterpret_cast<char*>(motions.of.data()), static_cast<std::streamsize>(count * sizeof motions.of[0]));
  return in && in.peek() == std::ifstream::traits_type::eof();
}

/// Under another name first, so that a stop midway leaves nothing half written.
template <int Dim> void keep(const std::filesystem::path& file, const Motions<Dim>& motions) {
  std::filesystem::create_directories(file.parent_path());
  const std::filesystem::path unfinished = file.string() + "." + std::to_string(getpid());
  std::ofstream out(unfinished, std::ios::binary);
  out.write(reinterpret_cast<const char*>(&motions.time), sizeof motions.time);
  out.write(reinterpret_cast<const char*>(motions.of.data()),
            static_cast<std::streamsize>(motions.of.size() * sizeof motions.of[0]));
  out.close();
  if (out) std::filesystem::rename(unfinished, file);
}

template <int Dim> Motions<Dim> prepared(const Scene& scene, const Start& rest) {
  const long long coarse_count = Dim == 2 ? 10000 : 100000;
  const auto count = static_cast<long long>(rest.position.size());
  const auto file =
      states_folder() / fmt::format("dam-break-{}d-{}-{}-r{}.bin", Dim, count, scene.numerics.smoothing_ratio, recipe);
  Motions<Dim> motions;
  if (load(file, rest.position.size(), motions)) return motions;
  fmt::print(stderr, "preparing {} particles of a moving dam break for {}\n", count, file.string());
  if (count <= coarse_count * 11 / 10) {
    motions = from_rest<Dim>(scene, rest);
  } else {
    const Scene coarse = dam_break_scene<Dim>(coarse_count, usual_smoothing_ratio);
    const Start coarse_rest = fill_bodies(coarse, features_of(coarse));
    const Motions<Dim> moving = prepared<Dim>(coarse, coarse_rest);
    motions = settled(scene, rest, refined(CoarseField<Dim>(coarse_rest, moving), rest, moving.time));
  }
  keep(file, motions);
  return motions;
}

}  // namespace

template <int Dim, class Real> State<Dim, Real> moving_dam_break(long long count, double smoothing_ratio) {
  const Scene scene = dam_break_scene<Dim>(count, smoothing_ratio);
  const Start rest = fill_bodies(scene, features_of(scene));
  return state_in_motion<Dim, Real>(scene, rest, prepared<Dim>(scene, rest));
}

template Scene dam_break_scene<2>(long long, double);
template Scene dam_break_scene<3>(long long, double);
template State<2, float> moving_dam_break(long long, double);
template State<2, double> moving_dam_break(long long, double);
template State<3, float> moving_dam_break(long long, double);
template State<3, double> moving_dam_break(long long, double);

}  // namespace molten::bench
