#include "core/hydrostatic.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace molten {
namespace {

constexpr double gap = 2;  // spacings between two particles of a column from which on the upper stands on its own floor

template <int Dim> Point<Dim> point_of(const std::array<double, 3>& x) {
  return Eigen::Map<const Point<Dim>>(x.data());
}

/// A particle of a column that is one spacing wide.
struct Member {
  std::array<std::int64_t, 2> column;
  double height;  // m
  std::size_t particle;

  bool operator<(const Member& o) const {
    return std::tie(column, height, particle) < std::tie(o.column, o.height, o.particle);
  }
};

template <int Dim> std::array<Point<Dim>, Dim - 1> across(const Point<Dim>& up) {
  if constexpr (Dim == 2) {
    return {Point<2>(up.y(), -up.x())};
  } else {
    const Point<3> a = up.unitOrthogonal();
    return {a, up.cross(a)};
  }
}

/// All particles, column by column, from below.
template <int Dim> std::vector<Member> columns_of(const Start& start, const Point<Dim>& up) {
  const auto sides = across<Dim>(up);
  std::vector<Member> members(start.position.size());
  if (members.empty()) return members;
  const Point<Dim> origin = point_of<Dim>(start.position[0]);  // so that a lattice lies in the columns' middles
  for (std::size_t k = 0; k < members.size(); ++k) {
    const Point<Dim> x = point_of<Dim>(start.position[k]);
    members[k] = {{}, up.dot(x), k};
    for (std::size_t d = 0; d < sides.size(); ++d)
      members[k].column[d] = std::llround(sides[d].dot(x - origin) / start.spacing);
  }
  std::sort(members.begin(), members.end());
  return members;
}

}  // namespace

template <int Dim>
FluidAtRest<Dim>::FluidAtRest(const Parameters<Dim>& p, const Start& start, bool squeezed) : eos_(p.eos) {
  const Eigen::Map<const Point<Dim>> g(p.gravity.data());
  gravity_ = g.norm();
  if (!(gravity_ > 0)) return;
  up_ = -g / gravity_;
  level_ = *p.surface_potential / gravity_;
  if (!squeezed) return;
  squeeze(start);
  level_ = -1e300;
  for (std::size_t k = 0; k < start.position.size(); ++k)
    level_ = std::max(level_, up_.dot(place(start, k)) + start.spacing / 2);
}

template <int Dim> void FluidAtRest<Dim>::squeeze(const Start& start) {
  sinking_.resize(start.position.size());
  double whole = 0;  // of the column above its floor, m
  const Member* below = nullptr;
  const auto members = columns_of<Dim>(start, up_);
  for (const Member& m : members) {
    const bool stands = !below || m.column != below->column || m.height - below->height > gap * start.spacing;
    if (stands) whole = squeezed_by(level_ - (m.height - start.spacing / 2));
    sinking_[m.particle] = whole - squeezed_by(level_ - m.height);
    below = &m;
  }
}

template <int Dim> double FluidAtRest<Dim>::squeezed_by(double weight) const {
  return weight - eos_.potential_at_rest(eos_.compression(eos_.rest_density * gravity_ * weight)) / gravity_;
}

template <int Dim> Point<Dim> FluidAtRest<Dim>::place(const Start& start, std::size_t k) const {
  const Point<Dim> x = point_of<Dim>(start.position[k]);
  return sinking_.empty() ? x : Point<Dim>(x - sinking_[k] * up_);
}

template <int Dim> double FluidAtRest<Dim>::compression(const Point<Dim>& x) const {
  return eos_.compression_at_rest(gravity_ * std::max(0.0, level_ - up_.dot(x)));
}

template class FluidAtRest<2>;
template class FluidAtRest<3>;

}  // namespace molten
