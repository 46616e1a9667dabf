// Integrals of one kernel over what lies beyond a straight edge of a plane, in tables: a facet whose edge crosses the
// whole support needs no quadrature.
#pragma once

#include <array>
#include <vector>

#include "core/boundary/radial_integrals.h"

namespace molten {

/// Of a particle at the height h over a plane, with an edge in that plane at the distance p from its foot. In 3-D.
class EdgeIntegrals {
 public:
  EdgeIntegrals() = default;
  explicit EdgeIntegrals(const RadialIntegrals& radial);

  /// Over the half of the plane beyond the edge, seen from the foot.
  struct Beyond {
    double weight;  // ∫ W dS, 1/m
    double hidden;  // h ∫ H dS: the part of ∫ W dV behind that half
    double along;   // ∫ ∫_r^R W s ds dt along the edge, which is the moment ∫ W x dS across it
  };
  /// h and p: m, not below 0. Good to 4e-5 of what a plane through the particle has.
  Beyond beyond(double h, double p) const;

 private:
  /// By the distance from the edge, √(h² + p²), and by p/(p + h), which stands for the angle: the integrals are smooth
  /// in these, even for a particle on the edge, where what is hidden depends on the angle alone.
  static constexpr int rows = 33, columns = 25, stencil = 4;
  struct Entry {
    double weight = 0, hidden = 0;
  };
  /// Lagrange's weights of four entries that follow one another.
  struct Between {
    int first;
    std::array<double, stencil> weight;
    Between(double place, int entries);
  };

  double reach_ = 0;           // m
  std::vector<Entry> beyond_;  // by row, by column
  std::vector<double> along_;  // by row
};

}  // namespace molten
