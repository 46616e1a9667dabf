// Defects of a triangle surface.
#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "core/boundary/shapes.h"
#include "core/error.h"
#include "io/geometry/mesh_file.h"

namespace molten {
namespace {

struct Edge {
  std::int32_t low, high;
  bool forward;  // walked from low to high
};

/// The edges of all triangles, the same edge's walks together. Of a triangle that names a vertex twice, the two walks
/// that remain cancel.
std::vector<Edge> sorted_edges(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = t[k], b = t[(k + 1) % 3];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  return edges;
}

bool is_degenerate(const TriangleMesh& mesh, const std::array<std::int32_t, 3>& t) {
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return (b - a).cross(c - a).norm() <= 1e-12 * longest;
}

std::string text(double value) {
  std::string digits = std::to_string(value);
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.ends_with('.')) digits.pop_back();
  return digits;
}

std::string first_at(const Vec3& v) {
  return ", the first at (" + text(v.x()) + ", " + text(v.y()) + ", " + text(v.z()) + ") m";
}

}  // namespace

MeshReport inspect(const TriangleMesh& mesh) {
  MeshReport report;
  const std::vector<Edge> edges = sorted_edges(mesh);
  for (std::size_t i = 0; i < edges.size();) {
    const Edge& edge = edges[i];
    long balance = 0, walks = 0;
    for (; i < edges.size() && edges[i].low == edge.low && edges[i].high == edge.high; ++i, ++walks)
      balance += edges[i].forward ? 1 : -1;
    if (balance == 0) continue;  // walked as often one way as the other: closed here
    if (report.open_edges + report.flipped_edges == 0)
      report.first_defect = (mesh.vertices[edge.low] + mesh.vertices[edge.high]) / 2;
    ++(walks % 2 ? report.open_edges : report.flipped_edges);
  }
  for (const auto& t : mesh.triangles) {
    if (!is_degenerate(mesh, t)) continue;
    if (report.open_edges + report.flipped_edges + report.degenerate_triangles == 0)
      report.first_defect = mesh.vertices[t[0]];
    ++report.degenerate_triangles;
  }
  report.volume = signed_volume(mesh);
  return report;
}

void require_closed(const TriangleMesh& mesh, const std::string& name) {
  if (mesh.empty()) throw Error(ExitCode::geometry, name + ": the mesh has no triangles");
  const MeshReport report = inspect(mesh);
  if (report.open_edges > 0)
    throw Error(ExitCode::geometry, name + ": the surface is not closed: " + std::to_string(report.open_edges) +
                                        " open edges" + first_at(report.first_defect) +
                                        ": close the holes (in Blender: Mesh, Clean Up, Fill Holes)");
  if (report.flipped_edges > 0)
    throw Error(ExitCode::geometry,
                name + ": neighbouring triangles face opposite ways: " + std::to_string(report.flipped_edges) +
                    " edges" + first_at(report.first_defect) +
                    ": orient them alike (in Blender: Mesh, Normals, Recalculate Outside)");
  if (!(report.volume > 0))
    throw Error(ExitCode::geometry,
                name + (report.volume < 0 ? ": the surface is inside out: flip its normals (in "
                                            "Blender: Mesh, Normals, Recalculate Outside)"
                                          : ": the surface encloses no volume: give it a thickness"));
}

}  // namespace molten
