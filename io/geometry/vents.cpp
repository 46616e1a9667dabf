#include "io/geometry/vents.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "io/geometry/assemble.h"
#include "io/geometry/point_text.h"

namespace molten {

namespace {

template <int Dim> Point<Dim> point_of(const std::array<double, 3>& v) {
  Point<Dim> p;
  for (int d = 0; d < Dim; ++d) p[d] = v[d];
  return p;
}

std::string name_of(const Scene& scene, const Vent& vent) {
  return text_of(vent.place.file.empty() ? Place{scene.file, 0, 0} : vent.place) + ": vent";
}

/// Before its layers are made: `across` is the patch's size, m² (2-D: m).
void require_layer(const Scene& scene, const Vent& vent, double across, double spacing) {
  constexpr double most = 1e7;  // particles of a layer
  const double layer = across / std::pow(spacing, scene.dimensions - 1);
  if (layer > most)
    throw Error(ExitCode::usage,
                fmt::format("{}: a layer of it would be {:.3g} particles; make it smaller (m) or the spacing of {:.3g} "
                            "m larger",
                            name_of(scene, vent), layer, spacing));
}

/// The lattice points of the plane that fall on the patch, seen along its normal.
std::vector<Point<3>> offsets_on(const TriangleMesh& mesh, const VentPatch<3>& patch, double spacing) {
  const auto axes = axes_across(patch.normal);
  const Point<3>&a = axes[0], &b = axes[1];  // clang 14 lets no lambda capture a structured binding
  const auto flat = [&](const Vec3& v) { return Vec2((v - patch.centre).dot(a), (v - patch.centre).dot(b)); };
  const auto turn = [](const Vec2& p, const Vec2& q) { return p.x() * q.y() - p.y() * q.x(); };
  double reach = 0;
  for (const Vec3& v : mesh.vertices) reach = std::max(reach, flat(v).norm());
  std::vector<Point<3>> offsets;
  const int cells = static_cast<int>(reach / spacing) + 1;
  for (int j = -cells; j <= cells; ++j)
    for (int i = -cells; i <= cells; ++i) {
      const Vec2 x(i * spacing, j * spacing);
      const bool on = std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
        const Vec2 p = flat(mesh.vertices[t[0]]), q = flat(mesh.vertices[t[1]]), r = flat(mesh.vertices[t[2]]);
        const double u = turn(q - p, x - p), v = turn(r - q, x - q), w = turn(p - r, x - r);
        return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
      });
      if (on) offsets.push_back(x[0] * a + x[1] * b);
    }
  if (offsets.empty()) offsets.push_back(Point<3>::Zero());
  return offsets;
}

VentPatch<3> patch_of_mesh(const Scene& scene, const Vent& vent, double spacing) {
  const TriangleMesh mesh = placed_mesh(scene, *vent.mesh);
  VentPatch<3> patch;
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 &p = mesh.vertices[t[0]], &q = mesh.vertices[t[1]], &r = mesh.vertices[t[2]];
    const Vec3 twice = (q - p).cross(r - p);
    patch.normal += twice;
    patch.centre += twice.norm() * (p + q + r) / 3;
    area += twice.norm();
  }
  if (!(patch.normal.norm() > 0.9 * area))
    throw Error(ExitCode::geometry, name_of(scene, vent) +
                                        ".mesh: the patch is not flat, so it has no one direction "
                                        "to let fluid in; cut it into flatter patches");
  require_layer(scene, vent, area / 2, spacing);
  patch.centre /= area;
  patch.normal.normalize();
  patch.offsets = offsets_on(mesh, patch, spacing);
  return patch;
}

template <int Dim> VentPatch<Dim> patch_of(const Scene& scene, const Vent& vent, double spacing) {
  VentPatch<Dim> patch;
  if (vent.mesh) {
    if constexpr (Dim == 3) patch = patch_of_mesh(scene, vent, spacing);
  } else {
    patch.centre = point_of<Dim>(vent.centre);
    patch.normal = point_of<Dim>(vent.normal).normalized();
    require_layer(scene, vent, Dim == 2 ? 2 * vent.radius : M_PI * vent.radius * vent.radius, spacing);
    patch.offsets = disc_offsets<Dim>(patch.normal, vent.radius, spacing);
  }
  patch.table = vent.table;
  return patch;
}

template <int Dim> void describe(const Scene& scene, Start& start) {
  const Vents<Dim> vents = build_vents<Dim>(scene, start, start.spacing);
  for (std::size_t k = 0; k < vents.count(); ++k) {
    auto& x = start.vents.emplace_back();
    for (int d = 0; d < Dim; ++d) x[d] = vents.patch(k).centre[d];
  }
  start.vent_speed = vents.fastest();
}

/// The fluid that waits behind a vent supports what leaves it; a wall there would do so again.
template <int Dim>
void require_no_support(const Scene& scene, const Vent& vent, const VentPatch<Dim>& patch, const Contact<Dim>& contact,
                        double support) {
  for (const Point<Dim>& offset : patch.offsets)
    if (contact.may_touch(patch.centre + offset, support))
      throw Error(ExitCode::geometry,
                  fmt::format("{}: is within {:.4g} m of a wall, which would support its fluid a second time; move it "
                              "away or leave numerics.wall_support out",
                              name_of(scene, vent), support));
}

