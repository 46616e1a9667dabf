#include "io/picture/colour_map.h"

#include <array>
#include <cmath>

namespace molten {
namespace {

constexpr int points = 9;
using Ramp = std::array<std::array<unsigned char, 3>, points>;

// Control points of matplotlib's maps (S. van der Walt and N. Smith, CC0), evenly spaced.
constexpr Ramp viridis = {{{68, 1, 84},
                           {71, 45, 123},
                           {59, 82, 139},
                           {44, 114, 142},
                           {33, 145, 140},
                           {40, 174, 128},
                           {94, 201, 98},
                           {173, 220, 48},
                           {253, 231, 37}}};
constexpr Ramp inferno = {{{0, 0, 4},
                           {34, 12, 76},
                           {87, 16, 110},
                           {137, 34, 106},
                           {188, 55, 84},
                           {227, 89, 51},
                           {249, 142, 9},
                           {249, 203, 53},
                           {252, 255, 164}}};
// Inferno's black hides the shading of a body and its pale end vanishes on white: leave both out.
constexpr double inferno_from = 0.14, inferno_to = 0.95;
constexpr Rgb not_a_number{1.0f, 0.0f, 1.0f};

Rgb on_ramp(const Ramp& ramp, double t) {
  const double place = t * (points - 1);
  const int below = std::min(static_cast<int>(place), points - 2);
  const auto rgb = [&](int i) { return Rgb{ramp[i][0] / 255.0f, ramp[i][1] / 255.0f, ramp[i][2] / 255.0f}; };
  return mix(rgb(below), rgb(below + 1), static_cast<float>(place - below));
}

}  // namespace

Rgb colour(ColourMap map, double t) {
  if (std::isnan(t)) return not_a_number;
  t = std::clamp(t, 0.0, 1.0);
  return map == ColourMap::viridis ? on_ramp(viridis, t)
                                   : on_ramp(inferno, inferno_from + t * (inferno_to - inferno_from));
}

}  // namespace molten
