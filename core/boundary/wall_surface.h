// All facets of all walls as one surface: which facets share an edge or a vertex, and where it is convex. Corners at
// exactly the same place are one vertex, so that meshes without shared vertices, and walls that meet, join. The back of
// a two-sided wall is a second, flipped facet; backs join among themselves.
#pragma once

#include <cstdint>
#include <vector>

#include "core/boundary/sweep.h"

namespace molten {

/// What a surface is like at an edge or a vertex.
enum class Crease : std::uint8_t {
  smooth,  // flat or concave, seen from the side of the normals: a sphere always meets a face first
  convex,  // a ridge or tip
  rim      // the surface ends here, or its facets do not fit together
};

template <int Dim> class WallSurface {
 public:
  WallSurface() = default;
  /// Throws Error (geometry) on an index out of range or a coordinate that is not finite.
  explicit WallSurface(const std::vector<Wall<Dim>>& walls);

  const std::vector<Facet<Dim>>& facets() const { return facets_; }
  std::int32_t wall(std::int32_t facet) const { return wall_[facet]; }
  Crease crease(std::int32_t facet, Feature feature, int index) const;

  /// Points to the front side at any feature: face normal, sum of the two at an edge, angle-weighted sum at a vertex
  /// (Bærentzen and Aanæs 2005: its sign against x − nearest point is the side of x, if the mesh is closed). Not unit.
  Point<Dim> pseudo_normal(std::int32_t facet, Feature feature, int index) const;

  /// The facet across edge k, −1 if there is none (3-D).
  std::int32_t neighbour(std::int32_t facet, int k) const { return neighbour_[facet][k]; }

  /// The largest coordinate (m), for the size of round-off.
  double extent() const { return extent_; }

 private:
  void add(const Wall<Dim>& wall, std::int32_t index);
  void add_back(std::int32_t front);
  void join_vertices(const std::vector<Wall<Dim>>& walls);
  void join_edges();
  void sum_normals();
  void mark_vertices();

  std::vector<Facet<Dim>> facets_;
  std::vector<std::int32_t> wall_;
  std::int32_t first_back_ = 0;
  std::vector<std::array<std::int32_t, Dim>> vertex_;   // of each facet's corners
  std::vector<std::array<std::int32_t, 3>> neighbour_;  // 3-D: the facet across each edge, −1 at a rim
  std::vector<std::array<Crease, 3>> edge_crease_;      // 3-D
  std::vector<Point<Dim>> vertex_normal_;
  std::vector<Crease> vertex_crease_;
  double extent_ = 0;
};

}  // namespace molten
