// Volume, centre of mass and inertia of the body that a closed wall encloses.
#pragma once

#include "core/boundary/contact.h"

namespace molten {

template <int Dim> struct MassProperties {
  double measure = 0;                      // m³ (2-D: m²); not positive for a surface that is open or inside out
  Point<Dim> centre = Point<Dim>::Zero();  // m
  /// Of the mass 1 kg/m³ about the centre, kg m² (2-D: the polar moment of 1 kg/m², a slice 1 m deep).
  Eigen::Matrix<double, Dim == 2 ? 1 : 3, Dim == 2 ? 1 : 3> inertia = decltype(inertia)::Zero();
};

/// The wall's normals point out of the body. Sums over the cones from a corner to the facets.
MassProperties<2> mass_properties(const Wall<2>& wall);
MassProperties<3> mass_properties(const Wall<3>& wall);

}  // namespace molten
