// What walls add to the sums of the particles near them, straight from the mesh, without boundary particles
// (wall_terms.h has the formulas): the walls' integrals, and which of them each cluster may reach before the next sort.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/archive.h"
#include "core/boundary/contact.h"
#include "core/boundary/wall_integrals.h"
#include "core/parameters.h"
#include "core/particles.h"

namespace molten {

template <int Dim> class WallSupport {
 public:
  WallSupport() = default;
  WallSupport(const Contact<Dim>& contact, const Parameters<Dim>& parameters);

  /// Finds the planes near the particles from `first_slot` on; the others are not asked for.
  template <class Real> void mark(const Particles<Dim, Real>& particles, std::size_t first_slot);

  /// What the cluster may reach: the number of a plane, or one of the two below.
  std::int32_t plane(std::size_t cluster) const { return plane_.empty() ? no_plane : plane_[cluster]; }
  static constexpr std::int32_t no_plane = WallIntegrals<Dim>::no_plane, many_planes = WallIntegrals<Dim>::many_planes;

  /// Finds the pieces of walls near the particles from `first_slot` on, where many planes are, for all passes until
  /// they are forgotten: particles must stay where they are. They are dear: as much as a third of a pass over all
  /// pairs.
  template <class Real> void find_patches(const Particles<Dim, Real>& particles, std::size_t first_slot);
  void forget_patches() { found_ = false; }

  /// Calls visit(patch) for each piece of a wall near a particle, which is at x: those found, or found now.
  template <class Visit> void visit(std::size_t slot, const Point<Dim>& x, Visit&& visit) const {
    if (!found_) return integrals_->visit(x, visit);
    const Patches& patches = patches_[slot / cluster_size];
    const std::size_t k = slot % cluster_size;
    for (std::uint32_t n = patches.begin[k]; n < patches.begin[k + 1]; ++n) visit(patches.all[n]);
  }

  /// How many times faster the viscous forces of a no-slip wall and of the fluid together damp a particle half a
  /// spacing from it than they damp the shortest waves far from walls.
  double viscous_stiffness() const { return viscous_stiffness_; }

  const WallIntegrals<Dim>& integrals() const { return *integrals_; }
  const Wall<Dim>& wall(std::int32_t number) const { return walls_[static_cast<std::size_t>(number)]; }

  void archive(Archive& a) { a.vector("neighbours/wall_plane", plane_); }
  std::size_t bytes() const;

 private:
  std::shared_ptr<const WallIntegrals<Dim>> integrals_;
  std::vector<Wall<Dim>> walls_;  // without their facets
  std::vector<std::int32_t> plane_;

  struct Patches {  // of a cluster
    std::array<std::uint32_t, cluster_size + 1> begin{};
    std::vector<WallPatch<Dim>> all;
  };
  std::vector<Patches> patches_;
  bool found_ = false;
  double reach_ = 0;  // m, of the support until the next sort
  double viscous_stiffness_ = 0;
};

}  // namespace molten
