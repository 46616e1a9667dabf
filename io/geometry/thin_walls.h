// Walls that do not part what is on their two sides: pairs of particles know nothing of a wall between them.
#pragma once

#include <string>
#include <vector>

#include "core/boundary/contact.h"
#include "core/parameters.h"

namespace molten {

/// Adds a line for each wall that is thinner than the kernel's reach (m) and has fluid on both sides.
template <int Dim>
void find_thin_walls(const Start& start, const std::vector<Wall<Dim>>& walls, double reach,
                     std::vector<std::string>& found);

}  // namespace molten
