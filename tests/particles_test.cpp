#include "core/particles.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

#include "tests/memory_archive.h"

namespace molten::particles_test {
namespace {

const FieldSet some_fields =
    field_set(FieldList<Id, Position, Velocity, Compression, Temperature, Stress, LocalTemperature>{});

/// Fills every column with numbers of its own; the last slot is padding.
template <int Dim, class Real> Particles<Dim, Real> numbered(std::size_t slots) {
  Particles<Dim, Real> p(some_fields);
  p.resize(slots, slots - 1);
  for_each_field([&]<class F>(F) {
    if (!p.has(F{})) return;
    for (int k = 0; k < components<F, Dim>; ++k)
      for (std::size_t s = 0; s < slots; ++s)
        p[F{}][k][s] = static_cast<stored_t<F, Real>>(1000 * field_index<F> + 100 * k + s);
  });
  for (std::size_t s = 0; s < slots; ++s) p[id][0][s] = s + 1 < slots ? static_cast<std::int64_t>(s) : padding_id;
  return p;
}

/// How many numbers of two sets of particles differ in the slots, in fields that follow a sort.
template <int Dim, class Real> int differences(const Particles<Dim, Real>& a, const Particles<Dim, Real>& b) {
  int count = 0;
  for_each_field([&]<class F>(F) {
    if (!a.has(F{}) || F::lifetime == Lifetime::step) return;
    for (int k = 0; k < components<F, Dim>; ++k)
      for (std::size_t s = 0; s < a.slots(); ++s) count += a[F{}][k][s] != b[F{}][k][s];
  });
  return count;
}

TEST(Particles, HaveOnlyTheirColumns) {
  const auto p = numbered<3, float>(8);
  EXPECT_TRUE(p.has(velocity) && p.has(temperature));
  EXPECT_FALSE(p.has(viscosity));
  EXPECT_EQ(p[viscosity][0], nullptr);
  EXPECT_EQ(p[acceleration][2], nullptr);
  EXPECT_TRUE(p.has(field_set(FieldList<Velocity, Stress>{})));
  EXPECT_FALSE(p.has(field_set(FieldList<Velocity, Viscosity>{})));
  EXPECT_TRUE((Particles<2, double>(FieldSet{}).has(id))) << "every particle has an id";
  EXPECT_TRUE((Particles<2, double>(FieldSet{}).has(local_position))) << "and a place in its cluster";
}

TEST(Particles, ColumnsStartOnCacheLines) {
  const auto p = numbered<3, float>(20);
  for (const auto* column : p[stress].c) EXPECT_EQ(reinterpret_cast<std::uintptr_t>(column) % 64, 0u);
}

TEST(Particles, ShapesAndStorage) {
  static_assert(components<Velocity, 2> == 2 && components<Velocity, 3> == 3);
  static_assert(components<Stress, 2> == 3 && components<Stress, 3> == 6);
  static_assert(std::is_same_v<stored_t<Velocity, float>, float>);
  static_assert(std::is_same_v<stored_t<Position, float>, double>);
  static_assert(std::is_same_v<stored_t<Id, float>, std::int64_t>);
  const auto p = numbered<3, double>(4);
  const SymTensor<3, double> value = p[stress].of(2);
  p[stress].set(1, value);
  for (int k = 0; k < 6; ++k) EXPECT_EQ(p[stress][k][1], p[stress][k][2]);
}

template <int Dim, class Real> void expect_permuted() {
  auto p = numbered<Dim, Real>(8);
  const auto old = numbered<Dim, Real>(8);
  const std::vector<std::int32_t> order = {6, 5, -1, 3, 0, 1, 2, 4, -1, -1, -1, -1};
  p.permute(order, 7);
  EXPECT_EQ(p.slots(), order.size());
  EXPECT_EQ(p.count(), 7u);
  for (std::size_t s = 0; s < order.size(); ++s) {
    EXPECT_EQ(p.is_padding(s), order[s] < 0);
    for_each_field([&]<class F>(F) {
      if (!p.has(F{}) || F::lifetime == Lifetime::step) return;
      for (int k = 0; k < components<F, Dim>; ++k) {
        const auto nothing = F::storage == Storage::id ? stored_t<F, Real>(padding_id) : stored_t<F, Real>(0);
        EXPECT_EQ(p[F{}][k][s], order[s] < 0 ? nothing : old[F{}][k][order[s]]) << F::name;
      }
    });
  }
}

TEST(Particles, PermuteMovesWhatFollowsASort) {
  expect_permuted<2, float>();
  expect_permuted<3, double>();
}

TEST(Particles, PermuteBackIsTheSame) {
  constexpr std::size_t slots = 4096;
  auto p = numbered<3, float>(slots);
  std::vector<std::int32_t> order(slots), back(slots);
  for (std::size_t s = 0; s < slots; ++s) order[s] = static_cast<std::int32_t>(s * 1237 % slots);
  for (std::size_t s = 0; s < slots; ++s) back[order[s]] = static_cast<std::int32_t>(s);
  p.permute(order, p.count());
  EXPECT_GT(differences(p, numbered<3, float>(slots)), 0);
  p.permute(back, p.count());
  EXPECT_EQ(differences(p, numbered<3, float>(slots)), 0);
}

TEST(Particles, BytesAreTheColumns) {
  constexpr std::size_t slots = 1024;
  const auto p = numbered<3, float>(slots);
  const std::size_t a_slot = 8 + 3 * 8 + 3 * 4 + 4 + 8 + 6 * 4 + 4 + 3 * 4;  // in the order of some_fields, and where
  EXPECT_EQ(p.bytes(), slots * a_slot);
  auto q = numbered<3, float>(slots);
  std::vector<std::int32_t> order(slots);
  std::iota(order.begin(), order.end(), 0);
  q.permute(order, slots);
  EXPECT_GE(q.bytes(), p.bytes() + slots * 8) << "the scratch column counts";
}

TEST(Particles, ResizeToFewerKeepsTheMemory) {
  auto p = numbered<2, float>(1024);
  const std::size_t before = p.bytes();
  p.resize(64, 60);
  EXPECT_EQ(p.slots(), 64u);
  EXPECT_EQ(p.count(), 60u);
  EXPECT_EQ(p.bytes(), before);
}

TEST(Particles, ArchiveRoundTrip) {
  auto saved = numbered<3, float>(24);
  MemoryArchive archive;
  saved.archive(archive);
  archive.rewind();
  Particles<3, float> loaded(some_fields);
  loaded.archive(archive);
  EXPECT_EQ(loaded.slots(), 24u);
  EXPECT_EQ(loaded.count(), 23u);
  EXPECT_EQ(differences(saved, loaded), 0);
}

TEST(Particles, ArchiveHasEveryColumnOnce) {
  auto p = numbered<2, double>(4);
  MemoryArchive archive;
  p.archive(archive);
  const std::vector<std::string> expected = {
      "particles/compression",     "particles/count",           "particles/id",
      "particles/local_position0", "particles/local_position1", "particles/local_temperature",
      "particles/position0",       "particles/position1",       "particles/slots",
      "particles/stress0",         "particles/stress1",         "particles/stress2",
      "particles/temperature",     "particles/velocity0",       "particles/velocity1"};
  EXPECT_EQ(archive.names(), expected);
}

}  // namespace
}  // namespace molten::particles_test
