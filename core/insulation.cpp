// What insulating walls hide of the support, particle by particle, before the rates.
#include "core/physics/insulation.h"

#include "core/particle_pass.h"
#include "core/step.h"

namespace molten {

namespace {

template <int Dim>
HiddenFromHeat hidden_from_heat(const WallSupport<Dim>& walls, std::size_t slot, const Point<Dim>& x) {
  HiddenFromHeat hidden;
  const auto add = [&](std::int32_t wall, double part) {
    (walls.wall(wall).skin.temperature ? hidden.heated : hidden.insulated) += part;
  };
  const std::int32_t number = walls.plane(slot / cluster_size);
  if (number == WallSupport<Dim>::many_planes) {
    walls.visit(slot, x, [&](const WallPatch<Dim>& patch) { add(patch.wall, patch.hidden); });
  } else if (number != WallSupport<Dim>::no_plane) {
    const auto& [normal, offset, wall] = walls.integrals().plane(number);
    add(wall, walls.integrals().of_plane(normal.dot(x) - offset).hidden);
  }
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
    const bool there = !s.particles.is_padding(slot);
    factor[slot] = there ? static_cast<Real>(heat_completion_at(hidden_from_heat(s.wall_support, slot, at))) : Real(1);
  });
}

#define MOLTEN_INSTANTIATE(Dim, Real) template void find_heat_completions(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
