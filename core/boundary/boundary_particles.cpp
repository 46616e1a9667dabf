#include "core/boundary/boundary_particles.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "core/boundary/flat_parts.h"
#include "core/error.h"

namespace molten {

namespace {

constexpr double nearest = 0.45;  // pitches; where walls meet, points nearer than this to another are left out

int parts_of(double length, double spacing) { return std::max(1, static_cast<int>(std::lround(length / spacing))); }

/// Points that keep their distance.
template <int Dim> class Points {
 public:
  explicit Points(double distance) : distance_(distance) {}

  /// False: it is too near to another.
  bool add(const Point<Dim>& x) {
    if (has_near(x)) return false;
    cells_[key(cell_of(x))].push_back(points_.size());
    points_.push_back(x);
    return true;
  }
  const std::vector<Point<Dim>>& all() const { return points_; }

 private:
  using CellIndex = std::array<std::int64_t, Dim>;

  CellIndex cell_of(const Point<Dim>& x) const {
    CellIndex c;
    for (int d = 0; d < Dim; ++d) c[d] = static_cast<std::int64_t>(std::floor(x[d] / distance_));
    return c;
  }
  /// Cells that share a key cost time alone.
  static std::uint64_t key(const CellIndex& c) {
    std::uint64_t k = 0;
    for (int d = 0; d < Dim; ++d) k = k * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(c[d]);
    return k;
  }

  bool has_near(const Point<Dim>& x) const {
    const CellIndex middle = cell_of(x);
    for (int n = 0, cells = Dim == 2 ? 9 : 27; n < cells; ++n) {
      CellIndex c = middle;
      for (int d = 0, rest = n; d < Dim; ++d, rest /= 3) c[d] += rest % 3 - 1;
      const auto found = cells_.find(key(c));
      if (found == cells_.end()) continue;
      for (const std::size_t k : found->second)
        if ((points_[k] - x).norm() < distance_) return true;
    }
    return false;
  }

  double distance_;  // m
  std::vector<Point<Dim>> points_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
};

/// From a place where surfaces with these normals meet to where all of them are one unit in front.
template <int Dim> Point<Dim> before_all(const std::vector<Point<Dim>>& normals) {
  Point<Dim> sum = Point<Dim>::Zero();
  for (const Point<Dim>& n : normals) sum += n;
  const double square = sum.squaredNorm();
  return square > 0.2 ? Point<Dim>(static_cast<double>(normals.size()) / square * sum) : normals.front();
}

// ---- 2-D: segments --------------------------------------------------------------------------------------------------

struct Segment {
  Point<2> from, to, along, normal;  // m, m, unit, unit
  int parts;

  Segment(const Wall<2>& wall, const std::array<std::int32_t, 2>& ends, double spacing)
      : from(wall.vertices[ends[0]]),
        to(wall.vertices[ends[1]]),
        along((to - from).normalized()),
        normal(-along[1], along[0]),
        parts(parts_of((to - from).norm(), spacing)) {}

  Point<2> at(double part) const { return from + part / parts * (to - from); }
};

/// A corner with the segments that end and begin there.
struct Joint {
  const Segment *before = nullptr, *after = nullptr;
};

struct Outline {
  std::vector<Segment> segments;
  std::map<std::array<double, 2>, Joint> joints;

  Outline(const Wall<2>& wall, double spacing) {
    for (const auto& facet : wall.facets)
      if (wall.vertices[facet[0]] != wall.vertices[facet[1]]) segments.emplace_back(wall, facet, spacing);
    for (const Segment& s : segments) {
      joints[{s.from[0], s.from[1]}].after = &s;
      joints[{s.to[0], s.to[1]}].before = &s;
    }
  }
};

std::vector<Point<2>> rows_on(const Wall<2>& wall, double pitch) {
  const Outline outline(wall, pitch);
  Points<2> points(nearest * pitch);
  for (const Segment& s : outline.segments)
    for (int k = 0; k <= s.parts; ++k) points.add(s.at(k));
  for (const Segment& s : outline.segments)
    for (int k = 0; k < s.parts; ++k) points.add(s.at(k + 0.5) - pitch / 2 * s.normal);
  for (const auto& [place, joint] : outline.joints) {
    constexpr double sharp = 0.3;  // sine of the angle of a corner; blunter ones leave no gap
    if (!joint.before || !joint.after) continue;
    const Point<2>&a = joint.before->along, &b = joint.after->along;
    if (a[0] * b[1] - a[1] * b[0] < sharp) continue;  // the fluid is outside of it
    points.add(joint.after->from - pitch / 2 * before_all<2>({joint.before->normal, joint.after->normal}));
  }
  return points.all();
}

void require_wide(double width, double spacing) {
  if (width < 0.5 * spacing)
    throw Error(ExitCode::geometry,
                "repulsive boundary particles need flat walls at least as wide as the particles are apart, and a part "
                "of a boundary is " +
                    std::to_string(width) + " m wide; choose a smaller spacing, simpler walls or dynamic ones");
}

/// Corners blunter than this share one point between both sides.
constexpr double blunt = 0.7;  // cosine of the angle between the normals

std::vector<RepulsivePoint<2>> repulsive_on(const Wall<2>& wall, double spacing) {
  const Outline outline(wall, spacing);
  std::vector<RepulsivePoint<2>> points;
  const auto add = [&](const Point<2>& at, const Point<2>& normal, double pitch) {
    points.push_back({at, normal, {Point<2>(normal[1], -normal[0])}, {pitch}});
  };
  for (const Segment& s : outline.segments) {
    const double length = (s.to - s.from).norm(), pitch = length / s.parts;
    require_wide(length, spacing);
    const Segment* next = outline.joints.at({s.to[0], s.to[1]}).after;
    const Segment* last = outline.joints.at({s.from[0], s.from[1]}).before;
    if (!last || last->normal.dot(s.normal) < blunt) add(s.from, s.normal, pitch);
    for (int k = 1; k < s.parts; ++k) add(s.at(k), s.normal, pitch);
    const bool is_blunt = next && next->normal.dot(s.normal) >= blunt;
    add(s.to, is_blunt ? Point<2>((s.normal + next->normal).normalized()) : s.normal, pitch);
  }
  return points;
}

// ---- 3-D: flat parts ------------------------------------------------------------------------------------------------

/// The lattice of a flat part: whole parts of its extent.
struct PartLattice {
  const FlatPart& part;
  std::array<int, 2> parts;
  std::array<double, 2> pitch;  // m

