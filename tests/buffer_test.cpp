// Memory of columns: what was kept stays, the rest is zero, nobody's bytes are another's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/buffer.h"

namespace molten::buffer_test {
namespace {

constexpr std::size_t kib = 1024, mib = 1024 * kib;

std::size_t count_other_than(const Buffer& b, std::size_t from, std::size_t to, char value) {
  const char* const bytes = static_cast<const char*>(b.data());
  return static_cast<std::size_t>(std::count_if(bytes + from, bytes + to, [=](char c) { return c != value; }));
}

TEST(BufferOfColumns, IsZeroAndAligned) {
  for (const std::size_t bytes :
       {std::size_t{100}, 64 * kib - 1, 64 * kib, 400 * kib, 2 * mib - 1, 2 * mib, 3 * mib, 4 * mib - 1}) {
    Buffer b;
    b.resize(bytes);
    EXPECT_GE(b.capacity(), bytes);
    EXPECT_LE(b.capacity(), bytes + bytes / 8 + 64) << "little is lost to rounding";
    EXPECT_EQ(count_other_than(b, 0, b.capacity(), 0), 0u) << bytes;
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(b.data()) % 64, 0u) << bytes;
    if (bytes >= 2 * mib) {
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(b.data()) % (2 * mib), 0u) << bytes;
    }
  }
}

TEST(BufferOfColumns, ColumnsAreApart) {
  std::vector<Buffer> columns(60);  // more than a slab
  for (std::size_t k = 0; k < columns.size(); ++k) {
    columns[k].resize(300 * kib + 100 * k);
    std::fill_n(static_cast<char*>(columns[k].data()), columns[k].capacity(), static_cast<char>(k + 1));
  }
  for (std::size_t k = 0; k < columns.size(); k += 2) columns[k] = Buffer();
  for (std::size_t k = 1; k < columns.size(); k += 2)
    EXPECT_EQ(count_other_than(columns[k], 0, columns[k].capacity(), static_cast<char>(k + 1)), 0u) << k;
}

TEST(BufferOfColumns, GrowsAndKeeps) {
  Buffer b;
  std::size_t kept = 50;
  b.resize(kept);
  std::fill_n(static_cast<char*>(b.data()), kept, 'a');
  for (const std::size_t bytes : {200 * kib, mib, 3 * mib, 9 * mib}) {
    b.resize(bytes, kept);
    EXPECT_EQ(count_other_than(b, 0, kept, 'a'), 0u) << bytes;
    EXPECT_EQ(count_other_than(b, kept, b.capacity(), 0), 0u) << bytes;
    kept = bytes - 100;
    std::fill_n(static_cast<char*>(b.data()), b.capacity(), 'a');
    b.extend(kept, bytes);
    EXPECT_EQ(count_other_than(b, 0, kept, 'a'), 0u) << bytes;
    EXPECT_EQ(count_other_than(b, kept, bytes, 0), 0u) << bytes;
  }
}

TEST(BufferOfColumns, MovesWithItsMemory) {
  Buffer a, b;
  a.resize(100 * kib);
  void* const at = a.data();
  b = std::move(a);
  EXPECT_EQ(b.data(), at);
  EXPECT_GE(b.capacity(), 100 * kib);
}

}  // namespace
}  // namespace molten::buffer_test
