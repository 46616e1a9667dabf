// Pictures of a run: particles as spheres and boundary meshes, ray traced with Embree, coloured by a field with a
// legend.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/boundary/triangle_mesh.h"
#include "core/snapshot.h"

namespace molten {

struct PictureOptions {
  int width = 960, height = 720;               // pixels
  std::string field;                           // name or "name magnitude"; empty: temperature, else speed
  std::optional<std::array<double, 2>> range;  // of the colours; default: the field's range over all frames drawn
  std::optional<std::array<double, 3>> eye, look_at;  // m; default: fits everything in view
  double azimuth = -60, elevation = 20;               // degrees, when no eye is given
  double zoom = 1;
  bool boundaries = true;
};

/// RGB, row by row from the top.
struct Picture {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;
};

Picture draw(const Snapshot& snapshot, const TriangleMesh& boundary, const PictureOptions& options);

/// Throws Error(files).
void write_png(const Picture& picture, const std::filesystem::path& file);

}  // namespace molten
