// How far particles are from what conducts differently: a pass of its own before the rates.
#include "core/physics/heat_interface.h"

#include "core/rates_pass.h"

namespace molten {

template <int Dim, class Real> void find_interfaces(State<Dim, Real>& s) {
  const auto scope = s.timer.scope("interfaces");
  const Particles<Dim, Real>& p = s.particles;
  const auto finish = PlainFinish{[&p, k = p[conductivity][0], distance = p[interface_distance][0],
                                   resistance = p[interface_resistance][0]](std::size_t slot, const auto& sums) {
    const bool there = !p.is_padding(slot);
    distance[slot] = there ? interface_distance_at(Real(sums[kernel_mean] / sums[kernel_sum])) : 0;
    resistance[slot] = there ? distance[slot] / k[slot] : 0;
  }};
  with_run_kernel(s, [&](const auto& kernel) {
    pair_pass<native_lanes<Real>>(s.neighbours, s.particles, kernel, finish, InterfaceSums{});
  });
}

#define MOLTEN_INSTANTIATE(Dim, Real) template void find_interfaces(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
