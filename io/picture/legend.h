// The text on a picture: what the colours mean, and the time.
#pragma once

#include <array>
#include <string>

#include "io/picture/colour_map.h"

namespace molten {

void draw_legend(Picture& picture, const std::string& title, ColourMap map, const std::array<double, 2>& range);
void draw_time(Picture& picture, double time);  // s

}  // namespace molten
