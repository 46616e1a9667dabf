// Work in pieces of unequal size, in parallel. What comes out must not depend on who does which piece.
#pragma once

#include <omp.h>

#include <atomic>
#include <cstddef>
#include <vector>

namespace molten {

/// Hands out pieces: to each thread those of a stretch of its own, one after the other, so that it meets again what its
/// caches hold; then what is left of the others' stretches.
class Pieces {
 public:
  explicit Pieces(std::size_t count) : stretches_(static_cast<std::size_t>(omp_get_max_threads())) {
    for (std::size_t t = 0; t < stretches_.size(); ++t) {
      stretches_[t].next = count * t / stretches_.size();
      stretches_[t].end = count * (t + 1) / stretches_.size();
    }
  }

  /// f(piece) for this thread's share of all; to be called by every thread of a team, of any size.
  template <class F> void work(F&& f) {
    const auto own = static_cast<std::size_t>(omp_get_thread_num());
    for (std::size_t k = 0; k < stretches_.size(); ++k) {
      Stretch& stretch = stretches_[(own + k) % stretches_.size()];
      for (std::size_t p; (p = stretch.next.fetch_add(1, std::memory_order_relaxed)) < stretch.end;) f(p);
    }
  }

 private:
  struct alignas(64) Stretch {
    std::atomic<std::size_t> next;
    std::size_t end;
  };
  std::vector<Stretch> stretches_;
};

/// f(k) for k in [0, count), in parallel.
template <class F> void for_each_piece(std::size_t count, F&& f) {
  Pieces pieces(count);
#pragma omp parallel
  pieces.work(f);
}

/// The same with scratch of its own for each thread: f(k, scratch&). What f gives must not depend on what was there.
template <class Scratch, class F> void for_each_piece_with(std::size_t count, const Scratch& scratch, F&& f) {
  Pieces pieces(count);
#pragma omp parallel
  {
    Scratch own = scratch;
    pieces.work([&](std::size_t k) { f(k, own); });
  }
}

}  // namespace molten
