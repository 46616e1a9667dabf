#include "io/picture/facing.h"

#include <cmath>
#include <numeric>
#include <random>

namespace molten::picture {
namespace {

constexpr int most_parts = 2000;  // a soup of single triangles is left as it is
constexpr int probes = 128;       // a part; each sends rays to both sides
constexpr double clear_majority = 0.8;

// Union-find over the vertices; a part is named by one of its vertices.
class Parts {
 public:
  explicit Parts(const Walls& walls) : parent_(walls.vertices.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    for (const auto& [a, b, c] : walls.triangles) {
      parent_[root(a)] = root(b);
      parent_[root(b)] = root(c);
    }
  }
  std::uint32_t root(std::uint32_t vertex) {
    while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
    return vertex;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

class Probe {
 public:
  Probe(const Walls& walls, const RayScene& scene) : walls_(walls), scene_(scene) {}

  /// +1: fluid lies where the normals point to, −1: behind, 0: not clear.
  int side_of_fluid(const std::vector<std::uint32_t>& triangles) {
    int front = 0, back = 0;
    for (int i = 0; i < probes; ++i) {
      const auto& [a, b, c] = walls_.triangles[triangles[random_() % triangles.size()]];
      const Vec3f &p = walls_.vertices[a], &q = walls_.vertices[b], &r = walls_.vertices[c];
      const Vec3f normal = (q - p).cross(r - p).normalized();
      if (!normal.allFinite()) continue;
      const Vec3f start = point_in(p, q, r);
      front += meets_fluid(start, normal);
      back += meets_fluid(start, -normal);
    }
    if (front + back == 0) return 0;
    const double share = static_cast<double>(front) / (front + back);
    return share >= clear_majority ? 1 : share <= 1 - clear_majority ? -1 : 0;
  }

 private:
  float uniform() { return static_cast<float>(random_() >> 8) * 0x1p-24f; }
  Vec3f point_in(const Vec3f& p, const Vec3f& q, const Vec3f& r) {
    const float s = std::sqrt(uniform()), t = uniform();
    return (1 - s) * p + s * (1 - t) * q + s * t * r;
  }
  bool meets_fluid(const Vec3f& start, const Vec3f& normal) {
    const Vec3f anywhere = Vec3f(uniform() - 0.5f, uniform() - 0.5f, uniform() - 0.5f).normalized();
    const Vec3f direction = (normal + 0.95f * anywhere).normalized();
    const float clear = 1e-5f * (1 + start.norm());
    return scene_.first_hit({start + clear * normal, direction}).what == Hit::What::sphere;
  }

  const Walls& walls_;
  const RayScene& scene_;
  std::mt19937 random_{1};
};

}  // namespace

FacedWalls face_fluid(const Walls& walls, std::span<const Vec3f> centers, float radius) {
  FacedWalls faced;
  faced.two_sided.vertices = faced.one_sided.vertices = walls.vertices;
  Parts parts(walls);
  std::vector<std::vector<std::uint32_t>> members(walls.vertices.size());
  int count = 0;
  for (std::uint32_t t = 0; t < walls.triangles.size(); ++t) {
    auto& part = members[parts.root(walls.triangles[t][0])];
    count += part.empty();
    part.push_back(t);
  }
  const RayScene scene(centers, radius, walls, {});
  Probe probe(walls, scene);
  for (const auto& part : members) {
    const int side = part.empty() || count > most_parts || centers.empty() ? 0 : probe.side_of_fluid(part);
    for (const std::uint32_t t : part) {
      const auto [a, b, c] = walls.triangles[t];
      if (side == 0) faced.two_sided.triangles.push_back({a, b, c});
      if (side > 0) faced.one_sided.triangles.push_back({a, b, c});
      if (side < 0) faced.one_sided.triangles.push_back({a, c, b});
    }
  }
  return faced;
}

}  // namespace molten::picture
