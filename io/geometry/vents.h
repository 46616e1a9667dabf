// Vents, from a scene.
#pragma once

#include "core/boundary/contact.h"
#include "core/parameters.h"
#include "core/vents.h"

namespace molten {

/// `support` (m): of the kernel. Throws Error(geometry) for a patch that is not flat.
template <int Dim> Vents<Dim> build_vents(const Scene& scene, const Start& start, double support);

/// Notes in the start where fluid will enter, and how fast at most.
void describe_vents(const Scene& scene, Start& start);

/// Throws Error(geometry), with vent and place, if what leaves a vent would be inside a wall.
/// `walls`, `contact`: as for require_no_overlap (assemble.h).
template <int Dim>
void require_open_vents(const Scene& scene, const Start& start, const std::vector<Wall<Dim>>& walls,
                        const Contact<Dim>& contact);

}  // namespace molten