/// The layers that wait, `depth` (m) behind the plane, are fluid already.
template <int Dim>
void require_no_fluid_behind(const Scene& scene, const Start& start, const Vent& vent, const VentPatch<Dim>& patch,
                             double depth) {
  const double spacing = start.spacing;
  const auto waits_at = [&](const Point<Dim>& x) {
    const double ahead = x.dot(patch.normal);
    if (ahead > spacing / 4 || ahead < -depth) return false;
    const Point<Dim> across = x - ahead * patch.normal;
    return std::any_of(patch.offsets.begin(), patch.offsets.end(),
                       [&](const Point<Dim>& offset) { return (across - offset).norm() < spacing / 2; });
  };
  const auto inside = std::count_if(start.position.begin(), start.position.end(), [&](const auto& place) {
    return waits_at(Point<Dim>(place.data()) - patch.centre);
  });
  if (inside > 0)
    throw Error(ExitCode::geometry,
                fmt::format("{}: {} particles of the fluid start where the vent's own wait, up to {:.4g} m behind its "
                            "plane; move the vent to the fluid's surface, or the fluid away",
                            name_of(scene, vent), inside, depth));
}

/// What leaves the domain is taken out.
template <int Dim>
void require_in_domain(const Scene& scene, const Vent& vent, const VentPatch<Dim>& patch, const Domain<Dim>& domain) {
  for (const Point<Dim>& offset : patch.offsets)
    for (int d = 0; d < Dim; ++d) {
      const double x = patch.centre[d] + offset[d];
      if (x >= domain.lower[d] && x <= domain.upper[d]) continue;
      throw Error(
          ExitCode::geometry,
          fmt::format("{}: reaches {} = {:.6g} m, outside scene.domain, which is from {:.6g} to {:.6g} m there; "
                      "move the vent or enlarge the domain",
                      name_of(scene, vent), "xyz"[d], x, domain.lower[d], domain.upper[d]));
    }
}

/// Two vents that let fluid in at one place would put particles on particles.
template <int Dim> void require_apart(const Scene& scene, const Vents<Dim>& vents, double spacing) {
  const auto overlap = [&](const VentPatch<Dim>& a, const VentPatch<Dim>& b) {
    const auto touch = [&](const Point<Dim>& x) {
      return std::any_of(b.offsets.begin(), b.offsets.end(),
                         [&](const Point<Dim>& y) { return (x - b.centre - y).norm() < spacing / 2; });
    };
    return std::any_of(a.offsets.begin(), a.offsets.end(),
                       [&](const Point<Dim>& offset) { return touch(a.centre + offset); });
  };
  const auto reach = [](const VentPatch<Dim>& patch) {
    double r = 0;
    for (const Point<Dim>& offset : patch.offsets) r = std::max(r, offset.norm());
    return r;
  };
  for (std::size_t k = 0; k < vents.count(); ++k)
    for (std::size_t n = 0; n < k; ++n) {
      const VentPatch<Dim>&a = vents.patch(n), &b = vents.patch(k);
      if ((a.centre - b.centre).norm() > reach(a) + reach(b) + spacing || !overlap(a, b)) continue;
      throw Error(
          ExitCode::geometry,
          fmt::format("{}.{}: lets fluid in where vent.{} does; leave one of them out, move them apart, or give "
                      "one vent a table of times and rates",
                      name_of(scene, scene.vents[k]), k, n));
    }
}

}  // namespace

template <int Dim> Vents<Dim> build_vents(const Scene& scene, const Start& start, double support) {
  const double spacing = std::pow(measure_of_particle(scene, start), 1.0 / Dim);
  std::vector<VentPatch<Dim>> patches;
  for (const Vent& vent : scene.vents) patches.push_back(patch_of<Dim>(scene, vent, spacing));
  return Vents<Dim>(std::move(patches), spacing, support);
}

void describe_vents(const Scene& scene, Start& start) {
  if (scene.vents.empty()) return;
  scene.dimensions == 2 ? describe<2>(scene, start) : describe<3>(scene, start);
}

template <int Dim>
void require_open_vents(const Scene& scene, const Start& start, const std::vector<Wall<Dim>>& walls,
                        const Contact<Dim>& contact) {
  const Parameters<Dim> parameters = parameters_of<Dim>(scene, start);
  const Vents<Dim> vents = build_vents<Dim>(scene, start, parameters.support_radius);
  require_apart(scene, vents, start.spacing);
  for (std::size_t k = 0; k < vents.count(); ++k) {
    const VentPatch<Dim>& patch = vents.patch(k);
    if (scene.numerics.wall_support)
      require_no_support(scene, scene.vents[k], patch, contact, parameters.support_radius);
    require_no_fluid_behind(scene, start, scene.vents[k], patch, vents.layers() * start.spacing);
    if (scene.domain) require_in_domain(scene, scene.vents[k], patch, parameters.domain);
    Start outside;  // where a layer is when it has left
    outside.spacing = start.spacing;
    for (const Point<Dim>& offset : patch.offsets) {
      const Point<Dim> x = patch.centre + 0.51 * start.spacing * patch.normal + offset;
      auto& at = outside.position.emplace_back();
      for (int d = 0; d < Dim; ++d) at[d] = x[d];
    }
    if (const std::size_t n = count_inside_walls(scene, outside, walls, contact); n > 0)
      throw Error(ExitCode::geometry,
                  fmt::format("{}: {} of the {} particles that leave it at {} would be inside a "
                              "wall; move it to the wall's surface, turn its normal into the open, or make it smaller",
                              name_of(scene, scene.vents[k]), n, patch.offsets.size(), in_metres<Dim>(patch.centre)));
  }
}

template Vents<2> build_vents(const Scene&, const Start&, double);
template Vents<3> build_vents(const Scene&, const Start&, double);
template void require_open_vents(const Scene&, const Start&, const std::vector<Wall<2>>&, const Contact<2>&);
template void require_open_vents(const Scene&, const Start&, const std::vector<Wall<3>>&, const Contact<3>&);

}  // namespace molten
