// What becomes of a velocity at a wall ([P] 6.3.1, with Coulomb's friction and a stress that sticks).
#pragma once

#include <cmath>

#include "core/boundary/contact.h"
#include "core/simd.h"
#include "core/vec.h"

namespace molten {

/// The velocity u after an impact on a wall with the unit normal `normal` and the velocity `wall`, all in m/s, that is
/// touched for dt (s). T: double or lanes of it.
template <int Dim, class T>
Vec<Dim, T> after_impact(const Vec<Dim, T>& u, const Vec<Dim, T>& normal, const Vec<Dim, T>& wall, const Response& r,
                         const T& dt) {
  const Vec<Dim, T> relative = u - wall;
  const T normal_part = dot(relative, normal);
  const Vec<Dim, T> tangential = relative - normal_part * normal;
  const T rebound = select_less(normal_part, T(0.0), T(-r.restitution) * normal_part, normal_part);
  T keeps(r.slip);
  if (r.grip) {
    const T brake = T(r.grip->friction) * (rebound - normal_part) + T(r.grip->hold) * dt;
    const T speed = each_lane(dot(tangential, tangential), [](double x) { return std::sqrt(x); });
    keeps = select_less(brake, speed, T(1.0) - brake / speed, T(0.0));
  }
  return wall + keeps * tangential + rebound * normal;
}

}  // namespace molten
