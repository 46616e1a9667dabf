// Order and neighbours of the particles: sorts them into clusters along the grid's columns, and lists for every cluster
// those groups of which a particle is within the support radius and a skin of one of its own. Good until a particle
// has moved half a skin.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/cluster_list.h"

namespace molten {

template <int Dim> struct Domain {
  std::array<double, Dim> lower{}, upper{};  // m; particles outside are dropped at the next sort
  Periodicity<Dim> periodic;
};

template <int Dim, class Real> class Neighbours {
 public:
  Neighbours(const NeighbourSettings& settings, const Domain<Dim>& domain);

  /// Sorts the particles, drops those outside the domain, and lists the clusters' neighbours.
  void rebuild(Particles<Dim, Real>& particles);

  /// The same, in blocks: block_of has that of each slot. The grid gets a margin for the active ones to move into.
  void rebuild(Particles<Dim, Real>& particles, std::span<const Block> block_of);
  /// The same for the active block alone: those in the other blocks keep their slots. All must be within the grid.
  void rebuild_active(Particles<Dim, Real>& particles);
  bool covers_active(const Particles<Dim, Real>& particles) const;
  /// The first slot of a block; without blocks, all are active.
  std::size_t first_slot(Block block) const { return order_.first_cluster(block) * std::size_t{cluster_size}; }

  /// True when a particle may have moved half a skin since the last build.
  bool is_due() const { return 2 * displacement_ > settings_.skin; }
  /// Adds the largest displacement of one step (m). The sum bounds each particle's way since the build.
  void moved(double displacement) { displacement_ += displacement; }
  double displacement() const { return displacement_; }
  /// Particles have come or gone: the list is of no use any more.
  void expire() { displacement_ += settings_.skin + settings_.spacing; }

  const Grid<Dim>& grid() const { return order_.grid; }
  const NeighbourSettings& settings() const { return settings_; }
  /// The lists of active clusters.
  std::span<const ClusterChunk> chunks() const { return list_.chunks(); }
  /// Those of warm clusters; made when first asked for after a sort.
  std::span<const ClusterChunk> warm_chunks(const Particles<Dim, Real>& particles) {
    return list_.warm_chunks(order_, particles);
  }
  /// f(cluster, its list as a span of ListEntry) for the clusters of a chunk, in order. The list holds all pairs while
  /// displacement() is right.
  template <class F> void for_each_list(const ClusterChunk& chunk, F&& f) const {
    list_.for_each(chunk, order_, list_.shell(displacement_), std::forward<F>(f));
  }
  template <class F> void for_each_list(const PartialChunk& chunk, F&& f) const {
    for (const PartialChunk::Row& row : chunk.rows)
      f(row.cluster, std::span(chunk.entries).subspan(row.first_entry, row.end_entry - row.first_entry));
  }
  const ShiftTable<Dim>& shifts() const { return list_.shifts(); }
  const Cell<Dim>& cell(std::size_t cluster) const { return order_.cells[cluster]; }
  std::size_t clusters() const { return order_.clusters(); }
  std::size_t dropped() const { return dropped_; }  // particles that have left the domain so far
  std::size_t bytes() const;

  /// Sets the local positions of a cluster's particles from their positions; padding goes far away.
  void localise(Particles<Dim, Real>& particles, std::size_t cluster) const;

  void archive(Archive& a);
  /// After loading: lists the neighbours again for the restored order. The list may differ from the stored run's in
  /// pairs outside the support only, so sums keep their bits.
  void relist(Particles<Dim, Real>& particles);

 private:
  void choose_grid(const Particles<Dim, Real>& particles, const Cell<Dim>& margin);
  void choose_quantum();
  void sort(Particles<Dim, Real>& particles, std::size_t first_pile, std::span<const Block> block_of);
  std::uint32_t pile_of(const Particles<Dim, Real>& particles, std::size_t slot, std::size_t block) const;
  std::size_t sort_columns(Particles<Dim, Real>& particles, std::size_t first_pile, std::span<const Block> block_of);
  std::unique_ptr<std::int32_t[]> cluster_order(std::size_t first_pile);
  NeighbourSettings settings_;
  Domain<Dim> domain_;
  ClusterOrder<Dim> order_;
  ClusterList<Dim, Real> list_;
  double displacement_ = 0;
  std::size_t dropped_ = 0;

  struct Entry {
    float along;        // position along the column, m from the grid's lower end
    std::int32_t slot;  // old slot
  };
  std::span<Entry> entries_;                // while sorting, in the particles' scratch
  std::vector<std::uint32_t> entry_begin_;  // by pile
};

/// All pairs within the support by brute force: the twin that tests hold the list against. Slots, both directions,
/// self excluded.
template <int Dim, class Real>
std::vector<std::pair<std::uint32_t, std::uint32_t>> naive_pairs(const Particles<Dim, Real>& particles,
                                                                 const Periodicity<Dim>& periodic,
                                                                 double support_radius);

}  // namespace molten
