#include "io/geometry/leak.h"

#include <array>
#include <cmath>
#include <map>
#include <queue>

namespace molten {
namespace {

template <int Dim> using Cell = std::array<std::int32_t, Dim>;

template <int Dim> class Flood {
 public:
  /// The cells' middles are a lattice of `step` m about the origin.
  Flood(const Contact<Dim>& contact, const Point<Dim>& origin, double step)
      : contact_(contact), origin_(origin), step_(step) {}

  Point<Dim> lower = Point<Dim>::Constant(HUGE_VAL), upper = -lower;  // m; around the walls, open upwards
  double top = -HUGE_VAL;                                             // m; along `up`
  Point<Dim> up = Point<Dim>::Zero();

  void pour(const Point<Dim>& x) {
    const Cell<Dim> cell = cell_of(x);
    if (from_.try_emplace(cell, cell).second) queue_.push(cell);
  }

  bool is_outside(const Point<Dim>& x) const {
    return ((x - lower).array() < -2 * step_).any() || ((x - upper).array() > 2 * step_).any();
  }

  std::optional<Leak<Dim>> run(std::size_t most_cells) {
    for (; !queue_.empty() && from_.size() < most_cells; queue_.pop()) {
      const Cell<Dim> here = queue_.front();
      if (is_outside(middle(here))) return leak_to(here);
      for (int d = 0; d < Dim; ++d)
        for (const int step : {-1, 1}) {
          Cell<Dim> there = here;
          there[d] += step;
          if (from_.contains(there) || up.dot(middle(there)) > top || !is_free(here, there)) continue;
          from_.emplace(there, here);
          queue_.push(there);
        }
    }
    return std::nullopt;
  }

 private:
  Cell<Dim> cell_of(const Point<Dim>& x) const {
    Cell<Dim> cell;
    for (int d = 0; d < Dim; ++d) cell[d] = static_cast<std::int32_t>(std::lround((x[d] - origin_[d]) / step_));
    return cell;
  }
  Point<Dim> middle(const Cell<Dim>& cell) const {
    Point<Dim> x;
    for (int d = 0; d < Dim; ++d) x[d] = origin_[d] + cell[d] * step_;
    return x;
  }
  bool is_free(const Cell<Dim>& a, const Cell<Dim>& b) const {
    Motion<Dim> m{middle(a), Point<Dim>::Zero(), middle(b) - middle(a)};
    return contact_.move(m, 1) == 0 && (m.position - middle(b)).norm() < 1e-6 * step_;
  }
  Leak<Dim> leak_to(Cell<Dim> cell) const {
    Leak<Dim> leak{middle(cell), middle(cell)};
    double nearest = HUGE_VAL;
    for (; from_.at(cell) != cell; cell = from_.at(cell)) {
      const double distance = std::abs(contact_.signed_distance(middle(cell), 8 * step_));
      if (distance < nearest) nearest = distance, leak.narrowest = middle(cell);
    }
    return leak;
  }

  const Contact<Dim>& contact_;
  Point<Dim> origin_;
  double step_;
  std::map<Cell<Dim>, Cell<Dim>> from_;  // each cell that was reached: from where
  std::queue<Cell<Dim>> queue_;
};

}  // namespace

template <int Dim>
std::optional<Leak<Dim>> find_leak(const Scene& scene, const Start& start, const std::vector<Wall<Dim>>& walls,
                                   const Contact<Dim>& contact, std::size_t most_cells) {
  if (start.position.empty()) return std::nullopt;
  Point<Dim> origin;
  for (int d = 0; d < Dim; ++d) origin[d] = start.position[0][d];
  Flood<Dim> flood(contact, origin, start.spacing / 2);
  bool any = false;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const Wall<Dim>& wall = walls[w];
    if (wall.is_plane || wall.body >= 0 || scene.boundaries[w].shape.terrain) continue;
    any = any || !wall.vertices.empty();
    for (const Point<Dim>& v : wall.vertices) {
      flood.lower = flood.lower.cwiseMin(v);
      flood.upper = flood.upper.cwiseMax(v);
    }
  }
  for (int d = 0; d < Dim; ++d) flood.up[d] = -scene.gravity[d];
  if (!any || flood.up.isZero(0)) return std::nullopt;
  flood.up.normalize();
  for (const auto& at : start.position) {
    Point<Dim> x;
    for (int d = 0; d < Dim; ++d) x[d] = at[d];
    if (flood.is_outside(x)) return std::nullopt;  // they do not hold it to begin with
    flood.top = std::max(flood.top, flood.up.dot(x));
    flood.pour(x);
  }
  return flood.run(most_cells);
}

template std::optional<Leak<2>> find_leak(const Scene&, const Start&, const std::vector<Wall<2>>&, const Contact<2>&,
                                          std::size_t);
template std::optional<Leak<3>> find_leak(const Scene&, const Start&, const std::vector<Wall<3>>&, const Contact<3>&,
                                          std::size_t);

}  // namespace molten
