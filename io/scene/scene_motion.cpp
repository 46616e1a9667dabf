#include "io/scene/scene_motion.h"

#include <fmt/format.h>

#include <algorithm>

namespace molten {
namespace {

/// [x, y, z] in 3-D, one number about z in 2-D.
void read_spin(const TomlReader& keys, int dimensions, std::array<double, 3>& spin) {
  if (dimensions == 2)
    keys.number("spin", spin[2], Range::any("degrees/s"));
  else
    keys.numbers("spin", spin, Range::any("degrees/s"));
}

/// Rows of time, shift and, if it turns, angle: [t, x, y, z] or [t, x, y, z, a, b, c]; in 2-D [t, x, y] or [t, x, y,
/// a].
void read_key_frames(const TomlReader& keys, int dimensions, Movement& motion) {
  const std::size_t shift = static_cast<std::size_t>(dimensions) + 1, turn = dimensions == 2 ? 4 : 7;
  std::vector<std::vector<double>> rows;
  if (!keys.rows("key_frames", rows, {shift, turn},
                 dimensions == 2 ? "[t, x, y] or [t, x, y, angle]" : "[t, x, y, z] or [t, x, y, z, a, b, c]"))
    return;
  if (keys.has("velocity") || keys.has("spin"))
    keys.fail("key_frames", "stands beside velocity or spin; keep one of them");
  if (rows.empty()) keys.fail("key_frames", "is empty; give at least one row");
  for (const std::vector<double>& row : rows) {
    auto& frame = motion.key_frames.emplace_back();
    for (std::size_t k = 0; k < shift; ++k) frame[k] = row[k];
    if (row.size() == turn)
      std::copy(row.begin() + static_cast<std::ptrdiff_t>(shift), row.end(), frame.begin() + (dimensions == 2 ? 6 : 4));
  }
  for (std::size_t k = 1; k < motion.key_frames.size(); ++k)
    if (!(motion.key_frames[k - 1][0] < motion.key_frames[k][0]))
      keys.fail("key_frames", fmt::format("row {} is not later than the one before; order them by time", k));
}

Movement read_movement(const TomlReader& boundary_keys, int dimensions) {
  const TomlReader keys = *boundary_keys.table("motion", {"velocity", "spin", "centre", "key_frames"});
  Movement motion;
  keys.vector("velocity", motion.velocity, dimensions, Range::any("m/s"));
  read_spin(keys, dimensions, motion.spin);
  std::array<double, 3> centre{};
  if (keys.vector("centre", centre, dimensions, Range::any("m"))) motion.centre = centre;
  read_key_frames(keys, dimensions, motion);
  if (!keys.has("velocity") && !keys.has("spin") && !keys.has("key_frames"))
    boundary_keys.fail("motion", "says nothing of how it moves; give velocity, spin or key_frames, or leave it out");
  return motion;
}

FreeBody read_body(const TomlReader& boundary_keys, int dimensions) {
  const TomlReader keys = *boundary_keys.table("body", {"density", "velocity", "spin"});
  FreeBody body;
  keys.require("density", "give the body's mean density in kg/m³");
  keys.number("density", body.density, Range::positive("kg/m³"));
  keys.vector("velocity", body.velocity, dimensions, Range::any("m/s"));
  read_spin(keys, dimensions, body.spin);
  return body;
}

}  // namespace

void read_motion(const TomlReader& keys, int dimensions, Boundary& boundary) {
  if (keys.has("motion") && keys.has("body")) keys.fail("body", "stands beside motion; a wall is driven or free");
  if (keys.has("motion")) boundary.motion = read_movement(keys, dimensions);
  if (!keys.has("body")) return;
  if (boundary.shape.plane || boundary.shape.terrain || boundary.inside || boundary.two_sided)
    keys.fail("body", "is for closed shapes with the fluid outside");
  boundary.body = read_body(keys, dimensions);
}

}  // namespace molten
