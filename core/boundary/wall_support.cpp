#include "core/boundary/wall_support.h"

#include "core/boundary/wall_integrals.h"
#include "core/particle_pass.h"

namespace molten {

namespace {

/// The rate of damping beside a plane, 2ν ∫W dS/d for the wall's part and half of that of the fluid far from walls,
/// both over what is left of the support, by that of the fluid.
double stiffness_beside_plane(const RadialIntegrals& radial, double d, double h) {
  constexpr double fluid = 8;  // ν/h²; the viscous limit of the time step was measured with it
  const double wall = 2 * radial.plane_weight(d) * h * h / d;
  return (wall + fluid / 2) / (fluid * (1 - radial.plane_hidden(d)));
}

}  // namespace

template <int Dim>
WallSupport<Dim>::WallSupport(const Contact<Dim>& contact, const Parameters<Dim>& p)
    : integrals_(
          std::make_shared<WallIntegrals<Dim>>(contact.walls(), contact.surface(), p.kernel, p.smoothing_length)),
      walls_(contact.walls()),
      reach_(integrals_->reach() + p.skin),
      viscous_stiffness_(stiffness_beside_plane(RadialIntegrals(p.kernel, Dim, p.smoothing_length), p.spacing / 2,
                                                p.smoothing_length)) {}

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
