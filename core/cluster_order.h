// The order of the particles in slots: clusters of `cluster_size`, column after column of the grid, block after block.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid.h"
#include "core/particles.h"

namespace molten {

inline constexpr double longest_cluster =
    4.0;  // spacings; a sparser one ends early, so that local positions stay small

/// The order of slots where particles sleep (sleep.h): each block is sorted for itself. `asleep` has no lists, `warm`
/// has lists of its own. A run without sleep has one block, all active.
enum class Block : std::uint8_t { asleep, warm, active };
inline constexpr std::size_t block_count = 3;

template <int Dim> struct ClusterOrder {
  Grid<Dim> grid;
  std::vector<Cell<Dim>> cells;  // of the clusters
  /// First cluster of each pile, and the end. Piles are the columns of each block, one block after another.
  std::vector<std::uint32_t> pile_begin;

  std::size_t clusters() const { return cells.size(); }
  std::size_t piles() const { return pile_begin.size() - 1; }
  /// Of a block; without blocks, all are active.
  std::size_t first_cluster(Block block) const {
    const std::size_t from_end = block_count - static_cast<std::size_t>(block), blocks = piles() / grid.columns();
    return blocks < from_end ? 0 : pile_begin[(blocks - from_end) * grid.columns()];
  }
};

/// Memory that a vector holds.
template <class T> std::size_t bytes_of(const std::vector<T>& v) { return v.capacity() * sizeof(T); }

}  // namespace molten
