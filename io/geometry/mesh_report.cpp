// Defects of a triangle surface.
#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "core/boundary/shapes.h"
#include "core/error.h"
#include "io/geometry/mesh_edges.h"
#include "io/geometry/mesh_file.h"

namespace molten {
namespace {

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
  return ", the first at (" + text(v.x()) + ", " + text(v.y()) + ", " + text(v.z()) + ") of the file";
}

}  // namespace

MeshReport inspect(const TriangleMesh& mesh) {
  MeshReport report;
  for_each_edge(mesh, [&](std::int32_t low, std::int32_t high, std::span<const EdgeWalk> walks) {
    if (balance_of(walks) == 0) return;
    if (report.open_edges + report.flipped_edges == 0)
      report.first_defect = (mesh.vertices[low] + mesh.vertices[high]) / 2;
    ++(walks.size() % 2 ? report.open_edges : report.flipped_edges);
  });
  for (const auto& t : mesh.triangles) {
    if (!is_degenerate(mesh, t)) continue;
    if (report.open_edges + report.flipped_edges + report.degenerate_triangles == 0)
      report.first_defect = mesh.vertices[t[0]];
    ++report.degenerate_triangles;
  }
  report.volume = signed_volume(mesh);
  return report;
}

void require_outward(const TriangleMesh& mesh, const std::string& name) {
  const MeshReport report = inspect(mesh);
  if (report.flipped_edges > 0)
    throw Error(ExitCode::geometry,
                name + ": neighbouring triangles face opposite ways: " + std::to_string(report.flipped_edges) +
                    " edges" + first_at(report.first_defect) +
                    ": orient them alike (in Blender: Mesh, Normals, Recalculate Outside)");
  if (report.open_edges == 0 && report.volume < 0)
    throw Error(ExitCode::geometry, name +
                                        ": the surface is inside out: flip its normals (in Blender: Mesh, Normals, "
                                        "Recalculate Outside)");
}

void require_closed(const TriangleMesh& mesh, const std::string& name, const std::string& otherwise) {
  if (mesh.empty()) throw Error(ExitCode::geometry, name + ": the mesh has no triangles");
  const MeshReport report = inspect(mesh);
  if (report.open_edges > 0)
    throw Error(ExitCode::geometry, name + ": the surface is not closed: " + std::to_string(report.open_edges) +
                                        " open edges" + first_at(report.first_defect) +
                                        ": close the holes (in Blender: Mesh, Clean Up, Fill Holes)" + otherwise);
  require_outward(mesh, name);
  if (!(report.volume > 0))
    throw Error(ExitCode::geometry, name + ": the surface encloses no volume: give it a thickness");
}

}  // namespace molten
