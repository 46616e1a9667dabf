#include "io/geometry/mesh_defects.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>

#include "core/boundary/facet_grid.h"

namespace molten {
namespace {

using Triangle = std::array<std::int32_t, 3>;

constexpr const char* fill_holes = "close it (in Blender: Mesh, Clean Up, Fill Holes)";
constexpr const char* orient = "orient the triangles alike (in Blender: Mesh, Normals, Recalculate Outside)";
constexpr const char* merge = "remove it (in Blender: Mesh, Clean Up, Merge by Distance and Degenerate Dissolve)";
constexpr const char* untangle = "untangle the surface there (in Blender: 3D-Print Toolbox, Intersections)";

/// Adds up to `most` defects of one kind.
void add(std::vector<Defect>& all, std::vector<Defect> kind, std::size_t most) {
  const std::size_t count = kind.size();
  if (count > most) {
    kind.resize(most);
    kind.back().what += fmt::format(" (and {} more like it)", count - most);
  }
  all.insert(all.end(), kind.begin(), kind.end());
}

// ---- edges ----------------------------------------------------------------------------------------------------------

struct Edge {
  std::int32_t from, to;  // as walked
};

/// Edges walked once only, and those walked twice the same way.
struct OddEdges {
  std::vector<Edge> open, flipped;
};

OddEdges odd_edges(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      if (t[k] != t[(k + 1) % 3]) edges.push_back({t[k], t[(k + 1) % 3]});
  const auto low = [](const Edge& e) { return std::minmax(e.from, e.to); };
  std::sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) { return low(a) < low(b); });
  OddEdges odd;
  for (std::size_t i = 0, end; i < edges.size(); i = end) {
    int balance = 0;
    for (end = i; end < edges.size() && low(edges[end]) == low(edges[i]); ++end)
      balance += edges[end].from < edges[end].to ? 1 : -1;
    if (balance == 0) continue;
    ((end - i) % 2 ? odd.open : odd.flipped).push_back(edges[i]);
  }
  return odd;
}

/// Open edges that hang together, each group one hole or rim.
std::vector<Defect> holes(const TriangleMesh& mesh, const std::vector<Edge>& open) {
  std::map<std::int32_t, std::int32_t> parent;
  const auto root = [&](std::int32_t v) {
    while (parent.at(v) != v) v = parent[v] = parent.at(parent.at(v));
    return v;
  };
  for (const Edge& e : open) parent.try_emplace(e.from, e.from), parent.try_emplace(e.to, e.to);
  for (const Edge& e : open) parent[root(e.from)] = root(e.to);
  struct Hole {
    std::size_t edges = 0;
    double around = 0;
    Vec3 sum = Vec3::Zero();
  };
  std::map<std::int32_t, Hole> by_root;
  for (const Edge& e : open) {
    const Vec3 &a = mesh.vertices[e.from], &b = mesh.vertices[e.to];
    Hole& hole = by_root[root(e.from)];
    ++hole.edges;
    hole.around += (b - a).norm();
    hole.sum += (a + b) / 2;
  }
  std::vector<std::pair<double, Defect>> sorted;
  for (const auto& [r, hole] : by_root)
    sorted.push_back({-hole.around,
                      {fmt::format("hole or rim of {} edges, {:.4g} m around", hole.edges, hole.around),
                       hole.sum / static_cast<double>(hole.edges), fill_holes}});
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Defect> defects;
  for (auto& [size, defect] : sorted) defects.push_back(std::move(defect));
  return defects;
}

// ---- triangles ------------------------------------------------------------------------------------------------------

Vec3 middle(const TriangleMesh& mesh, const Triangle& t) {
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
}

std::vector<Defect> duplicates(const TriangleMesh& mesh) {
  std::vector<std::int32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](std::int32_t t) {
    Triangle k = mesh.triangles[t];
    std::sort(k.begin(), k.end());
    return k;
  };
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) { return key(a) < key(b); });
  std::vector<Defect> defects;
  for (std::size_t i = 1; i < order.size(); ++i)
    if (key(order[i - 1]) == key(order[i]))
      defects.push_back(
          {fmt::format("triangle {} is there twice", order[i]), middle(mesh, mesh.triangles[order[i]]), merge});
  return defects;
}

std::vector<Defect> without_area(const std::vector<Facet<3>>& facets) {
  std::vector<Defect> defects;
  for (std::size_t f = 0; f < facets.size(); ++f)
    if (facets[f].normal.isZero(0))
      defects.push_back({fmt::format("triangle {} has no area", f), facets[f].corner[0], merge});
  return defects;
}

/// Does the segment a b pass through the inside of the facet? Touching is none.
bool pierces(const Facet<3>& f, const Vec3& a, const Vec3& b, Vec3& where) {
  const double size = std::max((f.corner[1] - f.corner[0]).norm(), (f.corner[2] - f.corner[0]).norm());
  const double above = f.normal.dot(a - f.corner[0]), below = f.normal.dot(b - f.corner[0]), least = 1e-9 * size;
  if (!((above > least && below < -least) || (above < -least && below > least))) return false;
  where = a + above / (above - below) * (b - a);
  for (int k = 0; k < 3; ++k) {
    const Vec3 e = f.corner[(k + 1) % 3] - f.corner[k];
    if (f.normal.cross(e).dot(where - f.corner[k]) <= least * e.norm()) return false;
  }
  return true;
}

std::vector<Defect> crossings(const TriangleMesh& mesh, const std::vector<Facet<3>>& facets) {
  double edges = 0;
  Eigen::AlignedBox3d box;
  for (const Vec3& v : mesh.vertices) box.extend(v);
  for (const auto& f : facets) edges += (f.corner[1] - f.corner[0]).norm();
  const double mean = edges / static_cast<double>(facets.size()), margin = 1e-9 * box.sizes().norm();
  const FacetGrid<3> grid(facets, margin, 2 * mean);
  std::vector<Defect> defects;
  std::vector<std::int32_t> near;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto& c = facets[f].corner;
    near.clear();
    grid.visit_box(c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2]),
                   [&](std::span<const std::int32_t> list) { near.insert(near.end(), list.begin(), list.end()); });
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    Vec3 where;
    for (const std::int32_t g : near) {
      if (g == static_cast<std::int32_t>(f)) continue;
      for (int k = 0; k < 3; ++k) {
        if (!pierces(facets[f], facets[g].corner[k], facets[g].corner[(k + 1) % 3], where)) continue;
        defects.push_back({fmt::format("triangle {} passes through triangle {}", g, f), where, untangle});
        break;
      }
    }
  }
  return defects;
}

}  // namespace

std::vector<Defect> find_defects(const TriangleMesh& mesh, std::size_t most) {
  std::vector<Defect> all;
  if (mesh.empty()) return all;
  std::vector<Facet<3>> facets;
  facets.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    facets.push_back(make_facet<3>({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}));
  const OddEdges odd = odd_edges(mesh);
  add(all, holes(mesh, odd.open), most);
  std::vector<Defect> flipped;
  for (const Edge& e : odd.flipped)
    flipped.push_back(
        {"neighbouring triangles face opposite ways", (mesh.vertices[e.from] + mesh.vertices[e.to]) / 2, orient});
  add(all, std::move(flipped), most);
  add(all, duplicates(mesh), most);
  add(all, without_area(facets), most);
  add(all, crossings(mesh, facets), most);
  return all;
}

}  // namespace molten
