// The motion of a rigid body during one step: constant velocity and spin. A body's own frame has its origin at the
// body's centre and the world's axes at its first placing.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "core/boundary/point.h"

namespace molten {

/// ω × r
inline Point<2> cross(const Spin<2>& spin, const Point<2>& r) { return {-spin[0] * r[1], spin[0] * r[0]}; }
inline Point<3> cross(const Spin<3>& spin, const Point<3>& r) { return spin.cross(r); }

/// r × f
inline Spin<2> moment_of(const Point<2>& r, const Point<2>& f) { return Spin<2>(r[0] * f[1] - r[1] * f[0]); }
inline Spin<3> moment_of(const Point<3>& r, const Point<3>& f) { return r.cross(f); }

/// The rotation about the direction of `angle` by its length (rad).
inline Turn<2> turn_by(const Spin<2>& angle) { return Eigen::Rotation2Dd(angle[0]).toRotationMatrix(); }
inline Turn<3> turn_by(const Spin<3>& angle) {
  const double size = angle.norm();
  if (!(size > 0)) return Turn<3>::Identity();
  return Eigen::AngleAxisd(size, angle / size).toRotationMatrix();
}

/// The rotation vector of `turn`; at most half a turn.
inline Spin<2> angle_of(const Turn<2>& turn) { return Spin<2>(std::atan2(turn(1, 0), turn(0, 0))); }
inline Spin<3> angle_of(const Turn<3>& turn) {
  const Eigen::AngleAxisd a(turn);
  return a.angle() * a.axis();
}

template <int Dim> struct Pose {
  Point<Dim> centre = Point<Dim>::Zero();  // m
  Turn<Dim> turn = Turn<Dim>::Identity();

  Point<Dim> to_world(const Point<Dim>& x) const { return centre + turn * x; }
  Point<Dim> to_body(const Point<Dim>& x) const { return turn.transpose() * (x - centre); }
};

template <int Dim> struct RigidMotion {
  Pose<Dim> start;
  Point<Dim> velocity = Point<Dim>::Zero();  // m/s, of the centre
  Spin<Dim> spin = Spin<Dim>::Zero();        // rad/s

  Pose<Dim> after(double time) const {
    if (time == 0) return start;
    return {start.centre + time * velocity, turn_by(Spin<Dim>(time * spin)) * start.turn};
  }
  /// Of the body's material at x, when its centre is at `centre` (m/s).
  Point<Dim> velocity_at(const Point<Dim>& x, const Point<Dim>& centre) const {
    return velocity + cross(spin, Point<Dim>(x - centre));
  }
};

}  // namespace molten
