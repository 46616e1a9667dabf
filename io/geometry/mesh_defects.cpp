#include "io/geometry/mesh_defects.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <compare>
#include <map>
#include <optional>

#include "core/boundary/facet_grid.h"
#include "core/particle_pass.h"
#include "io/geometry/mesh_edges.h"

namespace molten {
namespace {

using Triangle = std::array<std::int32_t, 3>;

constexpr std::size_t facets_a_piece = 4096;

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
  OddEdges odd;
  for_each_edge(mesh, [&](std::int32_t low, std::int32_t high, std::span<const EdgeWalk> walks) {
    if (balance_of(walks) == 0) return;
    const Edge first = walks[0].forward ? Edge{low, high} : Edge{high, low};
    (walks.size() % 2 ? odd.open : odd.flipped).push_back(first);
  });
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

/// All but the first of those with the same corners.
std::vector<Defect> duplicates(const TriangleMesh& mesh) {
  struct Corners {
    std::int32_t middle, high, triangle;
    auto operator<=>(const Corners&) const = default;
  };
  std::vector<std::uint32_t> begin(mesh.vertices.size() + 2, 0);  // by the lowest corner, one ahead while filling
  for (const Triangle& t : mesh.triangles) ++begin[*std::min_element(t.begin(), t.end()) + 2];
  for (std::size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<Corners> all(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle k = mesh.triangles[t];
    std::sort(k.begin(), k.end());
    all[begin[k[0] + 1]++] = {k[1], k[2], static_cast<std::int32_t>(t)};
  }
  std::vector<Defect> defects;
  for (std::size_t v = 0; v + 2 < begin.size(); ++v) {
    std::sort(all.begin() + begin[v], all.begin() + begin[v + 1]);
    for (std::size_t i = begin[v] + 1; i < begin[v + 1]; ++i) {
      const Corners &a = all[i - 1], &b = all[i];
      if (a.middle == b.middle && a.high == b.high)
        defects.push_back(
            {fmt::format("triangle {} is there twice", b.triangle), middle(mesh, mesh.triangles[b.triangle]), merge});
    }
  }
  return defects;
}

std::vector<Defect> without_area(const std::vector<Facet<3>>& facets) {
  std::vector<Defect> defects;
  for (std::size_t f = 0; f < facets.size(); ++f)
    if (facets[f].normal.isZero(0))
      defects.push_back({fmt::format("triangle {} has no area", f), facets[f].corner[0], merge});
  return defects;
}

/// Where a segment meets a facet.
struct Hit {
  enum class Part { inside, rim } part = Part::inside;
  int from = 0;  // 1, −1: the segment comes from the front, from the back; 0: it touches the facet at most
  Vec3 where = Vec3::Zero();
};

Hit meet(const Facet<3>& f, const Vec3& a, const Vec3& b) {
  const double size = std::max((f.corner[1] - f.corner[0]).norm(), (f.corner[2] - f.corner[0]).norm());
  const double above = f.normal.dot(a - f.corner[0]), below = f.normal.dot(b - f.corner[0]), least = 1e-9 * size;
  if (!((above > least && below < -least) || (above < -least && below > least))) return {};
  Hit hit{Hit::Part::inside, above > 0 ? 1 : -1, a + above / (above - below) * (b - a)};
  for (int k = 0; k < 3; ++k) {
    const Vec3 e = f.corner[(k + 1) % 3] - f.corner[k];
    const double inwards = f.normal.cross(e).dot(hit.where - f.corner[k]);
    if (inwards < -least * e.norm()) return {};
    if (inwards <= least * e.norm()) hit.part = Hit::Part::rim;
  }
  return hit;
}

/// A hit on the edge or corner that some facets share goes through them if it comes from the same side of all.
bool goes_through(const std::vector<Hit>& rims, const Hit& hit, double nearby) {
  const auto there = [&](const Hit& h) { return (h.where - hit.where).norm() <= nearby; };
  return std::count_if(rims.begin(), rims.end(), there) > 1 &&
         std::none_of(rims.begin(), rims.end(), [&](const Hit& h) { return there(h) && h.from != hit.from; });
}

/// Does the segment a b pass through one of the facets, and where? Touching is none. The facet, or none.
std::optional<std::int32_t> pierced(const std::vector<Facet<3>>& facets, std::span<const std::int32_t> near,
                                    const Vec3& a, const Vec3& b, Vec3& where) {
  std::vector<Hit> rims;
  std::vector<std::int32_t> rim_of;
  for (const std::int32_t f : near) {
    const Hit hit = meet(facets[f], a, b);
    if (hit.from == 0) continue;
    if (hit.part == Hit::Part::inside) return where = hit.where, f;
    rims.push_back(hit), rim_of.push_back(f);
  }
  for (std::size_t k = 0; k < rims.size(); ++k)
    if (goes_through(rims, rims[k], 1e-9 * (b - a).norm())) return where = rims[k].where, rim_of[k];
  return std::nullopt;
}

/// Those that the edges of one facet make; `near` is scratch.
void add_crossings(std::vector<Defect>& defects, const std::vector<Facet<3>>& facets, std::size_t g,
                   const FacetGrid<3>& grid, std::vector<std::int32_t>& near) {
  const auto& c = facets[g].corner;
  near.clear();
  grid.visit_box(c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2]),
                 [&](std::span<const std::int32_t> list) { near.insert(near.end(), list.begin(), list.end()); });
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  std::erase(near, static_cast<std::int32_t>(g));
  Vec3 where;
  for (int k = 0; k < 3; ++k)
    if (const auto f = pierced(facets, near, c[k], c[(k + 1) % 3], where)) {
      defects.push_back({fmt::format("triangle {} passes through triangle {}", g, *f), where, untangle});
      break;
    }
}

std::vector<Defect> crossings(const TriangleMesh& mesh, const std::vector<Facet<3>>& facets) {
  double edges = 0;
  Eigen::AlignedBox3d box;
  for (const Vec3& v : mesh.vertices) box.extend(v);
  for (const auto& f : facets) edges += (f.corner[1] - f.corner[0]).norm();
  const double mean = edges / static_cast<double>(facets.size()), margin = 1e-9 * box.sizes().norm();
  const FacetGrid<3> grid(facets, margin, 2 * mean);
  const std::size_t pieces = (facets.size() + facets_a_piece - 1) / facets_a_piece;
  std::vector<std::vector<Defect>> found(pieces);
  for_each_piece_with(pieces, std::vector<std::int32_t>(), [&](std::size_t piece, std::vector<std::int32_t>& near) {
    const std::size_t end = std::min(facets.size(), (piece + 1) * facets_a_piece);
    for (std::size_t g = piece * facets_a_piece; g < end; ++g) add_crossings(found[piece], facets, g, grid, near);
  });
  std::vector<Defect> defects;
  for (auto& some : found) defects.insert(defects.end(), some.begin(), some.end());
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
