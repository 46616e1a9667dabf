// What a piece of a wall cuts off a particle's support, and how facets add up to it.
#pragma once

#include <cmath>

#include "core/boundary/point.h"

namespace molten {

/// A plane piece within a particle's support.
template <int Dim> struct WallPiece {
  Point<Dim> normal = Point<Dim>::Zero();  // unit, into the fluid
  double weight = 0;                       // |∫ W n dS|, 1/m
  double hidden = 0;                       // the part of ∫ W dV behind the piece
  double distance = 0;                     // of the particle from it, m
  std::int32_t wall = 0;
};

/// A piece of which the facets' normals may differ a little: then the normal is their mean, weighted with W.
template <int Dim> struct WallPatch : WallPiece<Dim> {
  Point<Dim> centroid;  // of W over the piece, from the particle, m
  Turn<Dim> moment;     // ∫ n ⊗ W y dS, y from the particle
  Turn<Dim> across;     // Σ h n ⊗ n over the facets, h: hidden behind one

  /// From a body's frame to one that is turned.
  void turn(const Turn<Dim>& by) {
    this->normal = by * this->normal;
    centroid = by * centroid;
    moment = by * moment * by.transpose();
    across = by * across * by.transpose();
  }
};

/// A patch while its facets are added: those of one wall that a particle sees from the same side and that lie within
/// 45° of the first.
template <int Dim> class PatchSum {
 public:
  PatchSum() = default;
  PatchSum(const Point<Dim>& normal, bool front, std::int32_t wall) : first_(normal), front_(front), wall_(wall) {}

  bool takes(const Point<Dim>& normal, bool front, std::int32_t wall) const {
    return front == front_ && wall == wall_ && normal.dot(first_) > 0.7;
  }

  /// A facet's ∫ W dS, ∫ W y dS and hidden part.
  [[gnu::always_inline]] void add(const Point<Dim>& normal, double weight, const Point<Dim>& moment, double hidden) {
    weight_ += weight;
    hidden_ += hidden;
    centre_ += moment;
    flux_ += weight * normal;
    moment_ += normal * moment.transpose();
    across_ += hidden * normal * normal.transpose();
  }

  double weight() const { return weight_; }  // ∫ W dS, 1/m
  WallPatch<Dim> patch() const {
    WallPatch<Dim> p;
    p.weight = flux_.norm();
    p.normal = p.weight > 0 ? Point<Dim>(flux_ / p.weight) : first_;
    p.centroid = centre_ / weight_;
    p.distance = -p.normal.dot(p.centroid);
    p.hidden = hidden_;
    p.wall = wall_;
    p.moment = moment_;
    p.across = across_;
    return p;
  }

 private:
  Point<Dim> first_ = Point<Dim>::Zero();
  bool front_ = true;
  std::int32_t wall_ = -1;
  double weight_ = 0, hidden_ = 0;
  Point<Dim> flux_ = Point<Dim>::Zero(), centre_ = Point<Dim>::Zero();
  Turn<Dim> moment_ = Turn<Dim>::Zero(), across_ = Turn<Dim>::Zero();
};

/// The patches of one particle while they are added.
template <int Dim> class PatchSums {
 public:
  PatchSum<Dim>& of(const Point<Dim>& normal, bool front, std::int32_t wall) {
    for (int k = 0; k < count_; ++k)
      if (sums_[k].takes(normal, front, wall)) return sums_[k];
    if (count_ == most) return sums_[most - 1];
    return sums_[count_++] = {normal, front, wall};
  }
  const PatchSum<Dim>* begin() const { return sums_; }
  const PatchSum<Dim>* end() const { return sums_ + count_; }

 private:
  static constexpr int most = 16;
  PatchSum<Dim> sums_[most];
  int count_ = 0;
};

}  // namespace molten
