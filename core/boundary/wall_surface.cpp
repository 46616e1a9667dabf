#include "core/boundary/wall_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "core/error.h"

namespace molten {
namespace {

constexpr double flat =
    1e-6;  // sine of the angle up to which a convex edge is flat: round-off of single-precision files

/// Two facets whose normals are a and b meet along `edge` (unit, counter-clockwise in a's facet).
Crease crease_between(const Point<3>& a, const Point<3>& b, const Point<3>& edge) {
  const bool folded = a.dot(b) < -1 + flat, degenerate = a.isZero(0) || b.isZero(0);
  return folded || degenerate || a.cross(b).dot(edge) > flat ? Crease::convex : Crease::smooth;
}

/// Segment a ends where b starts.
Crease crease_between(const Point<2>& a, const Point<2>& b) {
  const double turn = a.x() * b.y() - a.y() * b.x();  // negative: away from the left, where the fluid is
  return turn < -flat || (a.dot(b) < 0 && turn <= flat) ? Crease::convex : Crease::smooth;
}

double corner_weight(const Facet<2>&, int) { return 1; }

double corner_weight(const Facet<3>& f, int k) {
  const Point<3> e = f.corner[(k + 1) % 3] - f.corner[k], g = f.corner[(k + 2) % 3] - f.corner[k];
  return std::atan2(e.cross(g).norm(), e.dot(g));
}

struct Side {
  std::int32_t low, high, facet;
  std::int8_t edge, reversed;
};

}  // namespace

template <int Dim> WallSurface<Dim>::WallSurface(const std::vector<Wall<Dim>>& walls) {
  for (std::size_t w = 0; w < walls.size(); ++w)
    if (!walls[w].is_plane) add(walls[w], static_cast<std::int32_t>(w));
  first_back_ = static_cast<std::int32_t>(facets_.size());
  for (std::int32_t f = 0; f < first_back_; ++f)
    if (walls[wall_[f]].two_sided) add_back(f);
  for (const auto& f : facets_)
    for (const auto& c : f.corner) extent_ = std::max(extent_, c.template lpNorm<Eigen::Infinity>());
  join_vertices(walls);
  if constexpr (Dim == 3) join_edges();
  sum_normals();
  mark_vertices();
}

template <int Dim> void WallSurface<Dim>::add(const Wall<Dim>& wall, std::int32_t index) {
  for (const auto& f : wall.facets) {
    std::array<Point<Dim>, Dim> corner;
    for (int k = 0; k < Dim; ++k) {
      const std::string where = "wall " + std::to_string(index) + ": ";
      if (f[k] < 0 || static_cast<std::size_t>(f[k]) >= wall.vertices.size())
        throw Error(ExitCode::geometry,
                    where + "a facet names vertex " + std::to_string(f[k]) + ", which is not there");
      corner[k] = wall.vertices[f[k]];
      if (!corner[k].allFinite())
        throw Error(ExitCode::geometry, where + "vertex " + std::to_string(f[k]) + " is not finite");
    }
    facets_.push_back(make_facet<Dim>(corner));
    wall_.push_back(index);
  }
}

template <int Dim> void WallSurface<Dim>::add_back(std::int32_t front) {
  Facet<Dim> back = facets_[front];
  std::swap(back.corner[0], back.corner[1]);
  back.normal = -back.normal;
  facets_.push_back(back);
  wall_.push_back(wall_[front]);
}

/// Of the walls' vertices that facets name, since these are far fewer than the facets' corners.
template <int Dim> void WallSurface<Dim>::join_vertices(const std::vector<Wall<Dim>>& walls) {
  std::vector<std::int32_t> first(walls.size() + 1, 0);  // of each wall's vertices
  for (std::size_t w = 0; w < walls.size(); ++w)
    first[w + 1] = first[w] + static_cast<std::int32_t>(walls[w].is_plane ? 0 : walls[w].vertices.size());
  std::vector<const Point<Dim>*> place(first.back(), nullptr);  // null: no facet has it
  vertex_.reserve(facets_.size());
  for (std::size_t w = 0; w < walls.size(); ++w) {
    if (walls[w].is_plane) continue;
    for (const auto& f : walls[w].facets) {
      auto& corners = vertex_.emplace_back();
      for (int k = 0; k < Dim; ++k) {
        corners[k] = first[w] + f[k];
        place[corners[k]] = &walls[w].vertices[f[k]];
      }
    }
  }
  std::vector<std::int32_t> order;
  for (std::size_t v = 0; v < place.size(); ++v)
    if (place[v]) order.push_back(static_cast<std::int32_t>(v));
  const auto before = [&](std::int32_t a, std::int32_t b) {
    return std::lexicographical_compare(place[a]->begin(), place[a]->end(), place[b]->begin(), place[b]->end());
  };
  std::sort(order.begin(), order.end(), before);
  std::vector<std::int32_t> joined(place.size(), 0);
  std::int32_t count = 0;
  for (std::size_t i = 0; i < order.size(); ++i)
    joined[order[i]] = i > 0 && !before(order[i - 1], order[i]) ? count - 1 : count++;
  for (auto& corners : vertex_)
    for (std::int32_t& v : corners) v = joined[v];
  for (std::int32_t f = 0; f < first_back_; ++f) {
    if (!walls[wall_[f]].two_sided) continue;
    auto corners = vertex_[f];
    std::swap(corners[0], corners[1]);
    for (std::int32_t& v : corners) v += count;
    vertex_.push_back(corners);
  }
  const auto all = static_cast<std::size_t>(vertex_.size() > static_cast<std::size_t>(first_back_) ? 2 * count : count);
  vertex_normal_.assign(all, Point<Dim>::Zero());
  vertex_crease_.assign(vertex_normal_.size(), Crease::smooth);
}

template <int Dim> void WallSurface<Dim>::join_edges() {
  std::vector<Side> sides;
  for (std::size_t f = 0; f < facets_.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = vertex_[f][k], b = vertex_[f][(k + 1) % 3];
      sides.push_back(
          {std::min(a, b), std::max(a, b), static_cast<std::int32_t>(f), static_cast<std::int8_t>(k), a > b});
    }
  const auto same = [](const Side& s, const Side& t) { return s.low == t.low && s.high == t.high; };
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
    return std::tie(s.low, s.high, s.facet, s.edge) < std::tie(t.low, t.high, t.facet, t.edge);
  });
  neighbour_.assign(facets_.size(), {-1, -1, -1});
  edge_crease_.assign(facets_.size(), {Crease::rim, Crease::rim, Crease::rim});
  for (std::size_t i = 0, end; i < sides.size(); i = end) {
    for (end = i + 1; end < sides.size() && same(sides[i], sides[end]);) ++end;
    if (end - i != 2 || sides[i].reversed == sides[i + 1].reversed) continue;  // a rim, or facets that do not fit
    for (const auto& [here, there] : {std::pair(sides[i], sides[i + 1]), std::pair(sides[i + 1], sides[i])}) {
      const Facet<Dim>&f = facets_[here.facet], &g = facets_[there.facet];
      const Point<Dim> e = (f.corner[(here.edge + 1) % 3] - f.corner[here.edge]).normalized();
      neighbour_[here.facet][here.edge] = there.facet;
      if constexpr (Dim == 3) edge_crease_[here.facet][here.edge] = crease_between(f.normal, g.normal, e);
    }
  }
}

