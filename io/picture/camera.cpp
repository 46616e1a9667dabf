#include "io/picture/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace molten::picture {
namespace {

constexpr double radians = std::numbers::pi / 180;
constexpr double half_view = 13 * radians;  // half the vertical angle of view
constexpr double margin = 0.85;             // of the picture, for what should be in view
constexpr double legend_share = 0.13;       // of the picture's half width, left to the legend when fitting
constexpr double strays = 0.002;            // share of particles at either end of an axis that may be out of view
constexpr std::size_t most_points = 20000;  // looked at when fitting
constexpr double largest_boundary = 4;      // times the fluid: larger boundaries are cut off by the picture's edge

Vec3 to_vec(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

void quantiles(std::vector<double>& values, double share, double& low, double& high) {
  const auto skip = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), values.begin() + skip, values.end());
  low = values[skip];
  std::nth_element(values.begin(), values.end() - 1 - skip, values.end());
  high = *(values.end() - 1 - skip);
}

Bounds fluid_bounds(const Snapshot& snapshot) {
  Bounds bounds;
  std::array<std::vector<double>, 3> axes;
  for (std::size_t i = 0; i < snapshot.count(); ++i) {
    const double* p = &snapshot.position[3 * i];
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) continue;
    for (int axis = 0; axis < 3; ++axis) axes[axis].push_back(p[axis]);
  }
  if (axes[0].empty()) return bounds;
  for (int axis = 0; axis < 3; ++axis) quantiles(axes[axis], strays, bounds.low[axis], bounds.high[axis]);
  bounds.low.array() -= 0.5 * snapshot.spacing;
  bounds.high.array() += 0.5 * snapshot.spacing;
  return bounds;
}

void add_corners(std::vector<Vec3>& points, const Bounds& box) {
  for (int corner = 0; corner < 8; ++corner)
    points.emplace_back(corner & 1 ? box.high.x() : box.low.x(), corner & 2 ? box.high.y() : box.low.y(),
                        corner & 4 ? box.high.z() : box.low.z());
}

// The distance from the point looked at, from which all points are inside the picture.
double fitting_distance(const std::vector<Vec3>& points, const Camera& camera, double room_x, double room_y) {
  double distance = 0;
  for (const Vec3& point : points) {
    const Vec3 offset = point - camera.look_at;
    const double nearer = camera.flat ? 0 : offset.dot(camera.toward_eye.cast<double>());
    distance = std::max(distance, nearer + std::abs(offset.dot(camera.right.cast<double>())) / room_x);
    distance = std::max(distance, nearer + std::abs(offset.dot(camera.up.cast<double>())) / room_y);
  }
  return distance > 0 ? distance : 1;
}

void set_axes(Camera& camera, const Vec3& toward_eye) {
  if (camera.flat) {
    camera.toward_eye = Vec3f::UnitZ(), camera.right = Vec3f::UnitX(), camera.up = Vec3f::UnitY();
    return;
  }
  const Vec3 direction = toward_eye.normalized();
  Vec3 right = Vec3::UnitZ().cross(direction);
  if (right.norm() < 1e-6) right = Vec3::UnitX();  // straight from above or below
  right.normalize();
  camera.toward_eye = direction.cast<float>();
  camera.right = right.cast<float>();
  camera.up = direction.cross(right).cast<float>();
}

void check(const PictureOptions& options) {
  const auto refuse = [](const std::string& reason) { throw Error(ExitCode::usage, "picture: " + reason); };
  if (options.width < 16 || options.height < 16 || options.width > 16384 || options.height > 16384)
    refuse("width and height must be 16 to 16384 pixels");
  if (!(options.zoom > 0) || !std::isfinite(options.zoom)) refuse("zoom must be positive");
  if (!std::isfinite(options.azimuth) || !std::isfinite(options.elevation)) refuse("angles must be numbers");
  for (const auto& point : {options.eye, options.look_at})
    if (point && !to_vec(*point).allFinite()) refuse("eye and look_at must be numbers");
  if (options.range && !((*options.range)[0] <= (*options.range)[1])) refuse("the colours' range must be low, high");
}

}  // namespace

