// A fluid that starts at rest under its own weight (fluid.hydrostatic): each column stands on its floor and is as much
// lower than uncompressed as dp = −ρ g dz makes it. Particles as far apart at the bottom as at the surface would not be
// as dense there as their pressure says, and sink.
#pragma once

#include <vector>

#include "core/boundary/point.h"
#include "core/parameters.h"
#include "core/physics/pressure.h"

namespace molten {

template <int Dim> class FluidAtRest {
 public:
  /// Not squeezed: the particles stay where they are, and only their pressure is that of a fluid at rest.
  FluidAtRest(const Parameters<Dim>& parameters, const Start& start, bool squeezed);

  Point<Dim> place(const Start& start, std::size_t k) const;  // of particle k, m
  double compression(const Point<Dim>& x) const;              // of fluid there; 0 above the surface

 private:
  void squeeze(const Start& start);
  /// How much lower a column is (m) that is `weight` high uncompressed (m).
  double squeezed_by(double weight) const;

  EquationOfState eos_;
  double gravity_ = 0;                  // m/s²
  Point<Dim> up_ = Point<Dim>::Zero();  // unit
  double level_ = 0;                    // m along `up_`, of the surface
  std::vector<double> sinking_;         // m, by particle; empty if none
};

}  // namespace molten
