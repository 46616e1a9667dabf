// Text in pictures: a 5 × 7 font of our own (ASCII and what units need: ° ² ³ · µ …), drawn as smooth strokes.
#pragma once

#include <string_view>

#include "io/picture/paint.h"

namespace molten {

/// `size`: pixels per cell of the 5 × 7 grid. Unknown characters come out as '?'.
void draw_text(Picture& picture, std::string_view text, float left, float top, float size, Rgb colour);

float text_width(std::string_view text, float size);  // pixels
float text_height(float size);                        // pixels, of a capital

}  // namespace molten
