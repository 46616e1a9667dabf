// Which parts of a line lie inside a closed surface: whole lattice columns are asked at once, so that filling costs one
// ray a column, not one a particle.
#pragma once

#include <memory>
#include <vector>

#include "core/boundary/triangle_mesh.h"

namespace molten {

struct Span {
  double low = 0, high = 0;  // m
};

/// Answers for lines along the last axis (z in 3-D, y in 2-D). Inside is where the winding number is positive, so
/// closed parts that overlap count once.
class Inside {
 public:
  virtual ~Inside() = default;
  /// Replaces `spans` by the inside parts of the line through x (and y), ascending and disjoint.
  virtual void spans(double x, double y, std::vector<Span>& spans) const = 0;
};

/// 3-D, by Embree rays. Throws Error(geometry) on a surface that no ray leaves as often as it enters.
std::unique_ptr<Inside> inside_of(const TriangleMesh& mesh);

/// 2-D.
std::unique_ptr<Inside> inside_of(const std::vector<Vec2>& outline);

}  // namespace molten
