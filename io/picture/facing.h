// Which side of a wall the fluid is on, so that one can look through the near walls of a tank at what is inside.
#pragma once

#include <span>

#include "io/picture/ray_scene.h"

namespace molten::picture {

struct FacedWalls {
  Walls two_sided;
  Walls one_sided;  // normals turned towards the fluid
};

/// Sends a few rays from every connected part of the walls and asks on which side they meet fluid. Parts that see none,
/// or see it on both sides, stay two-sided.
FacedWalls face_fluid(const Walls& walls, std::span<const Vec3f> centers, float radius);

}  // namespace molten::picture
