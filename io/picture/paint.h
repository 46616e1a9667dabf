// Colours, and single pixels of a finished picture.
#pragma once

#include <algorithm>

#include "io/picture/render.h"

namespace molten {

/// sRGB, 0 to 1.
struct Rgb {
  float r = 0, g = 0, b = 0;
};

inline Rgb mix(Rgb a, Rgb b, float t) { return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)}; }

inline unsigned char to_byte(float value) {
  return static_cast<unsigned char>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

/// Covers a pixel with this much (0 to 1) of the colour; outside the picture: nothing.
inline void blend(Picture& picture, int x, int y, Rgb colour, float cover) {
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
  unsigned char* pixel = &picture.rgb[3 * (static_cast<std::size_t>(y) * picture.width + x)];
  const Rgb below{pixel[0] / 255.0f, pixel[1] / 255.0f, pixel[2] / 255.0f};
  const Rgb now = mix(below, colour, cover);
  pixel[0] = to_byte(now.r), pixel[1] = to_byte(now.g), pixel[2] = to_byte(now.b);
}

}  // namespace molten
