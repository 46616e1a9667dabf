// What can be run and is seldom meant: for `molten check`, and as notes before a run.
#pragma once

#include <string>
#include <vector>

#include "core/boundary/contact.h"
#include "core/parameters.h"
#include "core/scene.h"

namespace molten {

/// A line each, with place and cure: fluid above the back of a one-sided wall, vents narrower than a particle,
/// kernels that reach too few neighbours, walls that particles on both sides see each other through. `walls`: as they
/// are first placed.
template <int Dim>
std::vector<std::string> warnings_of(const Scene& scene, const Start& start, const std::vector<Wall<Dim>>& walls);

}  // namespace molten
