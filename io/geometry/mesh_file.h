// Triangle meshes from OBJ, STL (text and binary), PLY and binary glTF files. assimp does the reading in a short-lived
// child process with memory and time limits, so that a hostile file ends in one clear line; what comes back is
// validated here.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/boundary/triangle_mesh.h"

namespace molten {

/// Vertices that share a position are welded. Throws Error(geometry): missing (names the file and the command that
/// fetches the models), unreadable, empty, truncated, non-finite vertex. `waiting` is called about once a second.
TriangleMesh read_mesh(const std::filesystem::path& file, const std::function<void()>& waiting = {});

/// One line a defect, each with where it is; empty: a closed, consistently outward-oriented surface.
struct MeshReport {
  std::size_t open_edges = 0, flipped_edges = 0, degenerate_triangles = 0;
  double volume = 0;                 // m³, signed: negative is inverted
  Vec3 first_defect = Vec3::Zero();  // m; midpoint of the first open or flipped edge
};
MeshReport inspect(const TriangleMesh& mesh);

/// Throws Error(geometry) if neighbouring triangles face opposite ways, or all of a closed mesh's face inwards.
void require_outward(const TriangleMesh& mesh, const std::string& name);

/// Throws Error(geometry) unless the mesh is closed, consistently oriented and not inverted; `name` goes in the line,
/// and so does `otherwise`, what else than closing it helps.
void require_closed(const TriangleMesh& mesh, const std::string& name, const std::string& otherwise = "");

}  // namespace molten
