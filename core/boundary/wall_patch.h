// What a piece of a wall cuts off a particle's support, and how facets add up to it.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/boundary/point.h"

namespace molten {

/// A piece of a wall within a particle's support. Its facets' normals may differ a little: then the normal is their
/// mean, weighted with W.
template <int Dim> struct WallPatch {
  Point<Dim> normal = Point<Dim>::Zero();  // unit, into the fluid
  double weight = 0;                       // |∫ W n dS|, 1/m
  double hidden = 0;                       // the part of ∫ W dV behind the piece
  double distance = 0;                     // of the particle from it, m
  std::int32_t wall = 0;
  Point<Dim> centroid;  // of W over the piece, from the particle, m
  Turn<Dim> moment;     // ∫ n ⊗ W y dS, y from the particle
  Turn<Dim> across;     // Σ h n ⊗ n over the facets, h: hidden behind one

  /// From a body's frame to one that is turned.
  void turn(const Turn<Dim>& by) {
    normal = by * normal;
    centroid = by * centroid;
    moment = by * moment * by.transpose();
    across = by * across * by.transpose();
  }
};

/// A patch while its facets are added: those of one wall that a particle sees from the same side and that lie within
/// 45° of the first.
template <int Dim> class PatchSum {
 public:
  PatchSum() {}  // nothing, not even zeros
  /// Of the first facet, by its ∫ W dS, ∫ W y dS and hidden part.
  [[gnu::always_inline]] PatchSum(const Point<Dim>& normal, bool front, std::int32_t wall, double weight,
                                  const Point<Dim>& moment, double hidden)
      : first_(normal),
        front_(front),
        wall_(wall),
        weight_(weight),
        hidden_(hidden),
        flux_(weight * normal),
        centre_(moment),
        moment_(normal * moment.transpose()),
        across_(hidden * normal * normal.transpose()) {}

  bool takes(const Point<Dim>& normal, bool front, std::int32_t wall) const {
    return front == front_ && wall == wall_ && normal.dot(first_) > 0.7;
  }

  [[gnu::always_inline]] void join(const PatchSum& other) {
    weight_ += other.weight_;
    hidden_ += other.hidden_;
    flux_ += other.flux_;
    centre_ += other.centre_;
    moment_ += other.moment_;
    across_ += other.across_;
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
  Point<Dim> first_;
  bool front_;
  std::int32_t wall_;
  double weight_, hidden_;
  Point<Dim> flux_, centre_;
  Turn<Dim> moment_, across_;
};

/// The patches of one particle while they are added. Nothing is cleared, and what a facet begins is written in place:
/// either would take longer than adding one.
template <int Dim> class PatchSums {
 public:
  /// A facet as PatchSum takes it.
  void add(const Point<Dim>& normal, bool front, std::int32_t wall, double weight, const Point<Dim>& moment,
           double hidden) {
    int k = 0;
    while (k < count_ && !sums_[k].takes(normal, front, wall)) ++k;
    if (k == count_ && count_ < most)
      std::construct_at(&sums_[count_++], normal, front, wall, weight, moment, hidden);
    else
      sums_[std::min(k, most - 1)].join({normal, front, wall, weight, moment, hidden});
  }
  const PatchSum<Dim>* begin() const { return sums_; }
  const PatchSum<Dim>* end() const { return sums_ + count_; }

 private:
  static constexpr int most = 16;
  PatchSum<Dim> sums_[most];
  int count_ = 0;
};

}  // namespace molten
