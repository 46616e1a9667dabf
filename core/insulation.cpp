// What insulating walls hide of the support, particle by particle, before the rates.
#include "core/physics/insulation.h"

#include "core/particle_pass.h"
#include "core/step.h"

namespace molten {

namespace {

template <int Dim> bool insulates(const WallSupport<Dim>& walls, std::int32_t wall) {
  return !walls.wall(wall).skin.temperature;
}

template <int Dim> double hidden_by_insulators(const WallSupport<Dim>& walls, std::size_t slot, const Point<Dim>& x) {
  const std::int32_t number = walls.plane(slot / cluster_size);
  if (number == WallSupport<Dim>::no_plane) return 0;
  if (number != WallSupport<Dim>::many_planes) {
    const auto& [normal, offset, wall] = walls.integrals().plane(number);
    return insulates(walls, wall) ? walls.integrals().of_plane(normal.dot(x) - offset).hidden : 0;
  }
  double hidden = 0;
  walls.visit(slot, x, [&](const WallPatch<Dim>& patch) {
    if (insulates(walls, patch.wall)) hidden += patch.hidden;
  });
  return hidden;
}

}  // namespace

template <int Dim, class Real> void find_heat_completions(State<Dim, Real>& s) {
  const auto scope = s.timer.scope("walls");
  const auto x = s.particles[position];
  const auto factor = s.particles[heat_completion][0];
  const std::size_t first = s.neighbours.first_slot(Block::active);
  for_each_slot(s.particles.slots() - first, [&](std::size_t k) {
    const std::size_t slot = first + k;
    Point<Dim> at;
    for (int d = 0; d < Dim; ++d) at[d] = x[d][slot];
    const double hidden = s.particles.is_padding(slot) ? 0 : hidden_by_insulators(s.wall_support, slot, at);
    factor[slot] = static_cast<Real>(heat_completion_at(hidden));
  });
}

#define MOLTEN_INSTANTIATE(Dim, Real) template void find_heat_completions(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
