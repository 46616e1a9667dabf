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

/// The order of slots where particles sleep (sleep.h): each block is sorted for itself. `asleep` has no lists, `warm`
/// has lists of its own. A run without sleep has one block, all active.
enum class Block : std::uint8_t { asleep, warm, active };
inline constexpr std::size_t block_count = 3;

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
  std::size_t first_slot(Block block) const;

  /// True when a particle may have moved half a skin since the last build.
  bool is_due() const { return 2 * displacement_ > settings_.skin; }
  /// Adds the largest displacement of one step (m). The sum bounds each particle's way since the build.
  void moved(double displacement) { displacement_ += displacement; }
  double displacement() const { return displacement_; }
  /// Particles have come or gone: the list is of no use any more.
  void expire() { displacement_ += settings_.skin + settings_.spacing; }

  const Grid<Dim>& grid() const { return grid_; }
  const NeighbourSettings& settings() const { return settings_; }
  /// The lists of active clusters.
  std::span<const ClusterChunk> chunks() const { return chunks_; }
  /// Those of warm clusters; made when first asked for after a sort.
  std::span<const ClusterChunk> warm_chunks(const Particles<Dim, Real>& particles);
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
  /// boxes out of reach follow the last, for loops that take several at once. While listing, in the particles' scratch;
  /// with blocks, they last from list to list.
  struct Boxes {
    float *lower[Dim], *upper[Dim];
  };
  class Lister;
  void choose_grid(const Particles<Dim, Real>& particles, const Cell<Dim>& margin);
  void choose_quantum();
  /// Piles are the columns of each block, one block after another.
  std::size_t piles() const { return column_begin_.size() - 1; }
  void sort(Particles<Dim, Real>& particles, std::size_t first_pile, std::span<const Block> block_of);
  std::size_t sort_columns(Particles<Dim, Real>& particles, std::size_t first_pile, std::span<const Block> block_of);
  std::vector<std::int32_t> cluster_order(std::size_t first_pile);
  void place_boxes(Particles<Dim, Real>& particles);
  void find_boxes(Particles<Dim, Real>& particles, std::size_t first_cluster);
  void list_neighbours(const Particles<Dim, Real>& particles);
  void list_clusters(std::vector<ClusterChunk>& chunks, std::size_t begin, std::size_t end,
                     const Particles<Dim, Real>& particles);
  void number_shifts();
  double list_range() const;
  NeighbourSettings settings_;
  Domain<Dim> domain_;
  Grid<Dim> grid_;
  double displacement_ = 0;
  std::size_t dropped_ = 0;
  std::vector<Cell<Dim>> cells_;             // of the clusters
  std::vector<std::uint32_t> column_begin_;  // first cluster of each pile, and the end
  Boxes boxes_;
  std::array<std::vector<float>, 2 * Dim> lasting_boxes_;  // with blocks
  ShiftTable<Dim> shifts_;
  std::vector<ClusterChunk> chunks_, warm_chunks_;
  bool warm_listed_ = false;

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
