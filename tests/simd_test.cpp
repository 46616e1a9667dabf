// Lanes of a cluster pair against plain loops: what is written with machine instructions gives the same numbers.
#include "core/simd.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace molten::simd_test {
namespace {

/// I particles against N / I.
template <class Real_, int N_, int I_> struct Shape {
  using Real = Real_;
  static constexpr int N = N_, I = I_, J = N / I;
};

template <class S> class LanesOfPairs : public testing::Test {
 protected:
  using Real = typename S::Real;
  using L = Lanes<Real, S::N>;

  Real number() { return std::uniform_real_distribution<Real>(-1, 1)(random_); }
  L numbers() {
    L a;
    for (int k = 0; k < S::N; ++k) set_lane(a, k, number());
    return a;
  }

 private:
  std::mt19937 random_{7};
};

using Shapes = testing::Types<Shape<float, native_lanes<float>, 4>, Shape<double, native_lanes<double>, 4>,
                              Shape<float, 8, 4>, Shape<double, 4, 4>>;

struct ShapeNames {
  // Of AVX2's lanes two shapes are the same: numbered, too.
  template <class S> static std::string GetName(int number) {
    return fmt::format("{}{}by{}No{}", sizeof(typename S::Real) == 4 ? "Single" : "Double", S::I, S::J, number);
  }
};
TYPED_TEST_SUITE(LanesOfPairs, Shapes, ShapeNames);

TYPED_TEST(LanesOfPairs, RepeatEachOfIAndAllOfJ) {
  using S = TypeParam;
  using Real = typename S::Real;
  std::array<Real, 16> memory;
  for (Real& x : memory) x = this->number();
  const auto i = load_i<S::I, Real, S::N>(memory.data() + 1);  // on no boundary
  const auto j = load_j<S::J, Real, S::N>(memory.data() + 1);
  for (int k = 0; k < S::N; ++k) {
    EXPECT_EQ(lane(i, k), memory[1 + k / S::J]);
    EXPECT_EQ(lane(j, k), memory[1 + k % S::J]);
  }
}

TYPED_TEST(LanesOfPairs, SumsOverJ) {
  using S = TypeParam;
  const auto a = this->numbers();
  const auto sums = sum_j<S::I>(a);
  for (int i = 0; i < S::I; ++i) {
    double sum = 0, bound = 0;
    for (int j = 0; j < S::J; ++j) sum += lane(a, i * S::J + j), bound += std::abs(lane(a, i * S::J + j));
    EXPECT_NEAR(lane(sums, i), sum, bound * 2 * std::numeric_limits<typename S::Real>::epsilon());
  }
}

TYPED_TEST(LanesOfPairs, CompareFourWithBounds) {
  using S = TypeParam;
  using Real = typename S::Real;
  for (int repeat = 0; repeat < 200; ++repeat) {
    std::array<Lanes<Real, S::N>, 4> a;
    for (auto& lanes : a) lanes = this->numbers();
    std::array<Real, 16> bounds;
    for (Real& b : bounds) b = Real(-0.8) + Real(0.2) * this->number();
    unsigned expected = 0;
    for (int k = 0; k < 12; ++k)
      for (int n = 0; n < S::N; ++n)
        if (lane(a[k % 4], n) < bounds[k]) expected |= 1u << k;
    EXPECT_EQ(any_less_bits<12>(a, bounds), expected);
  }
}

/// Numbers that often follow one another, and room around them.
struct NumberLists : testing::Test {
  static constexpr std::size_t words = 8, count = 16 * words;

  NumberLists() {
    for (std::size_t k = 1; k < from_.size(); ++k) from_[k] = from_[k - 1] + 1 + (random_() % 4 == 0);
    for (auto& mask : masks_) mask = static_cast<std::uint16_t>(random_());
    masks_[2] = 0, masks_[3] = 0xffff;
  }
  const std::uint32_t* from() const { return from_.data() + 16; }

  std::mt19937 random_{3};
  std::array<std::uint32_t, count + 32> from_{}, to_{};
  std::array<std::uint16_t, words> masks_{};
};

TEST_F(NumberLists, SelectByBits) {
  std::vector<std::uint32_t> expected;
  for (std::size_t k = 0; k < count; ++k)
    if (masks_[k / 16] >> k % 16 & 1) expected.push_back(from()[k] - 5);
  const std::size_t found = select_less_by(from(), words, 5, to_.data(), [&](std::size_t w) { return masks_[w]; });
  EXPECT_EQ(std::vector<std::uint32_t>(to_.begin(), to_.begin() + static_cast<std::ptrdiff_t>(found)), expected);
}

TEST_F(NumberLists, BitsThatAreSet) {
  for (unsigned mask = 0; mask < 256; ++mask) {
    const int found = write_set_bits(mask, 100, to_.data());
    int n = 0;
    for (unsigned k = 0; k < 8; ++k) {
      if ((mask >> k & 1) == 0) continue;
      ASSERT_EQ(to_[static_cast<std::size_t>(n++)], 100 + k) << mask;
    }
    ASSERT_EQ(found, n);
  }
}

TEST_F(NumberLists, BreaksBetweenRuns) {
  for (std::size_t w = 0; w < words; ++w)
    for (unsigned k = 0; k < 16; ++k) {
      const std::uint32_t* const at = from() + 16 * w + k;
      EXPECT_EQ(breaks(from() + 16 * w) >> k & 1, at[0] != at[-1] + 1);
    }
}

TEST_F(NumberLists, OneBitOfEach) {
  std::array<std::uint16_t, 16> flags;
  for (auto& f : flags) f = static_cast<std::uint16_t>(random_());
  for (int bit = 0; bit < 16; ++bit)
    for (unsigned k = 0; k < 16; ++k) EXPECT_EQ(gather_bit(flags.data(), bit) >> k & 1, flags[k] >> bit & 1) << bit;
}

}  // namespace
}  // namespace molten::simd_test
