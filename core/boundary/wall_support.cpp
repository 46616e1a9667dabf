#include "core/boundary/wall_support.h"

#include "core/boundary/near_walls.h"
#include "core/particle_pass.h"

namespace molten {

namespace {

/// The rate of damping beside a plane, 2ν ∫W dS/d for the wall's part and half of that of the fluid far from walls,
/// both over what is left of the support, by that of the fluid.
double stiffness_beside_plane(const RadialIntegrals& radial, double d, double h) {
  constexpr double fluid = 8;  // ν/h²; the viscous limit of the time step was measured with it
  const RadialIntegrals::Plane plane = radial.plane(d);
  const double wall = 2 * plane.weight * h * h / d;
  return (wall + fluid / 2) / (fluid * (1 - plane.hidden));
}

}  // namespace

template <int Dim>
WallSupport<Dim>::WallSupport(const Contact<Dim>& contact, const Bodies<Dim>& bodies, const Parameters<Dim>& p)
    : reach_(p.support_radius + p.skin),
      viscous_stiffness_(stiffness_beside_plane(RadialIntegrals(p.kernel, Dim, p.smoothing_length), p.spacing / 2,
                                                p.smoothing_length)) {
  const auto integrals_of = [&](std::int32_t body) {
    return std::make_shared<const WallIntegrals<Dim>>(contact.walls_of(body), contact.surface_of(body), p.kernel,
                                                      p.smoothing_length);
  };
  integrals_ = integrals_of(-1);
  walls_ = contact.walls_of(-1);
  for (std::size_t k = 0; k < bodies.count(); ++k) {
    const auto body = static_cast<std::int32_t>(k);
    const auto first = static_cast<std::int32_t>(walls_.size());
    bodies_.push_back({integrals_of(body), bodies.body(k).extent, first, bodies.motion(k)});
    const auto& walls = contact.walls_of(body);
    walls_.insert(walls_.end(), walls.begin(), walls.end());
  }
}

template <int Dim> void WallSupport<Dim>::place(const Bodies<Dim>& bodies) {
  for (std::size_t k = 0; k < bodies_.size(); ++k) bodies_[k].motion = bodies.motion(k);
}

template <int Dim> std::int32_t WallSupport<Dim>::plane_near(const Point<Dim>& x, double reach) const {
  for (const Moving& body : bodies_)
    if (body.is_near(x, reach) && body.integrals->plane_near(body.motion.start.to_body(x), reach) != no_plane)
      return many_planes;
  return integrals_->plane_near(x, reach);
}

template <int Dim>
template <class Real>
void WallSupport<Dim>::mark(const Particles<Dim, Real>& particles, std::size_t first_slot, const Bodies<Dim>& bodies,
                            const Contact<Dim>& contact) {
  place(bodies);
  plane_.assign(particles.slots() / cluster_size, no_plane);
  for_each_near_walls(particles, contact, first_slot, reach_, [&](std::size_t cluster) {
    const std::size_t slot = cluster * cluster_size;
    const PlacesBox<Dim> box(particles, slot, slot + cluster_size);
    if (box.empty()) return;
    std::int32_t& marked = plane_[cluster];
    marked = plane_near((box.lower + box.upper) / 2, reach_ + (box.upper - box.lower).norm() / 2);
    if (marked != many_planes) return;
    marked = no_plane;
    for_each_place(particles, slot, slot + cluster_size, [&](std::size_t, const Point<Dim>& x) {
      if (marked == many_planes) return;
      const std::int32_t plane = plane_near(x, reach_);
      if (plane != no_plane) marked = marked == no_plane || marked == plane ? plane : many_planes;
    });
  });
}

template <int Dim>
template <class Real>
void WallSupport<Dim>::find_patches(const Particles<Dim, Real>& particles, std::size_t first_slot) {
  patches_.resize(plane_.size());
  const auto x = particles[position];
  const std::size_t first = first_slot / cluster_size;
  for_each_piece(plane_.size() - first, [&](std::size_t n) {
    const std::size_t c = first + n;
    Patches& patches = patches_[c];
    patches.begin.fill(0);
    patches.all.clear();
    if (plane_[c] != many_planes) return;
    for (std::size_t k = 0; k < cluster_size; ++k) {
      const std::size_t slot = c * cluster_size + k;
      Point<Dim> point;
      for (int d = 0; d < Dim; ++d) point[d] = x[d][slot];
      if (!particles.is_padding(slot))
        visit_all(point, [&](const WallPatch<Dim>& patch) { patches.all.push_back(patch); });
      patches.begin[k + 1] = static_cast<std::uint32_t>(patches.all.size());
    }
  });
  found_ = true;
}

template <int Dim> std::size_t WallSupport<Dim>::bytes() const {
  std::size_t bytes = (integrals_ ? integrals_->bytes() : 0) + plane_.capacity() * sizeof(plane_[0]);
  for (const Moving& body : bodies_) bytes += body.integrals->bytes();
  for (const Patches& p : patches_) bytes += sizeof p + p.all.capacity() * sizeof p.all[0];
  return bytes;
}

template class WallSupport<2>;
template class WallSupport<3>;
#define MOLTEN_INSTANTIATE(Dim, Real)                                                                \
  template void WallSupport<Dim>::mark(const Particles<Dim, Real>&, std::size_t, const Bodies<Dim>&, \
                                       const Contact<Dim>&);                                         \
  template void WallSupport<Dim>::find_patches(const Particles<Dim, Real>&, std::size_t);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
