// For every cluster, the groups of which a particle is within reach of one of its own. A group is a cluster or, where
// lanes are narrow, a part of one: as many particles as lanes pair with a whole cluster at once.
//
// Neighbouring clusters of a column share one row of entries, with bits for each of them. What they meet of another
// column follows one another there, so a row keeps runs: their first entries and lengths. The bits tell the shell, too:
// the list is good until particles have moved half a skin, but only the groups within the support and what particles
// have moved so far can matter.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/cluster_order.h"
#include "core/simd.h"

namespace molten {

/// A neighbour group in the list: its number in the low bits, above them which shift leads from the listing cluster's
/// origin to its own (images of periodic axes counted on, so a periodic neighbour needs nothing more).
using ListEntry = std::uint32_t;

template <class Real> inline constexpr int group_size = native_lanes<Real> / cluster_size;  // slots
template <class Real> inline constexpr int groups_a_cluster = cluster_size / group_size<Real>;

inline constexpr int clusters_a_row = 4;  // at most
inline constexpr int shells = 3;          // shell s reaches as far as the support and (s + 1)/shells of the skin
inline constexpr int shell_bits = 2;      // that number the smallest shell an entry is in, from 1 on; 0: in none

/// Clusters that are handled together by one thread: the fixed block of all pair work.
struct ClusterChunk {
  /// Clusters that follow one another in a column and share entries.
  struct Row {
    std::uint32_t first_cluster, first_run, first_mask;
    bool operator==(const Row&) const = default;
  };
  static constexpr std::size_t mask_bits = 16;
  static constexpr std::size_t longest_run = 128;
  std::uint32_t begin = 0, end = 0;       // clusters
  std::vector<Row> rows;                  // and the end
  std::vector<ListEntry> run_begins;      // as seen from the first cluster of the row to segment 0 of their column
  std::vector<std::uint8_t> run_lengths;  // groups that follow one another
  std::vector<std::uint16_t> masks;  // of each row's clusters, for each the shell_bits: bit k of the words for entry k

  std::uint32_t clusters_of(std::size_t row) const { return rows[row + 1].first_cluster - rows[row].first_cluster; }
  /// Of masks, for one of the bits of one of a row's clusters.
  std::size_t words_of(std::size_t row) const {
    return (rows[row + 1].first_mask - rows[row].first_mask) / (shell_bits * clusters_of(row));
  }
  /// Which entries a shell holds, of the words of both bits.
  static unsigned within(int shell, unsigned low, unsigned high) {
    return shell == 0 ? low & ~high : shell == 1 ? low ^ high : low | high;
  }
  static constexpr std::size_t words(std::size_t entries) { return (entries + mask_bits - 1) / mask_bits; }
  bool operator==(const ClusterChunk&) const = default;
};

/// Some clusters, each with those of its neighbour groups that matter to it: parts of a chunk's lists.
struct PartialChunk {
  struct Row {
    std::uint32_t cluster, first_entry, end_entry;
  };
  std::vector<Row> rows;
  std::vector<ListEntry> entries;

