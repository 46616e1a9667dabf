// Facets in an Embree bounding volume hierarchy, for long paths, sparse walls and huge meshes. Embree works in single
// precision, so the boxes are grown by its round-off: it proposes candidates, the exact test in double precision
// decides (sweep.h).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

#include "core/boundary/sweep.h"

namespace molten {

template <int Dim> class FacetTree {
 public:
  /// `margin` (m): as of FacetGrid. The facets must outlive the tree and stay where they are.
  FacetTree(std::span<const Facet<Dim>> facets, double margin);
  ~FacetTree();

  /// Calls visit(facet) for every facet that comes within the margin of the path x → x + d, and some more, in any
  /// order; visit returns the fraction of the path beyond which no facet matters any more. Thread-safe.
  template <class Visit> void sweep(const Point<Dim>& x, const Point<Dim>& d, Visit&& visit) const {
    sweep(
        x, d, [](void* v, std::int32_t f) { return (*static_cast<std::remove_reference_t<Visit>*>(v))(f); }, &visit);
  }

  /// Calls visit(facet) for every facet within the margin and `reach` (m) of x, and some more, in any order, until it
  /// returns false.
  template <class Visit> void near(const Point<Dim>& x, double reach, Visit&& visit) const {
    near(
        x, reach, [](void* v, std::int32_t f) { return (*static_cast<std::remove_reference_t<Visit>*>(v))(f); },
        &visit);
  }

 private:
  using OnPath = double (*)(void*, std::int32_t);
  using OnNear = bool (*)(void*, std::int32_t);
  void sweep(const Point<Dim>& x, const Point<Dim>& d, OnPath visit, void* context) const;
  void near(const Point<Dim>& x, double reach, OnNear visit, void* context) const;

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace molten
