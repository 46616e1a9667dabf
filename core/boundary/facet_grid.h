// A uniform grid whose cells list the facets that a sphere with its centre in the cell can touch ([P] 6.3: triangle
// lists in cells by Akenine-Möller's test; here the cells are grown by the radius). Cells live in bricks of 4 per
// direction; empty bricks take 12 bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/boundary/sweep.h"

namespace molten {

/// Can a facet reach into a box? Separating axes, exact up to round-off; the facet's part is worked out once.
template <int Dim> class BoxTest {
 public:
  explicit BoxTest(const Facet<Dim>& facet);
  /// The box with this centre and half widths (m).
  bool overlaps(const Point<Dim>& centre, const Point<Dim>& half) const;

 private:
  static constexpr int axes = Dim == 3 ? 13 : 3;
  using PerAxis = Eigen::Array<double, axes, 1>;
  Eigen::Matrix<double, axes, Dim> axis_, size_;  // size: without sign
  PerAxis lo_, hi_;                               // the facet along each axis
};

template <int Dim> class FacetGrid {
 public:
  FacetGrid() = default;
  /// `margin` (m): how far from a cell a facet may be and still be listed. `cell` (m) is what is wanted; it is doubled
  /// until the lists and bricks of large walls fit in memory (24 list entries and 4 bricks a facet, or 4 and 1
  /// million).
  FacetGrid(const std::vector<Facet<Dim>>& facets, double margin, double cell);

  /// The facets within the margin of x, and some more; in rising order.
  std::span<const std::int32_t> near(const Point<Dim>& x) const;

  /// The facets within the margin of any point within `reach` (m) of x, and some more; none if one list does not hold
  /// them.
  std::optional<std::span<const std::int32_t>> near_all(const Point<Dim>& x, double reach) const;

  /// False only if no point within `reach` (m) of x has a facet within the margin. One look-up when reach is small.
  bool any_within(const Point<Dim>& x, double reach) const;
  /// False only if no point of the box lower..upper has a facet within the margin.
  bool any_in_box(const Point<Dim>& lower, const Point<Dim>& upper) const;

  /// Calls visit(facets, t) for the cells that the straight path x → x + d passes, in order; t is the fraction of the
  /// path at which it leaves the cell. Ends when visit returns false. A cell that is cut by no more than round-off may
  /// be left out: the margin covers it.
  template <class Visit> void walk(const Point<Dim>& x, const Point<Dim>& d, Visit&& visit) const;

  /// Calls visit(facets) for all cells that meet the box lo..hi.
  template <class Visit> void visit_box(const Point<Dim>& lo, const Point<Dim>& hi, Visit&& visit) const;

  double cell() const { return cell_; }
  /// Facets in the mean list.
  double mean_list() const;
  std::size_t bytes() const;

 private:
  using Index = Eigen::Matrix<std::int32_t, Dim, 1>;
  static constexpr int cells_per_brick = Dim == 3 ? 64 : 16;

  void fill(const std::vector<Facet<Dim>>& facets);
  std::size_t slot_of(const Index& cell);
  bool fits(const std::vector<Facet<Dim>>& facets) const;
  void set_cell(double cell, const Point<Dim>& lo, const Point<Dim>& hi);
  template <class Visit>
  void cells_of(const BoxTest<Dim>& facet, const Index& lo, const Index& hi, Visit&& visit) const;
  std::int32_t cell_of(double x, int axis) const;
  Index cell_of(const Point<Dim>& x) const;
  bool inside(const Point<Dim>& x) const;
  bool misses(const Point<Dim>& lower, const Point<Dim>& upper) const {
    return (upper.array() < origin_.array()).any() || (lower.array() > end_.array()).any();
  }
  std::int64_t brick_slot(const Index& cell) const;
  static int slot_in_brick(const Index& cell);
  std::span<const std::int32_t> list(const Index& cell) const;
  bool used(const Index& cell) const { return used_[brick_slot(cell)] >> slot_in_brick(cell) & 1; }
  bool any_in(const Index& lo, const Index& hi) const;

  Point<Dim> origin_ = Point<Dim>::Zero(), end_ = Point<Dim>::Zero();  // m
  double cell_ = 0, per_cell_ = 0, margin_ = 0;                        // m, 1/m, m
  Index size_ = Index::Zero(), bricks_ = Index::Zero();                // cells and bricks per direction
  std::vector<std::uint64_t> used_;                                    // by brick, a bit for each cell with a list
  std::vector<std::int32_t> brick_;                                    // where its starts are; −1: empty
  std::vector<std::uint32_t> start_;  // of the cells' lists, cells_per_brick + 1 a brick
  std::vector<std::int32_t> list_;
};

template <int Dim> inline std::int32_t FacetGrid<Dim>::cell_of(double x, int axis) const {
  const double s = (x - origin_[axis]) * per_cell_;
  if (!(s > 0)) return 0;  // also not-a-number
  return s < size_[axis] ? static_cast<std::int32_t>(s) : size_[axis] - 1;
}

template <int Dim> inline typename FacetGrid<Dim>::Index FacetGrid<Dim>::cell_of(const Point<Dim>& x) const {
  Index cell;
  for (int k = 0; k < Dim; ++k) cell[k] = cell_of(x[k], k);
  return cell;
}

template <int Dim> inline bool FacetGrid<Dim>::inside(const Point<Dim>& x) const {
  for (int k = 0; k < Dim; ++k)
    if (!(x[k] >= origin_[k] && x[k] <= end_[k])) return false;
  return !brick_.empty();
}

template <int Dim> inline std::int64_t FacetGrid<Dim>::brick_slot(const Index& cell) const {
  std::int64_t slot = cell[Dim - 1] >> 2;
  for (int k = Dim - 2; k >= 0; --k) slot = slot * bricks_[k] + (cell[k] >> 2);
  return slot;
}

template <int Dim> inline int FacetGrid<Dim>::slot_in_brick(const Index& cell) {
  int slot = 0;
  for (int k = 0; k < Dim; ++k) slot |= (cell[k] & 3) << (2 * k);
  return slot;
}

template <int Dim> inline std::span<const std::int32_t> FacetGrid<Dim>::list(const Index& cell) const {
  const std::int64_t slot = brick_slot(cell);
  const int bit = slot_in_brick(cell);
  if (!(used_[slot] >> bit & 1)) return {};
  const std::uint32_t* start = &start_[static_cast<std::size_t>(brick_[slot]) * (cells_per_brick + 1) + bit];
  return {list_.data() + start[0], list_.data() + start[1]};
}

template <int Dim> inline std::span<const std::int32_t> FacetGrid<Dim>::near(const Point<Dim>& x) const {
  return inside(x) ? list(cell_of(x)) : std::span<const std::int32_t>();
}

template <int Dim>
inline std::optional<std::span<const std::int32_t>> FacetGrid<Dim>::near_all(const Point<Dim>& x, double reach) const {
  const Point<Dim> r = Point<Dim>::Constant(reach);
  if (brick_.empty() || misses(x - r, x + r)) return std::span<const std::int32_t>();
  const Index lo = cell_of(Point<Dim>(x - r)), hi = cell_of(Point<Dim>(x + r));
  if (lo != hi) return std::nullopt;
  return list(lo);
}

template <int Dim> inline bool FacetGrid<Dim>::any_within(const Point<Dim>& x, double reach) const {
  const Point<Dim> r = Point<Dim>::Constant(reach);
  return any_in_box(x - r, x + r);
}

template <int Dim> inline bool FacetGrid<Dim>::any_in_box(const Point<Dim>& lower, const Point<Dim>& upper) const {
  if (brick_.empty() || misses(lower, upper)) return false;
  const Index lo = cell_of(lower), hi = cell_of(upper);
  return lo == hi ? used(lo) : any_in(lo, hi);
}

template <int Dim>
template <class Visit>
void FacetGrid<Dim>::walk(const Point<Dim>& x, const Point<Dim>& d, Visit&& visit) const {
  const Point<Dim> to = x + d;
  if (inside(x) && inside(to) && cell_of(x) == cell_of(to)) {
    visit(list(cell_of(x)), 1.0);
    return;
  }
  double t, last;
  if (brick_.empty() || !part_in_box(origin_, end_, x, d, t, last)) return;
  Index cell = cell_of(Point<Dim>(x + t * d));
  const Index end = cell_of(Point<Dim>(x + last * d));
  Index step, left;        // direction and number of steps that remain, per axis
  Point<Dim> next, every;  // t of the next cell wall, and between walls
  for (int k = 0; k < Dim; ++k) {
    step[k] = d[k] > 0 ? 1 : -1;
    left[k] = (end[k] - cell[k]) * step[k];
    every[k] = cell_ / std::abs(d[k]);
    next[k] = left[k] > 0 ? (origin_[k] + (cell[k] + (d[k] > 0)) * cell_ - x[k]) / d[k] : HUGE_VAL;
  }
  while (true) {
    int axis = 0;
    for (int k = 1; k < Dim; ++k)
      if (next[k] < next[axis]) axis = k;
    const bool more = left[axis] > 0;
    if (!visit(list(cell), more ? next[axis] : last) || !more) return;
    cell[axis] += step[axis];
    next[axis] = --left[axis] > 0 ? next[axis] + every[axis] : HUGE_VAL;
  }
}

template <int Dim>
template <class Visit>
void FacetGrid<Dim>::visit_box(const Point<Dim>& lo, const Point<Dim>& hi, Visit&& visit) const {
  if (brick_.empty()) return;
  const Index first = cell_of(lo), last = cell_of(hi);
  for (Index c = first; c[Dim - 1] <= last[Dim - 1];) {
    visit(list(c));
    for (int k = 0; ++c[k] > last[k] && k < Dim - 1; ++k) c[k] = first[k];
  }
}

}  // namespace molten
