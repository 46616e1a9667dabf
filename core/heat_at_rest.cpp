// Heat where nothing moves: the conduction pass alone, over the warm particles, a few steps at a time.
#include <cmath>

#include "core/rates_pass.h"

namespace molten {

template <int Dim, class Real> void conduct_at_rest(State<Dim, Real>& s) {
  Particles<Dim, Real>& p = s.particles;
  const double dt = std::exchange(s.sleep.warm_time, 0);
  const std::size_t first = s.neighbours.first_slot(Block::warm), end = s.neighbours.first_slot(Block::active);
  if (first == end) return;
  const auto conduction = heat_conduction_of<false>(s);
  const auto finish = PlainFinish{
      [rate = p[temperature_rate][0]](std::size_t slot, const auto& sums) { rate[slot] = sums[temperature_rate]; }};
  with_run_kernel(s, [&](const auto& kernel) {
    pair_pass_over<native_lanes<Real>>(s.neighbours.warm_chunks(p), s.neighbours, p, kernel,
                                       WithWalls(s.wall_support, s.parameters, p, finish, conduction), conduction);
  });
  const RestBounds& bounds = *s.parameters.rest;
  const auto T = p[temperature][0];
  const auto local_T = p[local_temperature][0], rate = p[temperature_rate][0], rested = p[heat_rest_time][0];
  const auto last_active = p[rest_temperature][0], still = p[rest_time][0];
  for_each_slot(end - first, [&](std::size_t k) {
    const std::size_t slot = first + k;
    if (p.is_padding(slot)) return;
    T[slot] += dt * rate[slot];
    local_T[slot] = static_cast<Real>(T[slot] - s.parameters.reference_temperature);
    rested[slot] = std::abs(rate[slot]) <= bounds.temperature_rate ? rested[slot] + static_cast<Real>(dt) : 0;
    if (last_active && std::abs(T[slot] - last_active[slot]) > bounds.temperature) still[slot] = 0;
  });
}

#define MOLTEN_INSTANTIATE(Dim, Real) template void conduct_at_rest(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
