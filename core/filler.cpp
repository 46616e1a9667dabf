#include "core/filler.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/boundary/shapes.h"
#include "core/error.h"

namespace molten {
namespace {

constexpr double most_particles = 2147483648.0;  // 2^31
constexpr double most_columns = 1e9;             // of the lattice under one region

std::string name(std::size_t region) { return "body " + std::to_string(region + 1); }

std::string text(const Vec3& v) {
  return "(" + std::to_string(v.x()) + ", " + std::to_string(v.y()) + ", " + std::to_string(v.z()) + ") m";
}

double area(const std::vector<Vec2>& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 a = outline[i] - outline[0], b = outline[(i + 1) % outline.size()] - outline[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

Eigen::AlignedBox3d bounds_of(const Region& region, int dimensions) {
  Eigen::AlignedBox3d bounds;
  if (dimensions == 3) {
    for (const auto& t : region.mesh.triangles)
      for (const int v : t) bounds.extend(region.mesh.vertices[v]);
  } else {
    for (const Vec2& v : region.outline) bounds.extend(Vec3(v.x(), v.y(), 0));
  }
  return bounds;
}

}  // namespace

Filler::Filler(const std::vector<Region>& regions, int dimensions) : dimensions_(dimensions) {
  if (regions.empty()) throw Error(ExitCode::usage, "there is no body to fill with particles");
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Region& region = regions[r];
    const double measure = dimensions == 3 ? signed_volume(region.mesh) : area(region.outline);
    if (!(measure > 0) || !std::isfinite(measure))
      throw Error(ExitCode::geometry, name(r) + " encloses nothing: its surface must be closed and point outwards");
    Part part;
    part.bounds = bounds_of(region, dimensions);
    part.inside = dimensions == 3 ? inside_of(region.mesh) : inside_of(region.outline);
    measure_ += measure;
    bounds_.extend(part.bounds);
    parts_.push_back(std::move(part));
  }
}

void Filler::require_feasible(double spacing) const {
  const double particles = measure_ / std::pow(spacing, dimensions_);
  double columns = 0;
  for (const Part& part : parts_) {
    const Vec3 size = part.bounds.sizes() / spacing;
    columns = std::max(columns, dimensions_ == 3 ? size.x() * size.y() : size.x());
  }
  if (particles > most_particles || columns > most_columns)
    throw Error(ExitCode::usage, "a spacing of " + std::to_string(spacing) + " m would make about " +
                                     std::to_string(static_cast<long long>(std::min(particles, 9e18))) +
                                     " particles: ask for fewer, or for a larger spacing");
}

/// Cell centres from `low` to just below `high`; a millionth of a spacing keeps rounding from deciding.
Filler::Range Filler::cells(double low, double high, double first, double spacing) {
  const auto index = [=](double at) { return static_cast<long long>(std::ceil((at - first) / spacing - 1e-6)); };
  return {index(low), index(high)};
}

/// visit(x, y, range) for each inside part of each column.
template <class Visit> void Filler::columns(const Part& part, const Lattice& lattice, Visit visit) const {
  const Vec3 &low = part.bounds.min(), &high = part.bounds.max(), &first = lattice.first;
  const double s = lattice.spacing;
  const Range xs = cells(low.x(), high.x(), first.x(), s);
  const Range ys = dimensions_ == 3 ? cells(low.y(), high.y(), first.y(), s) : Range{0, 1};
  std::vector<Span> spans;
  for (long long i = xs.first; i < xs.end; ++i)
    for (long long j = ys.first; j < ys.end; ++j) {
      const double x = first.x() + s * i, y = dimensions_ == 3 ? first.y() + s * j : 0;
      part.inside->spans(x, y, spans);
      for (const Span& span : spans) visit(x, y, cells(span.low, span.high, first[dimensions_ - 1], s));
    }
}

long long Filler::count(const Lattice& lattice) const {
  long long total = 0;
  for (const Part& part : parts_)
    columns(part, lattice, [&](double, double, Range range) { total += range.end - range.first; });
  return total;
}

Filling Filler::place(const Lattice& lattice) const {
  Filling filling;
  filling.spacing = lattice.spacing;
  filling.measure = measure_;
  for (std::size_t r = 0; r < parts_.size(); ++r) {
    const std::size_t before = filling.positions.size();
    columns(parts_[r], lattice, [&](double x, double y, Range range) {
      refuse_overlap(r, lattice, x, y, range);
      for (long long k = range.first; k < range.end; ++k) {
        const double last = lattice.first[dimensions_ - 1] + lattice.spacing * k;
        filling.positions.push_back(dimensions_ == 3 ? Vec3(x, y, last) : Vec3(x, last, 0));
      }
    });
    if (filling.positions.size() == before)
      throw Error(ExitCode::usage, name(r) + " is smaller than one particle at a spacing of " +
                                       std::to_string(lattice.spacing) +
                                       " m: ask for more particles or a smaller spacing");
    filling.region.resize(filling.positions.size(), static_cast<std::int32_t>(r));
  }
  return filling;
}

void Filler::refuse_overlap(std::size_t part, const Lattice& lattice, double x, double y, Range range) const {
  std::vector<Span> spans;
  for (std::size_t other = 0; other < part; ++other) {
    const Eigen::AlignedBox3d& box = parts_[other].bounds;
    if (x < box.min().x() || x > box.max().x()) continue;
    if (dimensions_ == 3 && (y < box.min().y() || y > box.max().y())) continue;
    parts_[other].inside->spans(x, y, spans);
    for (const Span& span : spans) {
      const int axis = dimensions_ - 1;
      const Range theirs = cells(span.low, span.high, lattice.first[axis], lattice.spacing);
      const long long shared = std::max(theirs.first, range.first);
      if (shared >= std::min(theirs.end, range.end)) continue;
      Vec3 at(x, y, 0);
      at[axis] = lattice.first[axis] + lattice.spacing * shared;
      throw Error(ExitCode::geometry,
                  name(other) + " and " + name(part) + " overlap at " + text(at) + ": move them apart");
    }
  }
}

}  // namespace molten
