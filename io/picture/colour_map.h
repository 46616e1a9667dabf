// Perceptually even colour maps, so that equal steps of a field look equal.
#pragma once

#include "io/picture/paint.h"

namespace molten {

/// inferno: dark to glowing, for temperatures; viridis: blue to yellow, for everything else (matplotlib's names).
enum class ColourMap { viridis, inferno };

/// `t` from 0 (lowest) to 1; not-a-number has a colour of its own.
Rgb colour(ColourMap map, double t);

}  // namespace molten
