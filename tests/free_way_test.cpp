// How far particles may go before they meet a wall: kept coarsely, but never as more than it is.
#include "core/free_way.h"

#include <gtest/gtest.h>

namespace molten::free_way_test {
namespace {

TEST(FreeWay, NeverHidesAWallThatMayBeMet) {
  for (double way = 0; way <= FreeWay::longest; way += 0.001) {
    FreeWay ways;
    ways.reset(8);
    ways.set(5, way);
    EXPECT_TRUE(ways.within(FreeWay::part_of(way), 5)) << way;
    EXPECT_TRUE(ways.any_within(FreeWay::part_of(way), 1)) << way;
    EXPECT_FALSE(way >= 0.1 && ways.within(FreeWay::part_of(way - 0.04), 5)) << way;
  }
}

TEST(FreeWay, KeepsThoseOfNeighboursApart) {
  FreeWay ways;
  ways.reset(8);
  const std::uint8_t all = FreeWay::part_of(FreeWay::longest), none = FreeWay::part_of(0);
  for (std::size_t slot = 0; slot < 8; ++slot) EXPECT_FALSE(ways.within(all, slot)) << "beyond the longest";
  ways.set(2, 0);
  ways.set(3, 0.3);
  EXPECT_TRUE(ways.within(none, 2));
  EXPECT_FALSE(ways.within(none, 3));
  EXPECT_TRUE(ways.within(FreeWay::part_of(0.3), 3));
  EXPECT_TRUE(ways.any_within(none, 0));
  EXPECT_FALSE(ways.any_within(all, 1));
  ways.set(2, 7);
  EXPECT_FALSE(ways.within(all, 2));
  EXPECT_TRUE(ways.within(FreeWay::part_of(0.3), 3)) << "in the same byte";
}

}  // namespace
}  // namespace molten::free_way_test
