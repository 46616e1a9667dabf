// Closed regions made ready to count and place particles on any lattice; fill.cpp searches the lattice.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "core/fill.h"
#include "core/inside.h"

namespace molten {

struct Lattice {
  Vec3 first = Vec3::Zero();  // m; a cell centre
  double spacing = 0;         // m
};

/// Particles sit in columns: lines of cell centres along the last axis (z, in 2-D y).
class Filler {
 public:
  /// Throws Error(geometry) for a region that encloses nothing.
  Filler(const std::vector<Region>& regions, int dimensions);

  long long count(const Lattice& lattice) const;

  /// Throws Error(usage) for a region that gets no particle, Error(geometry) for regions that overlap.
  Filling place(const Lattice& lattice) const;

  /// Throws Error(usage) when the number of particles or columns would be absurd.
  void require_feasible(double spacing) const;

  const Eigen::AlignedBox3d& bounds() const { return bounds_; }  // m
  double measure() const { return measure_; }                    // m³ or m²
  int dimensions() const { return dimensions_; }

 private:
  struct Part {
    std::unique_ptr<Inside> inside;
    Eigen::AlignedBox3d bounds;  // m
  };
  struct Range {
    long long first = 0, end = 0;  // cells along the last axis
  };
  template <class Visit> void columns(const Part& part, const Lattice& lattice, Visit visit) const;
  void refuse_overlap(std::size_t part, const Lattice& lattice, double x, double y, Range range) const;
  static Range cells(double low, double high, double first, double spacing);

  std::vector<Part> parts_;
  Eigen::AlignedBox3d bounds_;
  double measure_ = 0;
  int dimensions_;
};

}  // namespace molten
