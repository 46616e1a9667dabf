// Can fluid get out of what holds it? For `molten check`.
#pragma once

#include <optional>

#include "core/boundary/contact.h"
#include "core/parameters.h"
#include "core/scene.h"

namespace molten {

/// A way for particles from the fluid to outside the box around the fixed walls (planes and terrain left out), without
/// rising above the fluid's top.
template <int Dim> struct Leak {
  Point<Dim> narrowest, exit;  // m; where the way passes nearest to walls, and where it leaves the box
};

/// Floods the space from the fluid in steps of half a spacing, with particles as thick as the run's: a hole of one and
/// a half spacings is always found, one of a single spacing where a step goes through it. Empty: none found; also where
/// walls are planes or terrain alone, do not surround the fluid, or are so large that more than `most_cells` cells
/// would have to be looked at.
template <int Dim>
std::optional<Leak<Dim>> find_leak(const Scene& scene, const Start& start, const std::vector<Wall<Dim>>& walls,
                                   const Contact<Dim>& contact, std::size_t most_cells = 1000000);

}  // namespace molten
