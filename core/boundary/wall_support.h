// What walls add to the sums of the particles near them, straight from the mesh, without boundary particles
// (wall_terms.h has the formulas): the walls' integrals, and which of them each cluster may reach before the next sort.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/archive.h"
#include "core/bodies.h"
#include "core/boundary/contact.h"
#include "core/boundary/wall_integrals.h"
#include "core/parameters.h"
#include "core/particles.h"

namespace molten {

template <int Dim> class WallSupport {
 public:
  WallSupport() = default;
  WallSupport(const Contact<Dim>& contact, const Bodies<Dim>& bodies, const Parameters<Dim>& parameters);

  /// Finds the planes near the particles from `first_slot` on; the others are not asked for. Good until the particles
  /// have moved by half a skin, or the bodies have. `contact`: with the same walls, the bodies where they are.
  template <class Real>
  void mark(const Particles<Dim, Real>& particles, std::size_t first_slot, const Bodies<Dim>& bodies,
            const Contact<Dim>& contact);

  /// Takes the walls of bodies to where those are.
  void place(const Bodies<Dim>& bodies);

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
    if (!found_) return visit_all(x, visit);
    const Patches& patches = patches_[slot / cluster_size];
    const std::size_t k = slot % cluster_size;
    for (std::uint32_t n = patches.begin[k]; n < patches.begin[k + 1]; ++n) visit(patches.all[n]);
  }

  /// How many times faster the viscous forces of a no-slip wall and of the fluid together damp a particle half a
  /// spacing from it than they damp the shortest waves far from walls.
  double viscous_stiffness() const { return viscous_stiffness_; }

  const WallIntegrals<Dim>& integrals() const { return *integrals_; }
  const Wall<Dim>& wall(std::int32_t number) const { return walls_[static_cast<std::size_t>(number)]; }

  std::size_t bodies() const { return bodies_.size(); }
  /// How a body moves now: place and velocities.
  const RigidMotion<Dim>& motion(std::int32_t body) const { return bodies_[static_cast<std::size_t>(body)].motion; }

  void archive(Archive& a) { a.vector("neighbours/wall_plane", plane_); }
  std::size_t bytes() const;

 private:
  /// The walls of a body, in its frame.
  struct Moving {
    std::shared_ptr<const WallIntegrals<Dim>> integrals;
    double extent;            // m, from the body's centre
    std::int32_t first_wall;  // in walls_
    RigidMotion<Dim> motion;

    bool is_near(const Point<Dim>& x, double reach) const { return (x - motion.start.centre).norm() < extent + reach; }
  };
  template <class Visit> void visit_all(const Point<Dim>& x, Visit&& visit) const;
  std::int32_t plane_near(const Point<Dim>& x, double reach) const;

  std::shared_ptr<const WallIntegrals<Dim>> integrals_;  // of the walls that stay in place
  std::vector<Moving> bodies_;
  std::vector<Wall<Dim>> walls_;  // without their facets: those in place, then body by body
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

template <int Dim> template <class Visit> void WallSupport<Dim>::visit_all(const Point<Dim>& x, Visit&& visit) const {
  integrals_->visit(x, visit);
  for (const Moving& body : bodies_) {
    if (!body.is_near(x, integrals_->reach())) continue;
    const Pose<Dim>& pose = body.motion.start;
    body.integrals->visit(pose.to_body(x), [&](WallPatch<Dim> patch) {
      patch.turn(pose.turn);
      patch.wall += body.first_wall;
      visit(patch);
    });
  }
}

}  // namespace molten
