// Work handed out in pieces: each is done once, whoever does it.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/pieces.h"
#include "tests/with_threads.h"

namespace molten::pieces_test {
namespace {

TEST(PiecesOfWork, AreDoneOnceEach) {
  for (const int threads : {1, 2, 3, 7}) {
    const WithThreads here(threads);
    for (const std::size_t count : {0, 1, 2, 5, 1000}) {
      std::vector<int> done(count, 0);
      for_each_piece(count, [&](std::size_t k) { ++done[k]; });
      for_each_piece_with(count, 1, [&](std::size_t k, int& one) { done[k] += one; });
      EXPECT_EQ(std::count(done.begin(), done.end(), 2), static_cast<std::ptrdiff_t>(count));
    }
  }
}

TEST(PiecesOfWork, AreAllDoneByASmallerTeam) {
  const WithThreads here(4);
  std::vector<int> done(100, 0);
  Pieces pieces(done.size());
  pieces.work([&](std::size_t k) { ++done[k]; });  // by one thread alone
  EXPECT_EQ(std::count(done.begin(), done.end(), 1), 100);
}

TEST(PiecesOfWork, FollowOneAnotherInAThreadsStretch) {
  const WithThreads here(1);
  std::vector<std::size_t> order;
  for_each_piece(50, [&](std::size_t k) { order.push_back(k); });
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
  EXPECT_EQ(order.size(), 50u);
}

}  // namespace
}  // namespace molten::pieces_test
