#include "core/fill.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>

#include "core/error.h"
#include "core/filler.h"

namespace molten {
namespace {

/// Tries lattices and remembers the one nearest to the asked number. All of them have nearly the spacing whose cells
/// fill the measure exactly, so that density starts right; what varies is where the lattice lies.
class Search {
 public:
  Search(const Filler& filler, long long asked) : filler_(filler), asked_(asked) {
    spacing_ = spacing_for(static_cast<double>(asked));
    filler_.require_feasible(spacing_);
    close_enough_ = asked / 50000;
  }

  Lattice nearest() {
    offer(anchored(spacing_));
    for (int i = 1; i <= 80 && !done(); ++i) offer(anchored(spacing_ * (1 + (i % 2 ? 2.5e-5 : -2.5e-5) * i)));
    if (!done()) offer_centred();
    if (!done()) offer_shifted();
    if (!near()) bisect();
    settle();
    return best_;
  }
  bool near() const { return 100 * off(best_count_) <= asked_; }

  /// The lattice with the smallest count not below the asked one, for leaving cells out.
  const Lattice& above() {
    for (double s = spacing_; above_count_ < 0; s *= 0.98) offer(anchored(s));
    return above_;
  }

 private:
  double spacing_for(double particles) const {
    return std::pow(filler_.measure() / particles, 1.0 / filler_.dimensions());
  }
  long long off(long long count) const { return std::llabs(count - asked_); }
  bool done() const { return off(best_count_) <= close_enough_; }

  /// Cells start at the bounding box's lower corner: an aligned box is filled to its faces.
  Lattice anchored(double spacing) const { return shifted(spacing, Vec3::Constant(0.5)); }
  /// `shift`: from the bounding box's lower corner to the first cell centre, in spacings.
  Lattice shifted(double spacing, const Vec3& shift) const {
    Lattice lattice{filler_.bounds().min() + spacing * shift, spacing};
    if (filler_.dimensions() == 2) lattice.first.z() = 0;
    return lattice;
  }

  long long offer(const Lattice& lattice) {
    const long long count = filler_.count(lattice);
    if (best_count_ < 0 || off(count) < off(best_count_)) best_ = lattice, best_count_ = count;
    if (count >= asked_ && (above_count_ < 0 || count < above_count_)) above_ = lattice, above_count_ = count;
    return count;
  }

  /// Boxes: a number of cells per axis just below or above the extent, centred, at the spacing that makes it fit.
  void offer_centred() {
    const int dimensions = filler_.dimensions();
    const Vec3 cells = filler_.bounds().sizes() / spacing_;
    for (int choice = 0; choice < 1 << dimensions; ++choice) {
      Vec3 whole = Vec3::Zero();
      double ratio = 1;
      for (int k = 0; k < dimensions; ++k) {
        whole[k] = std::max(1.0, std::floor(cells[k]) + (choice >> k & 1));
        ratio *= cells[k] / whole[k];
      }
      const double spacing = spacing_ * std::pow(ratio, 1.0 / dimensions);
      offer(shifted(spacing, (filler_.bounds().sizes() / spacing - whole) / 2 + Vec3::Constant(0.5)));
    }
  }

  /// Rounded shapes: offsets spread evenly over the cell (a sequence of irrational steps).
  void offer_shifted() {
    const Vec3 step = filler_.dimensions() == 3 ? Vec3(0.8191725134, 0.6710436067, 0.5497004779)
                                                : Vec3(0.7548776662, 0.5698402910, 0);
    for (int i = 1; i <= 100 && !done(); ++i)
      offer(shifted(spacing_, (Vec3::Constant(0.5) + i * step).unaryExpr([](double v) { return v - std::floor(v); })));
  }

  /// Regions a cell or two thick, where the fitting spacing misses the region: any spacing that gives the number.
  void bisect() {
    double few = 2 * spacing_, many = spacing_ / 2;
    for (int i = 0; i < 40 && !near(); ++i) {
      const double middle = std::sqrt(few * many);
      (offer(anchored(middle)) < asked_ ? few : many) = middle;
    }
  }

  /// An aligned box is filled by the same number of particles at a range of spacings; take the one that fills its
  /// cells.
  void settle() {
    const Lattice fitting = anchored(spacing_for(static_cast<double>(best_count_)));
    if (best_count_ > 0 && best_count_ != asked_ && filler_.count(fitting) == best_count_) best_ = fitting;
  }

  const Filler& filler_;
  long long asked_;
  double spacing_ = 0;  // m
  long long close_enough_ = 0;
  Lattice best_, above_;
  long long best_count_ = -1, above_count_ = -1;
};

/// Leaves out the highest cells of the largest region, from the rim to the middle, until the number is the asked one.
void leave_out(Filling& filling, long long asked, int dimensions) {
  std::vector<long long> sizes(filling.region.back() + 1);
  for (const int r : filling.region) ++sizes[r];
  const int largest = static_cast<int>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  std::vector<std::size_t> candidates;
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < filling.positions.size(); ++i) {
    if (filling.region[i] != largest) continue;
    candidates.push_back(i);
    box.extend(filling.positions[i]);
  }
  const int up = dimensions - 1;
  const Vec3 middle = box.center();
  const auto rim = [&](const Vec3& x) {
    Vec3 d = x - middle;
    d[up] = 0;
    return d.squaredNorm();
  };
  std::sort(candidates.begin(), candidates.end(), [&](std::size_t i, std::size_t j) {
    const Vec3 &a = filling.positions[i], &b = filling.positions[j];
    if (a[up] != b[up]) return a[up] > b[up];
    const double ra = rim(a), rb = rim(b);
    return ra != rb ? ra > rb : i < j;
  });
  const std::size_t excess = filling.positions.size() - static_cast<std::size_t>(asked);
  std::vector<bool> out(filling.positions.size());
  for (std::size_t k = 0; k < std::min(excess, candidates.size() - 1); ++k) out[candidates[k]] = true;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i]) continue;
    filling.positions[kept] = filling.positions[i];
    filling.region[kept++] = filling.region[i];
  }
  filling.positions.resize(kept);
  filling.region.resize(kept);
}

Filling fill_count(const Filler& filler, long long asked) {
  Search search(filler, asked);
  const Lattice nearest = search.nearest();
  if (search.near()) return filler.place(nearest);
  // A small aligned box has no lattice within 1 %: 20³, 20²·21, 20·21², 21³ are 5 % apart.
  Filling filling = filler.place(search.above());
  leave_out(filling, asked, filler.dimensions());
  return filling;
}

}  // namespace

Filling fill(const std::vector<Region>& regions, int dimensions, std::optional<long long> count,
             std::optional<double> spacing) {
  if (count.has_value() == spacing.has_value())
    throw Error(ExitCode::usage, "give either the number of particles or their spacing");
  if (count && (*count < static_cast<long long>(regions.size()) || *count > 2147483648LL))
    throw Error(ExitCode::usage, "cannot fill with " + std::to_string(*count) +
                                     " particles: ask for at least one a body and at most 2147483648");
  if (spacing && !(*spacing > 0 && std::isfinite(*spacing)))
    throw Error(ExitCode::usage, "the particle spacing must be positive (m)");
  const Filler filler(regions, dimensions);
  if (count) return fill_count(filler, *count);
  filler.require_feasible(*spacing);
  Lattice lattice{filler.bounds().min() + Vec3::Constant(*spacing / 2), *spacing};
  if (dimensions == 2) lattice.first.z() = 0;
  return filler.place(lattice);
}

}  // namespace molten
