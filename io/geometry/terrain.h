// Height grids: ESRI ASCII (.asc) and JSON {"width": columns, "height": rows, "values": [...]}.
#pragma once

#include <filesystem>
#include <vector>

#include "core/boundary/triangle_mesh.h"
#include "core/scene.h"

namespace molten {

/// Rows from south to north, columns from west to east; metres.
struct HeightGrid {
  int columns = 0, rows = 0;
  double cell_size = 0;
  Vec2 origin = Vec2::Zero();  // x, y of the south-west sample
  std::vector<double> heights;

  double at(int column, int row) const { return heights[static_cast<std::size_t>(row) * columns + column]; }
};

/// Throws Error(geometry) naming file and line or index: missing, ragged row, no-data, non-finite, fewer than 2 × 2.
HeightGrid read_terrain(const Terrain& terrain, const std::filesystem::path& file);

/// Two upward triangles a grid cell.
TriangleMesh triangulate(const HeightGrid& grid);

}  // namespace molten
