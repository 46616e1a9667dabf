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

/// Refuses a free body that the fluid would throw about: contact gives each particle the body's velocity, and the body
/// the opposite impulse, as if the others were not there. Where the particles that touch it at once have more than
/// twice its mass, it leaves faster than they came. It may touch as many as half of its surface has places of a spacing
/// (m).
template <int Dim>
void require_stable(const Scene& scene, const std::vector<Wall<Dim>>& walls, const Bodies<Dim>& bodies, double spacing);

/// A mesh in a body's frame, brought to where the body is.
TriangleMesh placed(TriangleMesh mesh, const SnapshotBody& body);

}  // namespace molten
