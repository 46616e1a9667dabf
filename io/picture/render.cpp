#include "io/picture/render.h"

#include <cmath>

#include "io/picture/camera.h"
#include "io/picture/colour_field.h"
#include "io/picture/facing.h"
#include "io/picture/legend.h"
#include "io/picture/shading.h"

namespace molten {

using namespace picture;

namespace {

constexpr double disc_radius = 0.7;        // spacings, 2-D
constexpr double sphere_radius = 0.55;     // spacings: neighbours overlap a little, so that the fluid looks closed
constexpr float smallest_radius = 0.6f;    // pixels: particles of a distant body must not fall between the rays
constexpr float wall_thickness = 1.25f;    // pixels; half the line that stands for a wall seen on edge in 2-D
constexpr float farthest = 1e5f;           // view units; beyond it float rays find nothing
constexpr Rgb plain{0.22f, 0.47f, 0.72f};  // without a field

struct Spheres {
  std::vector<Vec3f> centers;
  std::vector<Rgb> colours;
  float radius = 0;
};

std::array<double, 2> colour_range(const ColourField& field, const PictureOptions& options) {
  const std::array<double, 2> range = options.range ? *options.range : field.range().value_or(std::array{0.0, 1.0});
  if (range[1] > range[0]) return range;
  if (range[0] == 0) return {0, 1};
  const double widen = 0.05 * std::abs(range[0]);  // one value for all: the middle of a small range
  return {range[0] - widen, range[1] + widen};
}

Rgb colour_of(const ColourField& field, std::size_t i, const std::array<double, 2>& range) {
  return colour(field.map, (field.values[i] - range[0]) / (range[1] - range[0]));
}

Spheres make_spheres(const Snapshot& snapshot, const Camera& camera, const std::optional<ColourField>& field,
                     const std::array<double, 2>& range) {
  Spheres spheres;
  spheres.radius =
      std::max(static_cast<float>((camera.flat ? disc_radius : sphere_radius) * snapshot.spacing / camera.distance),
               smallest_radius * camera.pixel());
  for (std::size_t i = 0; i < snapshot.count(); ++i) {
    const double* p = &snapshot.position[3 * i];
    const Vec3f center = camera.to_view({p[0], p[1], p[2]});
    if (!(center.norm() < farthest)) continue;  // also what is not a number
    spheres.centers.push_back(center);
    spheres.colours.push_back(field ? colour_of(*field, i, range) : plain);
  }
  return spheres;
}

Walls make_walls(const TriangleMesh& mesh, const Camera& camera) {
  Walls walls;
  for (const Vec3& vertex : mesh.vertices) walls.vertices.push_back(camera.to_view(vertex));
  const auto visible = [&](std::int32_t i) {
    return i >= 0 && static_cast<std::size_t>(i) < walls.vertices.size() && walls.vertices[i].norm() < 1e3f * farthest;
  };
  for (const auto& [a, b, c] : mesh.triangles)
    if (visible(a) && visible(b) && visible(c))
      walls.triangles.push_back(
          {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
  return walls;
}

void add_line(Walls& walls, const Vec3f& from, const Vec3f& to, float half_thickness) {
  const Vec3f along = (to - from).normalized() * half_thickness;
  if (!along.allFinite()) return;
  const Vec3f across(-along.y(), along.x(), 0);
  const auto first = static_cast<std::uint32_t>(walls.vertices.size());
  for (const Vec3f& corner : {Vec3f(from - along - across), Vec3f(to + along - across), Vec3f(to + along + across),
                              Vec3f(from - along + across)})
    walls.vertices.push_back(corner);
  walls.triangles.push_back({first, first + 1, first + 2});
  walls.triangles.push_back({first, first + 2, first + 3});
}

// In 2-D everything is seen along z: walls lie flat behind the particles, and those on edge become lines.
Walls flattened(Walls walls, const Camera& camera, float radius) {
  for (Vec3f& vertex : walls.vertices) vertex.z() = -2 * radius;
  const auto triangles = walls.triangles;
  for (const auto& triangle : triangles)
    for (int i = 0; i < 3; ++i)
      add_line(walls, walls.vertices[triangle[i]], walls.vertices[triangle[(i + 1) % 3]],
               wall_thickness * camera.pixel());
  return walls;
}

}  // namespace

Picture draw(const Snapshot& snapshot, const TriangleMesh& boundary, const PictureOptions& options) {
  const auto field = colour_field(snapshot, options.field);
  const auto range = field ? colour_range(*field, options) : std::array{0.0, 1.0};
  static const TriangleMesh none;
  const TriangleMesh& mesh = options.boundaries ? boundary : none;
  const Camera camera = make_camera(subject(snapshot, mesh), snapshot.dimensions, options, field.has_value());
  const Spheres spheres = make_spheres(snapshot, camera, field, range);
  FacedWalls walls;
  if (camera.flat)
    walls.two_sided = flattened(make_walls(mesh, camera), camera, spheres.radius);
  else if (!mesh.empty())
    walls = face_fluid(make_walls(mesh, camera), spheres.centers, spheres.radius);
  const RayScene scene(spheres.centers, spheres.radius, walls.two_sided, walls.one_sided);
  Picture picture = trace({camera, scene, spheres.colours, spheres.radius});
  if (field) draw_legend(picture, field->title, field->map, range);
  draw_time(picture, snapshot.time);
  return picture;
}

}  // namespace molten
