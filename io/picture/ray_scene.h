// What rays can hit: spheres and walls in view units, in an Embree tree.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "io/picture/camera.h"

namespace molten::picture {

/// Triangles in view units.
struct Walls {
  std::vector<Vec3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct Hit {
  enum class What { nothing, sphere, wall } what = What::nothing;
  unsigned index = 0;  // of the sphere
  Vec3f point, normal;
};

class RayScene {
 public:
  /// `one_sided` walls are seen only from the side that their triangles' normals point to, and let light through from
  /// behind: so one looks into a tank. Throws Error(files) when Embree can't start.
  RayScene(std::span<const Vec3f> centers, float radius, const Walls& two_sided, const Walls& one_sided);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  Hit first_hit(const Ray& ray) const;

  static constexpr int rays = 8;
  /// Which of the directions from `origin` are free for `reach`: 1 free, 0 blocked.
  std::array<float, rays> free_ways(const Vec3f& origin, const std::array<Vec3f, rays>& directions,
                                    const std::array<float, rays>& reach) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace molten::picture
