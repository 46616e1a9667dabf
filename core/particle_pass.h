// The only per-particle loops. Reductions go through fixed blocks, so they give the same bits for any thread count.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/pieces.h"

namespace molten {

inline constexpr std::size_t block_size = 1024;  // slots; fixed, never the thread count's

/// f(slot) for all slots, in parallel.
template <class F> void for_each_slot(std::size_t slots, F&& f) {
#pragma omp parallel for schedule(static)
  for (std::size_t s = 0; s < slots; ++s) f(s);
}

/// Folds f(slot, accumulator&) over blocks of slots in parallel, then joins the blocks' accumulators in order with
/// join(total&, block). For items larger than slots: shorter blocks, so that small runs have enough of them, too.
template <class T, class F, class Join>
T reduce_slots(std::size_t slots, T zero, F&& f, Join&& join, std::size_t block = block_size) {
  const std::size_t blocks = (slots + block - 1) / block;
  std::vector<T> partial(blocks, zero);
  for_each_piece(blocks, [&](std::size_t b) {
    T sum = zero;
    const std::size_t end = std::min(slots, (b + 1) * block);
    for (std::size_t s = b * block; s < end; ++s) f(s, sum);
    partial[b] = sum;
  });
  T total = zero;
  for (const T& p : partial) join(total, p);
  return total;
}

}  // namespace molten
