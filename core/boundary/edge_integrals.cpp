#include "core/boundary/edge_integrals.h"

#include <algorithm>
#include <cmath>

#include "core/boundary/gauss.h"

namespace molten {

namespace {

const Gauss<16> rule;
constexpr int pieces = 6;  // that each half of an edge is integrated in

/// Calls add(s, ds) for the nodes of 0..b.
template <class Add> void integrate(double b, Add&& add) {
  for (int k = 0; k < pieces; ++k)
    for (std::size_t g = 0; g < rule.node.size(); ++g)
      add((k + (1 + rule.node[g]) / 2) * b / pieces, rule.weight[g] / 2 * b / pieces);
}

}  // namespace

EdgeIntegrals::EdgeIntegrals(const RadialIntegrals& radial)
    : reach_(radial.reach()), beyond_(rows * columns), along_(rows) {
  const double least = 1e-9 * reach_;  // on the edge itself nothing has an angle: the limit
  for (int row = 0; row < rows; ++row) {
    const double distance = std::max(least, reach_ * row / (rows - 1));
    const double half = std::sqrt(std::max(0.0, reach_ * reach_ - distance * distance));
    integrate(half, [&](double t, double dt) {
      along_[row] += 2 * dt * radial.weight_beyond(std::sqrt(distance * distance + t * t));
    });
    for (int column = 0; column < columns; ++column) {
      const double part = column / (columns - 1.0), size = std::hypot(part, 1 - part);
      const double h = distance * (1 - part) / size, p = std::max(least * distance / reach_, distance * part / size);
      // ∫ Q dA = ∫ P p/ρ² dt along the edge with P = ∫_ρ^R Q s ds (see WallIntegrals); t = p sinh s.
      Entry& entry = beyond_[row * columns + column];
      integrate(std::asinh(half / p), [&](double s, double ds) {
        const double rho = p * std::cosh(s), r = std::sqrt(h * h + rho * rho), part_of_turn = 2 * ds * p / rho;
        entry.weight += part_of_turn * radial.weight_beyond(r);
        entry.hidden += part_of_turn * h * radial.hidden_beyond(r) / r;
      });
    }
  }
}

EdgeIntegrals::Between::Between(double place, int entries)
    : first(std::clamp(static_cast<int>(place) - 1, 0, entries - stencil)) {
  const double a = place - first, b = a - 1, c = a - 2, d = a - 3;
  weight = {-b * c * d / 6, a * c * d / 2, -a * b * d / 2, a * b * c / 6};
}

EdgeIntegrals::Beyond EdgeIntegrals::beyond(double h, double p) const {
  const double distance = std::sqrt(h * h + p * p);
  if (!(distance < reach_)) return {0, 0, 0};
  const Between row(distance / reach_ * (rows - 1), rows), column(p / (p + h + 1e-300) * (columns - 1), columns);
  Beyond sum{0, 0, 0};
  for (int m = 0; m < stencil; ++m) {
    const Entry* const entries = &beyond_[(row.first + m) * columns + column.first];
    double weight = 0, hidden = 0;
    for (int k = 0; k < stencil; ++k) {
      weight += column.weight[k] * entries[k].weight;
      hidden += column.weight[k] * entries[k].hidden;
    }
    sum.weight += row.weight[m] * weight;
    sum.hidden += row.weight[m] * hidden;
    sum.along += row.weight[m] * along_[row.first + m];
  }
  return sum;
}

}  // namespace molten
