// Where a picture is seen from. Everything that is drawn is moved to the point looked at and scaled by the distance to
// it while still in double, so that float rays are as good in a scene of a millimetre as 10 km from the origin.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "io/picture/render.h"

namespace molten::picture {

using Vec3f = Eigen::Vector3f;

/// An axis-aligned box (m); empty until something finite has been added.
struct Bounds {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);

  bool empty() const { return low.x() > high.x(); }
  void add(const Vec3& point);
  bool holds(const Vec3& point) const;
  Vec3 middle() const { return 0.5 * (low + high); }
  Vec3 size() const { return high - low; }
};

struct Ray {
  Vec3f origin, direction;  // in view units; the direction has length 1
};

struct Camera {
  Vec3 look_at = Vec3::Zero();                   // m; the origin of view units
  double distance = 1;                           // m; the length of a view unit
  Vec3f right, up, toward_eye;                   // length 1
  float half_width = 0.3f, half_height = 0.22f;  // of the picture at the point looked at, in view units
  float shift = 0;                               // moves the scene to the left by this, to leave room for a legend
  bool flat = false;                             // parallel rays (2-D)
  int width = 0, height = 0;                     // pixels

  Vec3f to_view(const Vec3& point) const { return ((point - look_at) / distance).cast<float>(); }
  float pixel() const { return 2 * half_height / static_cast<float>(height); }  // view units at the point looked at
  Ray ray(float x, float y) const;  // x, y: pixels from the upper left corner
};

/// What should be in view: the fluid but for a few strays, and boundaries that are not much larger.
struct Subject {
  Bounds bounds;
  std::vector<Vec3> points;  // m; a selection that fills it
};

Subject subject(const Snapshot& snapshot, const TriangleMesh& boundary);

/// Throws Error(usage) when the options make no camera.
Camera make_camera(const Subject& subject, int dimensions, const PictureOptions& options, bool legend);

/// The options with eye and look_at filled in so that all the snapshots fit: for a film, whose camera must not follow
/// every particle. Give it the first and the last frame.
PictureOptions with_fixed_view(PictureOptions options, std::span<const Snapshot> snapshots,
                               const TriangleMesh& boundary);

}  // namespace molten::picture
