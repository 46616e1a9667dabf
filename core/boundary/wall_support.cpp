#include "core/boundary/wall_support.h"

#include "core/boundary/wall_integrals.h"
#include "core/particle_pass.h"

namespace molten {

template <int Dim>
WallSupport<Dim>::WallSupport(const Contact<Dim>& contact, const Parameters<Dim>& p)
    : integrals_(std::make_shared<WallIntegrals<Dim>>(contact.fixed_walls(), contact.fixed_surface(), p.kernel,
                                                      p.smoothing_length)),
      walls_(contact.fixed_walls()),
      reach_(integrals_->reach() + p.skin) {}

template <int Dim>
template <class Real>
void WallSupport<Dim>::mark(const Particles<Dim, Real>& particles, std::size_t first_slot) {
  const std::size_t clusters = particles.slots() / cluster_size;
  plane_.assign(clusters, no_plane);
  const auto x = particles[position];
  const std::size_t first = first_slot / cluster_size;
  for_each_slot(clusters - first, [&](std::size_t n) {
    const std::size_t c = first + n;
    for (std::size_t slot = c * cluster_size; slot < (c + 1) * cluster_size; ++slot) {
      if (particles.is_padding(slot)) continue;
      Point<Dim> point;
      for (int k = 0; k < Dim; ++k) point[k] = x[k][slot];
      const std::int32_t plane = integrals_->plane_near(point, reach_);
      if (plane == no_plane) continue;
      plane_[c] = plane_[c] == no_plane || plane_[c] == plane ? plane : many_planes;
    }
  });
}

template <int Dim> std::size_t WallSupport<Dim>::bytes() const {
  return (integrals_ ? integrals_->bytes() : 0) + plane_.capacity() * sizeof(plane_[0]);
}

template class WallSupport<2>;
template class WallSupport<3>;
template void WallSupport<2>::mark(const Particles<2, float>&, std::size_t);
template void WallSupport<2>::mark(const Particles<2, double>&, std::size_t);
template void WallSupport<3>::mark(const Particles<3, float>&, std::size_t);
template void WallSupport<3>::mark(const Particles<3, double>&, std::size_t);

}  // namespace molten