void Bounds::add(const Vec3& point) {
  if (!point.allFinite()) return;
  low = low.cwiseMin(point);
  high = high.cwiseMax(point);
}

Ray Camera::ray(float x, float y) const {
  const float across = (2 * x / static_cast<float>(width) - 1) * half_width + shift;
  const float upward = (1 - 2 * y / static_cast<float>(height)) * half_height;
  const Vec3f target = across * right + upward * up;
  if (flat) return {target + toward_eye, -toward_eye};
  return {toward_eye, (target - toward_eye).normalized()};
}

bool Bounds::holds(const Vec3& point) const {
  return (point.array() >= low.array()).all() && (point.array() <= high.array()).all();
}

Subject subject(const Snapshot& snapshot, const TriangleMesh& boundary) {
  Subject all;
  all.bounds = fluid_bounds(snapshot);
  const std::size_t stride = 1 + snapshot.count() / most_points;
  for (std::size_t i = 0; i < snapshot.count(); i += stride) {
    const Vec3 point(snapshot.position[3 * i], snapshot.position[3 * i + 1], snapshot.position[3 * i + 2]);
    if (all.bounds.holds(point)) all.points.push_back(point);
  }
  Bounds walls;
  for (const auto& triangle : boundary.triangles)
    for (const std::int32_t corner : triangle) walls.add(boundary.vertices[corner]);
  const bool large = !all.bounds.empty() && walls.size().norm() > largest_boundary * all.bounds.size().norm();
  if (walls.empty() || large) return all;
  add_corners(all.points, walls);
  all.bounds.add(walls.low);
  all.bounds.add(walls.high);
  return all;
}

PictureOptions with_fixed_view(PictureOptions options, std::span<const Snapshot> snapshots,
                               const TriangleMesh& boundary) {
  static const TriangleMesh none;
  Subject all;
  for (const Snapshot& snapshot : snapshots) {
    const Subject one = subject(snapshot, options.boundaries ? boundary : none);
    all.points.insert(all.points.end(), one.points.begin(), one.points.end());
    all.bounds.add(one.bounds.low);
    all.bounds.add(one.bounds.high);
  }
  const int dimensions = snapshots.empty() ? 3 : snapshots[0].dimensions;
  const Camera camera = make_camera(all, dimensions, options, true);
  const Vec3 eye = camera.look_at + camera.distance * camera.toward_eye.cast<double>();
  options.eye = {eye.x(), eye.y(), eye.z()};
  options.look_at = {camera.look_at.x(), camera.look_at.y(), camera.look_at.z()};
  return options;
}

Camera make_camera(const Subject& subject, int dimensions, const PictureOptions& options, bool legend) {
  check(options);
  Camera camera;
  camera.width = options.width, camera.height = options.height;
  camera.flat = dimensions == 2;
  const double tangent = std::tan(half_view), aspect = static_cast<double>(options.width) / options.height;
  camera.half_height = static_cast<float>(tangent / options.zoom);
  camera.half_width = static_cast<float>(tangent * aspect / options.zoom);
  camera.look_at = options.look_at          ? to_vec(*options.look_at)
                   : subject.bounds.empty() ? Vec3(Vec3::Zero())
                                            : subject.bounds.middle();
  if (legend) camera.shift = static_cast<float>(camera.half_width * legend_share);

  if (options.eye) {
    const Vec3 toward_eye = to_vec(*options.eye) - camera.look_at;
    if (!(toward_eye.norm() > 0)) throw Error(ExitCode::usage, "picture: eye and look_at are the same point");
    set_axes(camera, toward_eye);
    camera.distance = camera.flat ? std::abs(toward_eye.z()) : toward_eye.norm();
    if (!(camera.distance > 0)) camera.distance = toward_eye.norm();
    return camera;
  }
  const double azimuth = options.azimuth * radians, elevation = options.elevation * radians;
  set_axes(camera,
           {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation), std::sin(elevation)});
  const double room = legend ? 1 - legend_share : 1;
  camera.distance = fitting_distance(subject.points, camera, tangent * aspect * room * margin, tangent * margin);
  return camera;
}

}  // namespace molten::picture
