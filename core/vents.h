// Where fluid enters: layers of particles that a vent pushes at the asked speed, like a piston, from several spacings
// behind its plane until they have come out. The fluid behind the plane supports what has left, so neither density nor
// pressure jump, and what flows is what was asked, to the layer.
#pragma once

#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "core/boundary/point.h"
#include "core/scene.h"

namespace molten {

template <int Dim> struct VentPatch {
  Point<Dim> centre = Point<Dim>::Zero(), normal = Point<Dim>::Zero();  // m, unit
  std::vector<Point<Dim>> offsets;  // m; from the centre to the particles of a layer, in the vent's plane
  std::vector<Vent::Entry> table;   // rates in m³/s (2-D: m²/s)

  /// ∫ rate dt over from..to, m³ (2-D: m²).
  double volume(double from, double to) const;
  double temperature(double time) const;
};

template <int Dim> class Vents {
 public:
  Vents() = default;
  /// `spacing` (m): of the layers, and the cell of a particle within one; `support` (m): of the kernel.
  Vents(std::vector<VentPatch<Dim>> patches, double spacing, double support);

  std::size_t count() const { return patches_.size(); }
  const VentPatch<Dim>& patch(std::size_t k) const { return patches_[k]; }
  int layers() const { return layers_; }  // that wait behind a vent's plane

  /// How far a vent pushes its particles (m) within the step of dt from `time` on (s).
  Point<Dim> way(std::size_t k, double time, double dt) const {
    return length(k, time, time + dt) * patches_[k].normal;
  }
  /// Has a particle come out, so far that a wall in the vent's plane would just touch it?
  bool has_left(std::size_t k, const Point<Dim>& x) const {
    return (x - patches_[k].centre).dot(patches_[k].normal) >= spacing_ / 2;
  }
  /// Counts the way of a step.
  void advance(double time, double dt);
  /// Takes the next layer that there is room for; `from` is where its middle goes (m). False when there is none.
  bool next_layer(std::size_t k, Point<Dim>& from);
  /// Where the middle of the first, second … layer behind the plane is at the start (m).
  Point<Dim> waiting(std::size_t k, int layer) const;

  /// The fastest that a vent will ever push, m/s.
  double fastest() const;

  std::int64_t take_ids(std::size_t count);
  void start_ids(std::int64_t first) { next_id_ = first; }

  void archive(Archive& a);

 private:
  double length(std::size_t k, double from, double to) const;

  std::vector<VentPatch<Dim>> patches_;
  double spacing_ = 0;  // m
  int layers_ = 0;
  std::vector<double> room_;  // m; that the last layer has left behind it
  std::int64_t next_id_ = 0;
};

/// Points of a square lattice, m apart as given, that lie within a disc (2-D: a slit) about the origin: offsets of a
/// patch with this unit normal. At least one.
template <int Dim> std::vector<Point<Dim>> disc_offsets(const Point<Dim>& normal, double radius, double spacing);

/// Two unit vectors across a normal.
std::array<Point<3>, 2> axes_across(const Point<3>& normal);

}  // namespace molten
