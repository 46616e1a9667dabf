// For every cluster, those of which a particle is within the support radius and a skin of one of its own.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/cluster_order.h"

namespace molten {

/// A neighbour cluster in the list: its number in the low bits, above them which shift leads from the listing cluster's
/// origin to its own (images of periodic axes counted on, so a periodic neighbour needs nothing more).
using ListEntry = std::uint32_t;

/// Clusters that are handled together by one thread: the fixed block of all pair work.
struct ClusterChunk {
  std::uint32_t begin = 0, end = 0;        // clusters
  std::vector<ListEntry> entries;          // of all its clusters, in order
  std::vector<std::uint32_t> entry_begin;  // end − begin + 1 positions in entries

  std::span<const ListEntry> of(std::uint32_t cluster) const {
    const std::uint32_t k = cluster - begin;
    return {entries.data() + entry_begin[k], entries.data() + entry_begin[k + 1]};
  }
};

/// The offsets between neighbouring cells' origins, numbered: across by columns, along by segments.
template <int Dim> struct ShiftTable {
  std::array<int, Dim> reach{};                // cells to each side
  int cluster_bits = 32;                       // of a ListEntry; the rest number the shift
  std::vector<std::array<double, Dim>> shift;  // m, on the grid's quantum

  std::uint32_t number(const Cell<Dim>& offset) const {
    std::uint32_t n = 0;
    for (int d = 0; d < Dim; ++d) n = n * (2 * reach[d] + 1) + static_cast<std::uint32_t>(offset[d] + reach[d]);
    return n;
  }
  std::uint32_t cluster(ListEntry e) const { return e & ((std::uint64_t{1} << cluster_bits) - 1); }
  const std::array<double, Dim>& of(ListEntry e) const { return shift[std::uint64_t{e} >> cluster_bits]; }
};

struct NeighbourSettings {
  double spacing = 0;         // m
  double support_radius = 0;  // m
  double skin = 0;            // m
};

template <int Dim, class Real> class ClusterList {
 public:
  explicit ClusterList(const NeighbourSettings& settings) : settings_(settings) {}

  /// Lists the active clusters. Those before first_cluster are where they were.
  void make(const ClusterOrder<Dim>& order, Particles<Dim, Real>& particles, std::size_t first_cluster);

  std::span<const ClusterChunk> chunks() const { return chunks_; }
  /// The lists of warm clusters; made when first asked for after a sort.
  std::span<const ClusterChunk> warm_chunks(const ClusterOrder<Dim>& order, const Particles<Dim, Real>& particles);
  const ShiftTable<Dim>& shifts() const { return shifts_; }
  std::size_t bytes() const;

 private:
  /// Bounding boxes of the clusters (m): across relative to the column's origin, along from the grid's lower end. Some
  /// boxes out of reach follow the last, for loops that take several at once. While listing, in the particles' scratch;
  /// with blocks, they last from list to list.
  struct Boxes {
    float *lower[Dim], *upper[Dim];
  };
  class Lister;
  double range(const ClusterOrder<Dim>& order) const;
  void place_boxes(const ClusterOrder<Dim>& order, Particles<Dim, Real>& particles);
  void find_boxes(const ClusterOrder<Dim>& order, Particles<Dim, Real>& particles, std::size_t first_cluster);
  void number_shifts(const ClusterOrder<Dim>& order);
  void list_clusters(std::vector<ClusterChunk>& chunks, const ClusterOrder<Dim>& order, std::size_t begin,
                     std::size_t end, const Particles<Dim, Real>& particles);

  NeighbourSettings settings_;
  Boxes boxes_;
  std::array<std::vector<float>, 2 * Dim> lasting_boxes_;  // with blocks
  ShiftTable<Dim> shifts_;
  std::vector<ClusterChunk> chunks_, warm_chunks_;
  bool warm_listed_ = false;
};

}  // namespace molten
