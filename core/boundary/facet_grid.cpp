#include "core/boundary/facet_grid.h"

#include <Eigen/Geometry>
#include <bit>
#include <cmath>

namespace molten {
namespace {

constexpr double round_off = 1e-12;  // relative; boxes are grown by it
constexpr std::size_t small_bricks = 1 << 20, small_entries = 1 << 22;

double area(const Facet<2>& f) { return (f.corner[1] - f.corner[0]).norm(); }
double area(const Facet<3>& f) { return 0.5 * (f.corner[1] - f.corner[0]).cross(f.corner[2] - f.corner[0]).norm(); }

}  // namespace

template <int Dim> BoxTest<Dim>::BoxTest(const Facet<Dim>& f) {
  for (int k = 0; k < Dim; ++k) axis_.row(k) = Point<Dim>::Unit(k);
  axis_.row(Dim) = f.normal;
  if constexpr (Dim == 3)
    for (int k = 0; k < 9; ++k) {
      const Point<3> e = (f.corner[(k + 1) % 3] - f.corner[k % 3]).normalized();
      axis_.row(4 + k) = Point<3>::Unit(k / 3).cross(e);
    }
  size_ = axis_.cwiseAbs();
  lo_ = hi_ = (axis_ * f.corner[0]).array();
  for (int k = 1; k < Dim; ++k) {
    const PerAxis s = (axis_ * f.corner[k]).array();
    lo_ = lo_.min(s);
    hi_ = hi_.max(s);
  }
}

template <int Dim> bool BoxTest<Dim>::overlaps(const Point<Dim>& centre, const Point<Dim>& half) const {
  const PerAxis at = (axis_ * centre).array(), reach = (size_ * half).array();
  return (lo_ - at <= reach && hi_ - at >= -reach).all();
}

template <int Dim>
FacetGrid<Dim>::FacetGrid(const std::vector<Facet<Dim>>& facets, double margin, double cell) : margin_(margin) {
  if (facets.empty()) return;
  Point<Dim> lo = facets[0].corner[0], hi = lo;
  for (const auto& f : facets)
    for (const auto& c : f.corner) {
      lo = lo.cwiseMin(c);
      hi = hi.cwiseMax(c);
    }
  margin_ += round_off * std::max(lo.cwiseAbs().maxCoeff(), hi.cwiseAbs().maxCoeff());
  for (cell = std::max(cell, 2 * margin);; cell *= 2) {
    set_cell(cell, lo, hi);
    if (fits(facets)) break;
  }
  brick_.assign(static_cast<std::size_t>(bricks_.template cast<std::int64_t>().prod()), -1);
  used_.assign(brick_.size(), 0);
  fill(facets);
}

/// Where the cell's count is kept; makes its brick.
template <int Dim> std::size_t FacetGrid<Dim>::slot_of(const Index& cell) {
  const std::int64_t slot = brick_slot(cell);
  const int bit = slot_in_brick(cell);
  if (brick_[slot] < 0) {
    brick_[slot] = static_cast<std::int32_t>(start_.size() / (cells_per_brick + 1));
    start_.resize(start_.size() + cells_per_brick + 1, 0);
  }
  used_[slot] |= std::uint64_t(1) << bit;
  return static_cast<std::size_t>(brick_[slot]) * (cells_per_brick + 1) + bit;
}

template <int Dim> void FacetGrid<Dim>::fill(const std::vector<Facet<Dim>>& facets) {
  std::vector<std::pair<std::uint32_t, std::int32_t>> entries;  // slot and facet
  for (std::size_t f = 0; f < facets.size(); ++f) {
    Point<Dim> lo = facets[f].corner[0], hi = lo;
    for (const auto& c : facets[f].corner) {
      lo = lo.cwiseMin(c);
      hi = hi.cwiseMax(c);
    }
    const Point<Dim> grow = Point<Dim>::Constant(2 * margin_);  // more than enough: the box test decides
    cells_of(BoxTest<Dim>(facets[f]), cell_of(Point<Dim>(lo - grow)), cell_of(Point<Dim>(hi + grow)),
             [&](const Index& c) {
               entries.emplace_back(static_cast<std::uint32_t>(slot_of(c)), static_cast<std::int32_t>(f));
             });
  }
  for (const auto& e : entries) ++start_[e.first];
  std::uint32_t total = 0;  // counts become ends; filling backwards turns the ends into starts
  for (std::uint32_t& s : start_) s = total += s;
  list_.resize(total);
  for (std::size_t i = entries.size(); i-- > 0;) list_[--start_[entries[i].first]] = entries[i].second;
}

template <int Dim> void FacetGrid<Dim>::set_cell(double cell, const Point<Dim>& lo, const Point<Dim>& hi) {
  cell_ = cell;
  per_cell_ = 1 / cell;
  origin_ = lo - Point<Dim>::Constant(margin_);
  end_ = hi + Point<Dim>::Constant(margin_);
  for (int k = 0; k < Dim; ++k) {
    const double cells = std::floor((end_[k] - origin_[k]) * per_cell_) + 1;
    size_[k] = static_cast<std::int32_t>(std::min(cells, 1e9));
    bricks_[k] = (size_[k] + 3) / 4;
  }
}

/// An estimate of the entries: facets cross about 2 layers of cells, and the margin adds to that.
template <int Dim> bool FacetGrid<Dim>::fits(const std::vector<Facet<Dim>>& facets) const {
  if (size_.maxCoeff() >= 1000000000) return false;
  const auto most_bricks = static_cast<double>(std::max(small_bricks, 4 * facets.size()));
  if (bricks_.template cast<double>().prod() > most_bricks) return false;
  const double layers = 2 + 2 * margin_ * per_cell_;
  double entries = 0;
  for (const auto& f : facets) entries += layers * (area(f) * std::pow(per_cell_, Dim - 1) + 2);
  return entries <= static_cast<double>(std::max(small_entries, 24 * facets.size()));
}

/// The cells lo..hi that the facet reaches into: halves the block while the facet reaches into it.
template <int Dim>
template <class Visit>
void FacetGrid<Dim>::cells_of(const BoxTest<Dim>& f, const Index& lo, const Index& hi, Visit&& visit) const {
  const Point<Dim> a = origin_ + cell_ * lo.template cast<double>(),
                   b = origin_ + cell_ * (hi + Index::Ones()).template cast<double>();
  const double grow = margin_ + round_off * (a.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff());
  if (!f.overlaps((a + b) / 2, (b - a) / 2 + Point<Dim>::Constant(grow))) return;
  int axis;
  const std::int32_t length = (hi - lo).maxCoeff(&axis);
  if (length == 0) return visit(lo);
  Index middle_hi = hi, middle_lo = lo;
  middle_hi[axis] = lo[axis] + length / 2;
  middle_lo[axis] = middle_hi[axis] + 1;
  cells_of(f, lo, middle_hi, visit);
  cells_of(f, middle_lo, hi, visit);
}

/// Any facet in the block of cells? Large blocks are looked at by the brick, very large ones not at all.
template <int Dim> bool FacetGrid<Dim>::any_in(const Index& lo, const Index& hi) const {
  const bool by_brick = (hi - lo).maxCoeff() > 3;
  if ((hi - lo).maxCoeff() > 64) return true;
  const std::int32_t step = by_brick ? 4 : 1;
  const Index first = by_brick ? Index(lo.unaryExpr([](std::int32_t c) { return c & ~3; })) : lo;
  for (Index c = first; c[Dim - 1] <= hi[Dim - 1];) {
    if (by_brick ? used_[brick_slot(c)] != 0 : used(c)) return true;
    for (int k = 0; (c[k] += step) > hi[k] && k < Dim - 1; ++k) c[k] = first[k];
  }
  return false;
}

template <int Dim> double FacetGrid<Dim>::mean_list() const {
  std::size_t lists = 0;
  for (const std::uint64_t brick : used_) lists += static_cast<std::size_t>(std::popcount(brick));
  return lists == 0 ? 0 : static_cast<double>(list_.size()) / static_cast<double>(lists);
}

template <int Dim> std::size_t FacetGrid<Dim>::bytes() const {
  return brick_.size() * 12 + start_.size() * 4 + list_.size() * 4;
}

template class BoxTest<2>;
template class BoxTest<3>;
template class FacetGrid<2>;
template class FacetGrid<3>;

}  // namespace molten
