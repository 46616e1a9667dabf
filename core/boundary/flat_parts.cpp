#include "core/boundary/flat_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>

namespace molten {

namespace {

constexpr double flat = 1e-6;  // 1 − cos of the angle between triangles of one part

Point<3> normal_of(const Wall<3>& wall, std::int32_t triangle) {
  const auto& [a, b, c] = wall.facets[triangle];
  return (wall.vertices[b] - wall.vertices[a]).cross(wall.vertices[c] - wall.vertices[a]).normalized();
}

/// Corners at the same place are one.
std::vector<std::int32_t> joined_corners(const Wall<3>& wall) {
  std::map<std::array<double, 3>, std::int32_t> first;
  std::vector<std::int32_t> joined;
  for (std::int32_t k = 0; k < static_cast<std::int32_t>(wall.vertices.size()); ++k) {
    const Point<3>& x = wall.vertices[k];
    joined.push_back(first.emplace(std::array{x[0], x[1], x[2]}, k).first->second);
  }
  return joined;
}

/// Which part each triangle is of: neighbours across an edge that lie in one plane share theirs.
class Parts {
 public:
  explicit Parts(std::size_t triangles) : parent_(triangles) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::int32_t of(std::int32_t t) const { return parent_[t] == t ? t : of(parent_[t]); }
  void join(std::int32_t a, std::int32_t b) {
    const auto [low, high] = std::minmax({of(a), of(b)});  // values: both are temporary
    parent_[high] = low;
  }

 private:
  std::vector<std::int32_t> parent_;
};

using Edges = std::map<std::array<std::int32_t, 2>, std::vector<std::int32_t>>;  // triangles by their corners

Edges edges_of(const Wall<3>& wall, const std::vector<std::int32_t>& joined) {
  Edges edges;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(wall.facets.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(joined[wall.facets[t][k]], joined[wall.facets[t][(k + 1) % 3]]);
      edges[{a, b}].push_back(t);
    }
  return edges;
}

void add_once(std::vector<Point<3>>& normals, const Point<3>& normal) {
  for (const Point<3>& n : normals)
    if (n.dot(normal) > 1 - flat) return;
  normals.push_back(normal);
}

/// Gives a part its frame: along its longest edge, from its lowest corner on.
void frame(FlatPart& part, const Wall<3>& wall, const Point<3>& longest) {
  part.axis[0] = (longest - longest.dot(part.normal) * part.normal).normalized();
  part.axis[1] = part.normal.cross(part.axis[0]);
  std::array<double, 2> low{1e300, 1e300}, high{-1e300, -1e300};
  for (const std::int32_t t : part.triangles)
    for (const std::int32_t corner : wall.facets[t])
      for (int k = 0; k < 2; ++k) {
        const double at = wall.vertices[corner].dot(part.axis[k]);
        low[k] = std::min(low[k], at);
        high[k] = std::max(high[k], at);
      }
  const double height = wall.vertices[wall.facets[part.triangles[0]][0]].dot(part.normal);
  part.origin = low[0] * part.axis[0] + low[1] * part.axis[1] + height * part.normal;
  for (int k = 0; k < 2; ++k) part.extent[k] = high[k] - low[k];
}

}  // namespace

bool FlatPart::covers(const Wall<3>& wall, const Point<3>& x) const {
  constexpr double slack = 1e-9;  // of the triangle's area
  return std::any_of(triangles.begin(), triangles.end(), [&](std::int32_t t) {
    const auto& facet = wall.facets[t];
    std::array<double, 3> area;
    for (int k = 0; k < 3; ++k) {
      const Point<3>&a = wall.vertices[facet[k]], &b = wall.vertices[facet[(k + 1) % 3]];
      area[k] = (b - a).cross(x - a).dot(normal);
    }
    const double least = -slack * (area[0] + area[1] + area[2]);
    return area[0] >= least && area[1] >= least && area[2] >= least;
  });
}

FlatParts flat_parts_of(const Wall<3>& wall) {
  const std::vector<std::int32_t> joined = joined_corners(wall);
  const Edges edges = edges_of(wall, joined);
  Parts parts(wall.facets.size());
  for (const auto& [ends, triangles] : edges)
    if (triangles.size() == 2 && normal_of(wall, triangles[0]).dot(normal_of(wall, triangles[1])) > 1 - flat)
      parts.join(triangles[0], triangles[1]);

  FlatParts found;
  std::map<std::int32_t, std::size_t> number;  // of a part, by its first triangle
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(wall.facets.size()); ++t) {
    const auto [it, is_new] = number.emplace(parts.of(t), found.parts.size());
    if (is_new) found.parts.emplace_back().normal = normal_of(wall, t);
    found.parts[it->second].triangles.push_back(t);
  }
  std::vector<Point<3>> longest(found.parts.size(), Point<3>::Zero());
  std::map<std::int32_t, std::vector<Point<3>>> corners;
  for (const auto& [ends, triangles] : edges) {
    std::vector<Point<3>> normals;
    for (const std::int32_t t : triangles) add_once(normals, found.parts[number.at(parts.of(t))].normal);
    if (triangles.size() > 1 && normals.size() == 1) continue;  // within a part
    const Point<3>&a = wall.vertices[ends[0]], &b = wall.vertices[ends[1]];
    for (const std::int32_t t : triangles) {
      Point<3>& l = longest[number.at(parts.of(t))];
      if ((b - a).squaredNorm() > l.squaredNorm()) l = b - a;
    }
    for (const std::int32_t end : ends)
      for (const Point<3>& n : normals) add_once(corners[end], n);
    found.edges.push_back({a, b, std::move(normals)});
  }
  for (auto& [end, normals] : corners) found.corners.push_back({wall.vertices[end], std::move(normals)});
  for (std::size_t k = 0; k < found.parts.size(); ++k) frame(found.parts[k], wall, longest[k]);
  return found;
}

}  // namespace molten
