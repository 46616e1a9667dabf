// Walls that move, from a scene.
#pragma once

#include <vector>

#include "core/bodies.h"
#include "core/boundary/triangle_mesh.h"
#include "core/scene.h"
#include "core/snapshot.h"

namespace molten {

/// The bodies among the walls of the scene (build_walls), in their order; brings their walls into the bodies' frames.
/// Throws Error(geometry) for a free body whose surface is not closed.
template <int Dim> Bodies<Dim> take_bodies(const Scene& scene, std::vector<Wall<Dim>>& walls);

/// A mesh in a body's frame, brought to where the body is.
TriangleMesh placed(TriangleMesh mesh, const SnapshotBody& body);

}  // namespace molten
