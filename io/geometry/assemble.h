// From a scene to what a run starts from: meshes read, bodies filled, walls built, everything checked.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/boundary/contact.h"
#include "core/boundary/triangle_mesh.h"
#include "core/features.h"
#include "core/parameters.h"
#include "core/scene.h"
#include "core/state.h"

namespace molten {

/// What a mesh from a file must be: anything; facing outwards, so that it holds from outside; closed, too; or that as a
/// vessel, which could as well be open and hold from both sides.
enum class Demand { none, outward, closed, vessel };

/// The surface of any 3-D shape but a plane, placed.
TriangleMesh surface(const Scene& scene, const Shape& shape, double spacing, Demand demand);

/// A mesh from a file, turned, scaled and placed as the scene asks; open or closed. `waiting` as for read_mesh.
TriangleMesh placed_mesh(const Scene& scene, const MeshFile& file, const std::function<void()>& waiting = {});

/// The walls of a scene for the solver, one for each boundary; those that move as they are first placed in the world.
template <int Dim> std::vector<Wall<Dim>> build_walls(const Scene& scene, double spacing);

/// The same, ready for a run: contact with its particles, walls that move, vents.
template <int Dim>
Surroundings<Dim> build_surroundings(const Scene& scene, const Start& start, const Parameters<Dim>& parameters);
template <int Dim>
Surroundings<Dim> build_surroundings(const Scene& scene, const Start& start, const Parameters<Dim>& parameters,
                                     std::vector<Wall<Dim>> walls);

/// The fixed walls as one surface for pictures (2-D outlines: thin strips); planes become squares about the fluid.
TriangleMesh picture_of_walls(const Scene& scene, const Start& start);

/// The same for each body, in its own frame.
std::vector<TriangleMesh> pictures_of_bodies(const Scene& scene, const Start& start);

/// The bodies filled with particles. Throws Error(usage) when the run would not fit in memory, Error(geometry) for bad
/// meshes.
Start fill_bodies(const Scene& scene, const Features& features);

/// Throws Error(geometry), with the number of particles and the place of the first, if particles start inside a wall or
/// on top of each other. `walls`: as they are first placed, `contact`: with them.
template <int Dim>
void require_no_overlap(const Scene& scene, const Start& start, const std::vector<Wall<Dim>>& walls,
                        const Contact<Dim>& contact);

/// How many of the start's particles are inside a wall; `first`: where the first of them is.
template <int Dim>
std::size_t count_inside_walls(const Scene& scene, const Start& start, const std::vector<Wall<Dim>>& walls,
                               const Contact<Dim>& contact, std::array<double, 3>* first = nullptr);

/// Hash of everything that may not change between a stop and its resume: start, walls, numerics.
std::string fingerprint(const Scene& scene, const Start& start);

}  // namespace molten
