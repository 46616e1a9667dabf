// What is wrong with a triangle surface, where, and what to do about it: for `molten check`.
#pragma once

#include <string>
#include <vector>

#include "core/boundary/triangle_mesh.h"

namespace molten {

struct Defect {
  std::string what;  // such as "hole of 12 edges, 0.3 m around"
  Vec3 place = Vec3::Zero();
  std::string cure;
};

/// Holes, flipped triangles, duplicates, triangles without area, triangles that pass through each other. The largest
/// holes first; of each kind at most `most`, the last of them saying how many there are in all.
std::vector<Defect> find_defects(const TriangleMesh& mesh, std::size_t most = 5);

}  // namespace molten
