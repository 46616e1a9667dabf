// Lanes of a cluster pair against plain loops: what is written with machine instructions gives the same numbers.
#include "core/simd.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace molten {
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
TYPED_TEST_SUITE(LanesOfPairs, Shapes);

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

}  // namespace
}  // namespace molten
