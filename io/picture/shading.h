// Light and colour: one lamp with soft shadows, a sky that dims in corners, and a background that large floors fade
// into.
#pragma once

#include <span>

#include "io/picture/paint.h"
#include "io/picture/ray_scene.h"

namespace molten::picture {

/// Everything that the colour of a pixel depends on.
struct Stage {
  const Camera& camera;
  const RayScene& scene;
  std::span<const Rgb> colours;  // of the spheres
  float radius;                  // of the spheres, view units
};

/// The finished picture without text; rows are shared out among threads and the result is the same for any number.
Picture trace(const Stage& stage);

}  // namespace molten::picture