  PartLattice(const FlatPart& p, double spacing) : part(p) {
    for (int k = 0; k < 2; ++k) {
      parts[k] = parts_of(p.extent[k], spacing);
      pitch[k] = p.extent[k] / parts[k];
    }
  }
  Point<3> at(double i, double j) const {
    return part.origin + i * pitch[0] * part.axis[0] + j * pitch[1] * part.axis[1];
  }
};

std::vector<Point<3>> rows_on(const Wall<3>& wall, double pitch) {
  const FlatParts flat = flat_parts_of(wall);
  Points<3> points(nearest * pitch);
  for (const FlatCorner& corner : flat.corners) points.add(corner.at);
  const auto for_each_part = [&](const FlatEdge& edge, auto&& f) {
    const int parts = parts_of((edge.to - edge.from).norm(), pitch);
    for (int k = 0; k < parts; ++k) f([&](double part) { return edge.from + part / parts * (edge.to - edge.from); }, k);
  };
  for (const FlatEdge& edge : flat.edges) for_each_part(edge, [&](auto at, int k) { points.add(at(k)); });
  const auto fill = [&](double offset, double depth) {
    for (const FlatPart& part : flat.parts) {
      const PartLattice lattice(part, pitch);
      for (int j = 0; j <= lattice.parts[1]; ++j)
        for (int i = 0; i <= lattice.parts[0]; ++i)
          if (const Point<3> x = lattice.at(i + offset, j + offset); part.covers(wall, x))
            points.add(x - depth * part.normal);
    }
  };
  fill(0, 0);
  fill(0.5, pitch / 2);
  for (const FlatEdge& edge : flat.edges)
    for_each_part(edge, [&](auto at, int k) { points.add(at(k + 0.5) - pitch / 2 * before_all<3>(edge.normals)); });
  for (const FlatCorner& corner : flat.corners) points.add(corner.at - pitch / 2 * before_all<3>(corner.normals));
  return points.all();
}

/// Does the part reach into the cells around a lattice point?
bool reaches(const Wall<3>& wall, const PartLattice& lattice, int i, int j) {
  for (const double a : {0.0, -0.99, -0.5, 0.5, 0.99})
    for (const double b : {0.0, -0.99, -0.5, 0.5, 0.99})
      if (lattice.part.covers(wall, lattice.at(i + a, j + b))) return true;
  return false;
}

std::vector<RepulsivePoint<3>> repulsive_on(const Wall<3>& wall, double spacing) {
  const FlatParts flat = flat_parts_of(wall);
  std::vector<RepulsivePoint<3>> points;
  for (const FlatPart& part : flat.parts) {
    require_wide(std::min(part.extent[0], part.extent[1]), spacing);
    const PartLattice lattice(part, spacing);
    for (int j = 0; j <= lattice.parts[1]; ++j)
      for (int i = 0; i <= lattice.parts[0]; ++i)
        if (reaches(wall, lattice, i, j)) points.push_back({lattice.at(i, j), part.normal, part.axis, lattice.pitch});
  }
  return points;
}

}  // namespace

template <int Dim> double held_pitch(double spacing) { return std::pow(2.0, 1.0 / Dim) * spacing; }

template <int Dim> std::vector<HeldPoint<Dim>> held_points(const std::vector<Wall<Dim>>& walls, double pitch) {
  std::vector<HeldPoint<Dim>> held;
  Points<Dim> fixed(nearest * pitch);  // walls that stay may run into each other
  for (const Wall<Dim>& wall : walls) {
    if (wall.is_plane) continue;
    for (const Point<Dim>& x : rows_on(wall, pitch))
      if (wall.body >= 0 || fixed.add(x)) held.push_back({x, wall.body});
  }
  return held;
}

template <int Dim>
std::vector<RepulsivePoint<Dim>> repulsive_points(const std::vector<Wall<Dim>>& walls, double spacing) {
  std::vector<RepulsivePoint<Dim>> all;
  for (const Wall<Dim>& wall : walls) {
    if (wall.is_plane) continue;
    const auto points = repulsive_on(wall, spacing);
    all.insert(all.end(), points.begin(), points.end());
  }
  return all;
}

template double held_pitch<2>(double);
template double held_pitch<3>(double);
template std::vector<HeldPoint<2>> held_points(const std::vector<Wall<2>>&, double);
template std::vector<HeldPoint<3>> held_points(const std::vector<Wall<3>>&, double);
template std::vector<RepulsivePoint<2>> repulsive_points(const std::vector<Wall<2>>&, double);
template std::vector<RepulsivePoint<3>> repulsive_points(const std::vector<Wall<3>>&, double);

}  // namespace molten
