// Closed triangle meshes and outlines of the shapes that need no file.
#pragma once

#include <vector>

#include "core/boundary/triangle_mesh.h"
#include "core/scene.h"

namespace molten {

/// Closed, outward-oriented surface of a sphere, box, cylinder, cone or extruded polygon. `edge` (m): longest edge
/// wanted on curved parts.
TriangleMesh tessellate(const Shape& shape, double edge);

/// The 2-D outline of a sphere (circle), box (x-y rectangle), cylinder (rectangle base.x ± radius, base.y .. + height),
/// cone (trapezium) or polygon, counter-clockwise, not repeated at the end.
std::vector<Vec2> outline(const Shape& shape, double edge);

/// What lies over an outline with holes (as clip_ears wants them) from z = bottom to z = top (m); closed.
TriangleMesh extrude(const std::vector<std::vector<Vec2>>& rings, double bottom, double top);

/// Enclosed volume of a closed mesh (m³; negative when inverted).
double signed_volume(const TriangleMesh& mesh);

}  // namespace molten
