// Contact with walls: the particles of a moving dam break that are near the tank, and all of them asked whether they
// are; a shower of particles on the terrain of scenes/volcano.toml, where its model was fetched; and flights low over
// hills, whose lengths (in hundredths of a grid cell) show where the tree overtakes the grid.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/dam_break.h"
#include "bench/program.h"
#include "core/particle_pass.h"
#include "core/step.h"
#include "io/geometry/assemble.h"
#include "io/scene/scene_file.h"

namespace molten::bench {
namespace {

template <int Dim> struct Shower {
  Contact<Dim> contact;
  std::vector<Motion<Dim>> motions;
  double radius, dt, spacing;  // m, s, m
};

template <int Dim> Motion<Dim> motion_of(const State<Dim, float>& s, std::size_t slot) {
  Motion<Dim> m;
  for (int d = 0; d < Dim; ++d) {
    m.position[d] = s.particles[position][d][slot];
    m.velocity[d] = m.rate[d] = s.particles[velocity][d][slot];
  }
  return m;
}

/// All particles of a dam break, or those that a wall may touch before the next sort.
template <int Dim> Shower<Dim> dam_break(long long count, bool near_only) {
  State<Dim, float> s = moving_dam_break<Dim, float>(count, 1.3);
  step(s);
  std::vector<Motion<Dim>> motions;
  for (std::size_t slot = 0; slot < s.particles.slots(); ++slot) {
    if (s.particles.is_padding(slot)) continue;
    const Motion<Dim> m = motion_of(s, slot);
    if (!near_only || s.contact.may_touch(m.position, s.parameters.spacing)) motions.push_back(m);
  }
  return {std::move(s.contact), std::move(motions), s.parameters.spacing / 2, s.clock.dt, s.parameters.spacing};
}

/// Particles on a terrain's surface that fall on it at random slants, up to half a spacing a step.
Shower<3> terrain(const std::filesystem::path& scene_file) {
  const Scene scene = read_scene(scene_file);
  const Start start = fill_bodies(scene, features_of(scene));
  const std::vector<Wall<3>> walls = build_walls<3>(scene, start.spacing);
  Contact<3> contact(walls, start.spacing / 2, 2.6 * start.spacing);
  std::vector<Motion<3>> motions;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> of(-1, 1);
  for (const Wall<3>& wall : walls)
    for (const auto& facet : wall.facets) {
      const Point<3>&a = wall.vertices[facet[0]], &b = wall.vertices[facet[1]], &c = wall.vertices[facet[2]];
      const Point<3> normal = (b - a).cross(c - a).normalized();
      Motion<3> m;
      m.position = (a + b + c) / 3 + 0.75 * start.spacing * normal;
      m.velocity = m.rate = 0.5 * start.spacing * (Point<3>(of(random), of(random), of(random)) - normal);
      motions.push_back(m);
    }
  return {std::move(contact), std::move(motions), start.spacing / 2, 1.0, start.spacing};
}

/// The walls by brute force: a particle that met none has just moved, one that bounced is outside all of them.
template <int Dim> std::string check_moves(const Shower<Dim>& shower) {
  const double radius = shower.radius;
  for (std::size_t k = 0; k < shower.motions.size(); k += 1 + shower.motions.size() / 1000) {
    Motion<Dim> m = shower.motions[k];
    const Point<Dim> straight = m.position + shower.dt * m.rate;
    const bool overlapped = shower.contact.signed_distance(m.position, 2 * radius) < radius * (1 - 1e-6);
    const int bounces = shower.contact.move(m, shower.dt);
    const double distance = shower.contact.signed_distance(m.position, 2 * radius);
    if (bounces == 0 && (m.position - straight).norm() > 1e-12 * (1 + straight.norm()))
      return fmt::format("particle {} was moved aside without a bounce", k);
    if (!overlapped && bounces < 8 && distance < radius * (1 - 1e-4))
      return fmt::format("particle {} ends {} m from a wall, radius {} m", k, distance, radius);
  }
  return "";
}

template <int Dim> void time_moves(benchmark::State& bench, const Shower<Dim>& shower, bool only_ask) {
  if (const std::string wrong = check_moves(shower); !wrong.empty()) return bench.SkipWithError(wrong.c_str());
  const std::size_t count = shower.motions.size();
  std::vector<int> bounces(count);
  const Stopwatch watch;
  for (auto _ : bench)
    for_each_slot(count, [&](std::size_t k) {
      Motion<Dim> m = shower.motions[k];
      bounces[k] = only_ask ? shower.contact.may_touch(m.position, shower.spacing) : shower.contact.move(m, shower.dt);
    });
  const double elapsed = watch.seconds(), all = static_cast<double>(count) * static_cast<double>(bench.iterations());
  bench.counters["particle_steps/s"] = all / elapsed;
  bench.counters["ns_per_particle"] = 1e9 * elapsed / all;
  bench.counters["touching"] =
      static_cast<double>(count - std::count(bounces.begin(), bounces.end(), 0)) / static_cast<double>(count);
}

/// Of the hills at x and y, parts of the square's side; over the side.
double height_at(double x, double y) { return 0.02 * (std::sin(9 * x) + std::cos(7 * y)); }

/// Hills of n × n cells, two triangles each, over a square whose side is `side` m.
Wall<3> hills(int n, double side) {
  Wall<3> wall;
  const double step = side / n;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      wall.vertices.push_back({i * step, j * step, side * height_at(double(i) / n, double(j) / n)});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      wall.facets.push_back({a, b, d});
      wall.facets.push_back({a, d, c});
    }
  return wall;
}

/// Particles that fly low over 524288 triangles, somewhat smaller than a cell, so many cells far a step; some hit.
Shower<3> flights(SearchMethod method, double cells) {
  constexpr int n = 512;
  constexpr double radius = 0.05, cell = 5.2 * radius, side = 0.4 * n * cell;
  Shower<3> shower{Contact<3>({hills(n, side)}, radius, cell, method), {}, radius, 1.0, 2 * radius};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> of(0, 1);
  while (shower.motions.size() < 4096) {
    const double angle = 2 * M_PI * of(random), dip = 0.2 * (of(random) - 0.7);
    const Point<3> way = cells * cell * Point<3>(std::cos(angle), std::sin(angle), dip).normalized();
    const double x = of(random), y = of(random);
    const Point<3> start(side * x, side * y, 2 * radius + side * (height_at(x, y) + 0.03 * of(random)));
    shower.motions.push_back({start, way, way});
  }
  return shower;
}

template <int Dim, class Make> void add_moves(const std::string& name, bool only_ask, Make make) {
  auto kept = std::make_shared<std::unique_ptr<Shower<Dim>>>();
  add(name, [=](benchmark::State& bench) {
    if (!*kept) *kept = std::make_unique<Shower<Dim>>(make());
    time_moves(bench, **kept, only_ask);
  });
}

}  // namespace
}  // namespace molten::bench

int main(int argc, char** argv) {
  using namespace molten::bench;
  using molten::SearchMethod;
  return run_program(argc, argv, [] {
    add_moves<3>("contact/move/tank/3d/100k", false, [] { return dam_break<3>(100000, true); });
    add_moves<3>("contact/may_touch/tank/3d/100k", true, [] { return dam_break<3>(100000, false); });
    add_moves<2>("contact/move/tank/2d/100k", false, [] { return dam_break<2>(100000, true); });
    for (const int hundredths : {2, 25, 50, 100, 400, 6400})
      for (const auto& [name, method] : {std::pair("grid", SearchMethod::grid), std::pair("tree", SearchMethod::tree),
                                         std::pair("rule", SearchMethod::by_rule)})
        add_moves<3>(fmt::format("contact/hills/{}/{}", name, hundredths), false,
                     [=, how = method] { return flights(how, hundredths / 100.0); });
    const std::filesystem::path scenes = std::filesystem::path(MOLTEN_SOURCE_DIR) / "scenes";
    if (std::filesystem::exists(scenes / "models/volcano.json"))
      add_moves<3>("contact/move/terrain/3d", false, [=] { return terrain(scenes / "volcano.toml"); });
  });
}