template <int Dim> void WallSurface<Dim>::sum_normals() {
  for (std::size_t f = 0; f < facets_.size(); ++f)
    for (int k = 0; k < Dim; ++k) vertex_normal_[vertex_[f][k]] += corner_weight(facets_[f], k) * facets_[f].normal;
}

/// A vertex is the worst of what ends at it.
template <int Dim> void WallSurface<Dim>::mark_vertices() {
  if constexpr (Dim == 3) {
    for (std::size_t f = 0; f < facets_.size(); ++f)
      for (int c = 0; c < 6; ++c) {
        Crease& worst = vertex_crease_[vertex_[f][(c / 2 + c % 2) % 3]];
        worst = std::max(worst, edge_crease_[f][c / 2]);
      }
  } else {
    std::vector<std::array<std::int32_t, 4>> ends(vertex_normal_.size(),
                                                  {0, 0, -1, -1});  // counts and last: ends, starts
    for (std::size_t f = 0; f < facets_.size(); ++f)
      for (int k = 0; k < 2; ++k) {
        ++ends[vertex_[f][k]][1 - k];
        ends[vertex_[f][k]][3 - k] = static_cast<std::int32_t>(f);
      }
    for (std::size_t v = 0; v < ends.size(); ++v) {
      const auto [n_ends, n_starts, before, after] = ends[v];
      const bool joined = n_ends == 1 && n_starts == 1;
      vertex_crease_[v] = joined ? crease_between(facets_[before].normal, facets_[after].normal) : Crease::rim;
    }
  }
}

template <int Dim> Crease WallSurface<Dim>::crease(std::int32_t facet, Feature feature, int index) const {
  switch (feature) {
    case Feature::face:
      return Crease::smooth;
    case Feature::edge:
      return edge_crease_[facet][index];
    case Feature::vertex:
      break;
  }
  return vertex_crease_[vertex_[facet][index]];
}

template <int Dim> Point<Dim> WallSurface<Dim>::pseudo_normal(std::int32_t facet, Feature feature, int index) const {
  const Point<Dim>& own = facets_[facet].normal;
  if (feature == Feature::face) return own;
  if (feature == Feature::vertex) return vertex_normal_[vertex_[facet][index]];
  const std::int32_t other = neighbour_[facet][index];
  return other < 0 ? own : Point<Dim>(own + facets_[other].normal);
}

template class WallSurface<2>;
template class WallSurface<3>;

}  // namespace molten
