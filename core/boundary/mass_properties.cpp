#include "core/boundary/mass_properties.h"

#include <Eigen/Geometry>

namespace molten {

MassProperties<2> mass_properties(const Wall<2>& wall) {
  MassProperties<2> p;
  if (wall.facets.empty()) return p;
  const Point<2> origin = wall.vertices[wall.facets[0][0]];
  Point<2> first = Point<2>::Zero();
  double polar = 0;
  for (const auto& f : wall.facets) {
    // The outside is to the left of a → b, so the body is to the left of b → a.
    const Point<2> a = wall.vertices[f[1]] - origin, b = wall.vertices[f[0]] - origin;
    const double twice = a.x() * b.y() - a.y() * b.x();
    p.measure += twice / 2;
    first += twice / 6 * (a + b);
    polar += twice / 12 * (a.dot(a) + a.dot(b) + b.dot(b));
  }
  if (!(p.measure > 0)) return p;
  const Point<2> centre = first / p.measure;
  p.centre = origin + centre;
  p.inertia(0, 0) = polar - p.measure * centre.squaredNorm();
  return p;
}

MassProperties<3> mass_properties(const Wall<3>& wall) {
  MassProperties<3> p;
  if (wall.facets.empty()) return p;
  const Point<3> origin = wall.vertices[wall.facets[0][0]];
  Point<3> first = Point<3>::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // ∫ x xᵀ
  for (const auto& f : wall.facets) {
    const Point<3> a = wall.vertices[f[0]] - origin, b = wall.vertices[f[1]] - origin, c = wall.vertices[f[2]] - origin;
    const double six = a.dot(b.cross(c));
    const Point<3> sum = a + b + c;
    p.measure += six / 6;
    first += six / 24 * sum;
    second += six / 120 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  if (!(p.measure > 0)) return p;
  const Point<3> centre = first / p.measure;
  second -= p.measure * centre * centre.transpose();
  p.centre = origin + centre;
  p.inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  return p;
}

}  // namespace molten
