// The edges of a triangle surface, each with all its walks together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/boundary/triangle_mesh.h"

namespace molten {

/// A triangle's walk along an edge, seen from the lower of its two vertices.
struct EdgeWalk {
  std::int32_t high;
  bool forward;  // walked from low to high
};

/// Calls f(low, high, walks) for every edge, ordered by its vertices. A triangle that names a vertex twice walks its
/// other edge to and fro. (Walks are counted out by their lower vertex, since sorting those of ten million triangles
/// takes seconds.)
template <class F> void for_each_edge(const TriangleMesh& mesh, F&& f) {
  std::vector<std::uint32_t> begin(mesh.vertices.size() + 2, 0);  // of each vertex's walks, one ahead while filling
  const auto for_each_walk = [&](auto&& visit) {
    for (const auto& t : mesh.triangles)
      for (int k = 0; k < 3; ++k)
        if (const std::int32_t a = t[k], b = t[(k + 1) % 3]; a != b)
          visit(std::min(a, b), EdgeWalk{std::max(a, b), a < b});
  };
  for_each_walk([&](std::int32_t low, const EdgeWalk&) { ++begin[low + 2]; });
  for (std::size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<EdgeWalk> walks(begin.back());
  for_each_walk([&](std::int32_t low, const EdgeWalk& walk) { walks[begin[low + 1]++] = walk; });
  for (std::size_t low = 0; low + 2 < begin.size(); ++low) {
    const std::span all(walks.begin() + begin[low], walks.begin() + begin[low + 1]);
    std::stable_sort(all.begin(), all.end(), [](const EdgeWalk& a, const EdgeWalk& b) { return a.high < b.high; });
    for (std::size_t i = 0, end; i < all.size(); i = end) {
      for (end = i + 1; end < all.size() && all[end].high == all[i].high;) ++end;
      f(static_cast<std::int32_t>(low), all[i].high, std::span<const EdgeWalk>(all.subspan(i, end - i)));
    }
  }
}

/// How much more often an edge is walked forwards than backwards; 0: closed here.
inline int balance_of(std::span<const EdgeWalk> walks) {
  int balance = 0;
  for (const EdgeWalk& w : walks) balance += w.forward ? 1 : -1;
  return balance;
}

}  // namespace molten
