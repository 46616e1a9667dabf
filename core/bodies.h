// Walls that move: bodies on a prescribed way, and free rigid bodies that gravity and the particles drive. The
// particles feel a body through contact (core/boundary/contact.h) and, with support, through its integrals
// (core/boundary/wall_terms.h); a free body receives the opposite of each impulse at the place of the contact, or of
// the particle, so linear and angular momentum stay to round-off. Walls that stay in place hold it (body_walls.h).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/archive.h"
#include "core/boundary/contact.h"

namespace molten {

/// Where a prescribed motion puts a body at a time: shifted and turned about its centre from where it was first placed.
template <int Dim> struct PrescribedMotion {
  Point<Dim> velocity = Point<Dim>::Zero();  // m/s
  Spin<Dim> spin = Spin<Dim>::Zero();        // rad/s
  struct KeyFrame {
    double time = 0;   // s
    Point<Dim> shift;  // m
    Spin<Dim> angle;   // rad
  };
  std::vector<KeyFrame> key_frames;  // instead of velocity and spin; linear between, at rest before and after

  Pose<Dim> at(const Point<Dim>& centre, double time) const;
};

/// A free rigid body.
template <int Dim> struct Inertia {
  double mass = 0;                                                   // kg (2-D: kg per m of depth)
  Eigen::Matrix<double, Dim == 2 ? 1 : 3, Dim == 2 ? 1 : 3> moment;  // kg m², about the centre, as first placed
};

template <int Dim> struct RigidBody {
  Point<Dim> centre = Point<Dim>::Zero();  // m, as first placed; what it turns about
  double extent = 0;                       // m, from the centre to its furthest corner
  std::optional<Inertia<Dim>> inertia;     // a free body has one
  PrescribedMotion<Dim> prescribed;        // of one that is not free; of a free one its velocity and spin at the start
};

template <int Dim> class Bodies {
 public:
  Bodies() = default;
  explicit Bodies(std::vector<RigidBody<Dim>> bodies);

  std::size_t count() const { return bodies_.size(); }
  const RigidBody<Dim>& body(std::size_t k) const { return bodies_[k]; }
  const RigidMotion<Dim>& motion(std::size_t k) const { return motion_[k]; }               // pose and velocities now
  const Spin<Dim>& angular_momentum(std::size_t k) const { return angular_momentum_[k]; }  // kg m²/s, free bodies

  /// Tells the contact where the bodies are, at rest; the way since then counts anew.
  void place(Contact<Dim>& contact);
  /// Sets the motions of the step to come: gravity (m/s²) drives free bodies, time (s) and dt (s) the others.
  void begin_step(Contact<Dim>& contact, double time, double dt, const std::array<double, Dim>& gravity);
  /// What the particles receive from the bodies while these rates last, a unit of particle mass and time: one for each
  /// body, one set after the other.
  void receive(std::span<const Kick<Dim>> sets);
  /// Gives free bodies the opposite of that for `time` (s), from particles of this mass (kg).
  void answer(double time, double particle_mass);
  /// Moves the bodies to the end of the step and gives free ones the opposite of what particles of this mass (kg) got.
  void end_step(std::span<const Kick<Dim>> kicks, double particle_mass);

  /// No point of a body has gone further (m) since they were placed; the step that has begun counts.
  double way() const { return way_; }
  /// The fastest point of a body, and of any, m/s.
  double speed(std::size_t k) const;
  double fastest() const;

  void archive(Archive& a);

 private:
  Spin<Dim> spin_of(std::size_t k) const;
  void hold(const Contact<Dim>& contact, std::size_t k, double gravity);

  std::vector<RigidBody<Dim>> bodies_;
  std::vector<RigidMotion<Dim>> motion_;  // at the present time; during a step, of the step
  std::vector<Spin<Dim>> angular_momentum_;
  std::vector<std::vector<Point<Dim>>> corners_;  // m; of free bodies, in their own frames, from the first step on
  std::vector<Kick<Dim>> given_;                  // a second, about the centre
  double time_ = 0, dt_ = 0, way_ = 0;            // s, s, m
};

}  // namespace molten