  void clear() { rows.clear(), entries.clear(); }
  std::size_t bytes() const { return rows.capacity() * sizeof(Row) + entries.capacity() * sizeof(ListEntry); }
};

/// What an entry of a list means. The offsets between neighbouring cells' origins are numbered: across by columns,
/// along by segments.
template <int Dim> struct ShiftTable {
  std::array<int, Dim> reach{};  // cells to each side
  int slots_a_group = cluster_size;
  int group_bits = 32;                         // of a ListEntry; the rest number the shift
  std::vector<std::array<double, Dim>> shift;  // m, on the grid's quantum

  std::uint32_t number(const Cell<Dim>& offset) const {
    std::uint32_t n = 0;
    for (int d = 0; d < Dim; ++d) n = n * (2 * reach[d] + 1) + static_cast<std::uint32_t>(offset[d] + reach[d]);
    return n;
  }
  std::uint32_t group(ListEntry e) const { return e & ((std::uint64_t{1} << group_bits) - 1); }
  std::size_t first_slot(ListEntry e) const { return std::size_t{group(e)} * slots_a_group; }
  std::size_t cluster(ListEntry e) const { return first_slot(e) / cluster_size; }
  const std::array<double, Dim>& of(ListEntry e) const { return shift[std::uint64_t{e} >> group_bits]; }
  /// The entry as seen from a cluster that many segments further along.
  ListEntry seen_from(std::int32_t segments) const { return static_cast<ListEntry>(segments) << group_bits; }
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

  /// The smallest shell that holds all pairs while no particle has moved more than this (m).
  int shell(double displacement) const {
    int s = 0;
    while (s + 1 < shells && 2 * displacement * shells > settings_.skin * (s + 1)) ++s;
    return s;
  }

  /// f(cluster, its neighbour groups in a shell as a span of ListEntry) for the clusters of a chunk, in order.
  template <class F> void for_each(const ClusterChunk& chunk, const ClusterOrder<Dim>& order, int shell, F&& f) const;

 private:
  /// Bounding boxes of the clusters (m): across relative to the column's origin, along from the grid's lower end. Some
  /// boxes out of reach follow the last, for loops that take several at once. While listing, in the particles' scratch;
  /// with blocks, they last from list to list.
  struct Boxes {
    float *lower[Dim], *upper[Dim];
  };
  class Lister;
  /// Writes a row's entries, as seen from its first cluster, and up to mask_bits more.
  void expand(const ClusterChunk& chunk, std::size_t row, ListEntry* to) const {
    for (std::uint32_t r = chunk.rows[row].first_run; r < chunk.rows[row + 1].first_run; ++r) {
      const std::uint32_t first = shifts_.group(chunk.run_begins[r]), length = chunk.run_lengths[r];
      copy_more_by(in_columns_.data() + first, length, chunk.run_begins[r] - first, to);
      to += length;
    }
  }
  double range(const ClusterOrder<Dim>& order, int shell) const;
  void place_boxes(const ClusterOrder<Dim>& order, Particles<Dim, Real>& particles);
  void find_boxes(const ClusterOrder<Dim>& order, Particles<Dim, Real>& particles, std::size_t first_cluster);
  void number_shifts(const ClusterOrder<Dim>& order);
  void list_clusters(std::vector<ClusterChunk>& chunks, const ClusterOrder<Dim>& order, std::size_t begin,
                     std::size_t end, const Particles<Dim, Real>& particles);

  NeighbourSettings settings_;
  Boxes boxes_;
  std::array<std::vector<float>, 2 * Dim> lasting_boxes_;  // with blocks
  std::vector<ListEntry> in_columns_;                      // each group as an entry, seen from segment 0 of its column
  ShiftTable<Dim> shifts_;
  std::vector<ClusterChunk> chunks_, warm_chunks_;
  bool warm_listed_ = false;
};

template <int Dim, class Real>
template <class F>
void ClusterList<Dim, Real>::for_each(const ClusterChunk& chunk, const ClusterOrder<Dim>& order, int shell,
                                      F&& f) const {
  constexpr int along = Grid<Dim>::along;
  std::size_t longest = 0;
  for (std::size_t r = 0; r + 1 < chunk.rows.size(); ++r) longest = std::max(longest, chunk.words_of(r));
  const std::size_t room = (longest + 1) * ClusterChunk::mask_bits;
  std::vector<ListEntry> entries(room), lists(clusters_a_row * room);
  std::array<std::size_t, clusters_a_row> lengths;
  if (chunk.rows.size() > 1) expand(chunk, 0, entries.data());
  for (std::size_t r = 0; r + 1 < chunk.rows.size(); ++r) {
    const ClusterChunk::Row& row = chunk.rows[r];
    const std::uint32_t first = row.first_cluster, count = chunk.clusters_of(r);
    const std::size_t words = chunk.words_of(r);
    // All lists of the row before the first is used: what comes after one list's last pair then waits for nothing.
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::int32_t further = order.cells[first + k][along] - order.cells[first][along];
      const std::uint16_t* const low = chunk.masks.data() + row.first_mask + k * shell_bits * words;
      lengths[k] = select_less_by(entries.data(), words, shifts_.seen_from(further), lists.data() + k * room,
                                  [=](std::size_t w) { return ClusterChunk::within(shell, low[w], low[words + w]); });
    }
    // The next row's, long before they are read in other pieces than they are written in.
    if (r + 2 < chunk.rows.size()) {
      expand(chunk, r + 1, entries.data());
      const std::uint32_t run = chunk.rows[r + 2].first_run, runs = run - chunk.rows[r + 1].first_run;
      prefetch(chunk.run_begins.data() + run, runs);
      prefetch(chunk.run_lengths.data() + run, runs);
    }
    prefetch(chunk.masks.data() + chunk.rows[r + 1].first_mask, clusters_a_row * shell_bits * words);
    for (std::uint32_t k = 0; k < count; ++k)
      f(first + k, std::span<const ListEntry>(lists.data() + k * room, lengths[k]));
  }
}

}  // namespace molten
