// Order and neighbours of the particles: sorts them into clusters along the grid's columns, and lists for every cluster
// those clusters of which a particle is within the support radius and a skin of one of its own. Good until a particle
// has moved half a skin.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.h"
#include "core/particles.h"

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

template <int Dim> struct Domain {
  std::array<double, Dim> lower{}, upper{};  // m; particles outside are dropped at the next sort
  Periodicity<Dim> periodic;
};

template <int Dim, class Real> class Neighbours {
 public:
  Neighbours(const NeighbourSettings& settings, const Domain<Dim>& domain);

  /// Sorts the particles, drops those outside the domain, and lists the clusters' neighbours.
  void rebuild(Particles<Dim, Real>& particles);

  /// True when a particle may have moved half a skin since the last build.
  bool is_due() const { return 2 * displacement_ > settings_.skin; }
  /// Adds the largest displacement of one step (m). The sum bounds each particle's way since the build.
  void moved(double displacement) { displacement_ += displacement; }
  double displacement() const { return displacement_; }
  /// Particles have come or gone: the list is of no use any more.
  void expire() { displacement_ += settings_.skin + settings_.spacing; }

  const Grid<Dim>& grid() const { return grid_; }
  const NeighbourSettings& settings() const { return settings_; }
  std::span<const ClusterChunk> chunks() const { return chunks_; }
  const ShiftTable<Dim>& shifts() const { return shifts_; }
  const Cell<Dim>& cell(std::size_t cluster) const { return cells_[cluster]; }
  std::size_t clusters() const { return cells_.size(); }
  std::size_t dropped() const { return dropped_; }  // particles that have left the domain so far
  std::size_t bytes() const;

  /// Sets a slot's local position from its position; padding goes far away.
  void localise(Particles<Dim, Real>& particles, std::size_t slot) const;

  void archive(Archive& a);
  /// After loading: lists the neighbours again for the restored order. The list may differ from the stored run's in
  /// pairs outside the support only, so sums keep their bits.
  void relist(Particles<Dim, Real>& particles);

 private:
  /// Bounding boxes of the clusters (m): across relative to the column's origin, along from the grid's lower end. Some
  /// boxes out of reach follow the last, for loops that take several at once. While listing, in the particles' scratch.
  struct Boxes {
    float *lower[Dim], *upper[Dim];
  };
  class Lister;
  void choose_grid(const Particles<Dim, Real>& particles);
  void choose_quantum();
  void sort(Particles<Dim, Real>& particles);
  void sort_columns(Particles<Dim, Real>& particles);
  std::vector<std::int32_t> cluster_order(std::size_t& count);
  void find_boxes(Particles<Dim, Real>& particles);
  void list_neighbours(const Particles<Dim, Real>& particles);
  void number_shifts();
  double list_range() const;
  NeighbourSettings settings_;
  Domain<Dim> domain_;
  Grid<Dim> grid_;
  double displacement_ = 0;
  std::size_t dropped_ = 0;
  std::vector<Cell<Dim>> cells_;             // of the clusters
  std::vector<std::uint32_t> column_begin_;  // first cluster of each column, and the end
  Boxes boxes_;
  ShiftTable<Dim> shifts_;
  std::vector<ClusterChunk> chunks_;

  struct Entry {
    float along;        // position along the column, m from the grid's lower end
    std::int32_t slot;  // old slot
  };
  std::span<Entry> entries_;                // while sorting, in the particles' scratch
  std::vector<std::uint32_t> entry_begin_;  // by column
};

/// All pairs within the support by brute force: the twin that tests hold the list against. Slots, both directions,
/// self excluded.
template <int Dim, class Real>
std::vector<std::pair<std::uint32_t, std::uint32_t>> naive_pairs(const Particles<Dim, Real>& particles,
                                                                 const Periodicity<Dim>& periodic,
                                                                 double support_radius);

}  // namespace molten
