// A cluster's particles where the inside of one face is all that they can meet: one bounce each at most, all at once.
#pragma once

#include <optional>

#include "core/boundary/impact.h"
#include "core/boundary/sweep.h"
#include "core/cluster_motion.h"

namespace molten {

template <int Dim> class FaceBounce {
  using Wide = ClusterLanes;
  using Vectors = Vec<Dim, Wide>;

 public:
  /// `radius` (m) of the particles, `skin` (m) the gap that a contact leaves.
  FaceBounce(const Facet<Dim>& facet, const Wall<Dim>& wall, double radius, double skin)
      : normal_(lanes_of(facet.normal)),
        corner_(lanes_of(facet.corner[0])),
        wall_velocity_(lanes_of(wall.skin.velocity_along(facet.normal))),
        response_(wall.response),
        radius_(radius),
        skin_(skin) {}

  /// Moves them by dt (s); 1 for those that bounced, else 0. No value and no motion where one overlaps the wall or is
  /// behind it, would meet it again, or is sped up by it and so may get further than was thought.
  std::optional<Wide> move(ClusterMotion<Dim>& m, double dt) const {
    const Vectors way = Wide(dt) * m.rate;
    const Wide height = dot(normal_, m.position - corner_), descent = -dot(normal_, way), end = height - descent;
    if (less_lanes(height, radius_)) return std::nullopt;
    if (!less_lanes(end, radius_)) {
      m.position += way;
      return Wide(0.0);
    }
    const auto where_met = [&](const Wide& met, const Wide& free) { return select_less(end, radius_, met, free); };
    const Wide t = where_met((height - radius_) / descent, Wide(1.0));  // of the step, until the contact
    // Within the gap that the last contact left the particle has touched the wall all the time.
    const Wide held = Wide(dt) - select_less(Wide(4.0) * skin_, t * descent, Wide(dt) * t, Wide(0.0));  // s
    const Vectors rate = after_impact(m.rate, normal_, wall_velocity_, response_, held);
    const Vectors onwards = (Wide(dt) * (Wide(1.0) - t)) * rate;
    const Wide speed2 = Wide(1 + 1e-9) * dot(m.rate, m.rate);
    if (less_lanes(where_met(speed2, Wide(0.0)), where_met(dot(rate, rate), Wide(0.0))) ||
        less_lanes(skin_, where_met(-dot(normal_, onwards), Wide(0.0))))
      return std::nullopt;
    const Vectors velocity = after_impact(m.velocity, normal_, wall_velocity_, response_, held);
    const Vectors met = m.position + t * way + skin_ * normal_ + onwards, free = m.position + way;
    unrolled<Dim>([&](auto d) {
      m.position[d] = where_met(met[d], free[d]);
      m.velocity[d] = where_met(velocity[d], m.velocity[d]);
    });
    return where_met(Wide(1.0), Wide(0.0));
  }

 private:
  static Vectors lanes_of(const Point<Dim>& x) {
    Vectors all;
    for (int d = 0; d < Dim; ++d) all[d] = Wide(x[d]);
    return all;
  }

  Vectors normal_, corner_;  // -, m
  Vectors wall_velocity_;    // m/s
  const Response& response_;
  Wide radius_, skin_;  // m
};

}  // namespace molten
