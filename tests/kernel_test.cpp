#include "core/kernel.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace molten::kernel_test {
namespace {

const std::vector<KernelKind> all_kernels = {KernelKind::gaussian,    KernelKind::quadratic, KernelKind::cubic_spline,
                                             KernelKind::wendland_c2, KernelKind::lucy,      KernelKind::poly6,
                                             KernelKind::spiky};
constexpr double pi = std::numbers::pi;

using Scalar = Lanes<double, 1>;

struct Values {
  double w, slope;  // W and W'(r)/r
};

Values evaluate(KernelKind kind, int dim, double smoothing_length, double r) {
  return with_kernel<double>(kind, dim, smoothing_length, 1.0, [&](const auto& kernel) {
    const auto v = kernel(Scalar(r));
    return Values{v.w.v, v.slope.v};
  });
}

/// ∫ f(r) dV over a ball (a disc, an interval) of this radius, by the midpoint rule.
double integral(int dim, double radius, const std::function<double(double)>& f) {
  constexpr int steps = 20000;
  const double dr = radius / steps, surface = dim == 1 ? 2 : dim == 2 ? 2 * pi : 4 * pi;
  double sum = 0;
  for (int k = 0; k < steps; ++k) {
    const double r = (k + 0.5) * dr;
    sum += f(r) * surface * std::pow(r, dim - 1) * dr;
  }
  return sum;
}

/// What the Gaussian's cut at 3h leaves out; the others are normalised over their support.
double cut_off(KernelKind kind, int dim) {
  if (kind != KernelKind::gaussian) return 0;
  return dim == 1 ? 2.21e-5 : dim == 2 ? 1.234e-4 : 4.398e-4;
}

void for_each_case(const std::function<void(KernelKind, int dim, double smoothing_length)>& f) {
  for (const KernelKind kind : all_kernels)
    for (int dim = 1; dim <= 3; ++dim)
      for (const double smoothing_length : {0.013, 1.0, 7.0}) {
        SCOPED_TRACE(testing::Message() << "kernel " << int(kind) << ", " << dim << "-D, h " << smoothing_length);
        f(kind, dim, smoothing_length);
      }
}

TEST(Kernel, IntegralIsOne) {
  for_each_case([](KernelKind kind, int dim, double length) {
    const double support = kernel_reach(kind) * length;
    const double sum = integral(dim, support, [&](double r) { return evaluate(kind, dim, length, r).w; });
    EXPECT_NEAR(sum, 1 - cut_off(kind, dim), 1e-6);
  });
}

TEST(Kernel, GradientHasTheMomentOfADerivative) {
  // ∫ ∇W · x dV = −d ∫W: the gradient of a linear field comes out right. The Gaussian's cut adds R W(R) times the
  // ball's surface, because W does not reach zero there.
  for_each_case([](KernelKind kind, int dim, double length) {
    const double support = kernel_reach(kind) * length;
    const double sum = integral(dim, support, [&](double r) { return evaluate(kind, dim, length, r).slope * r * r; });
    const double surface = (dim == 1 ? 2 : dim == 2 ? 2 * pi : 4 * pi) * std::pow(support, dim - 1);
    const double edge = evaluate(kind, dim, length, support * (1 - 1e-9)).w * support * surface;
    EXPECT_NEAR(sum, -dim * (1 - cut_off(kind, dim)) + edge, 1e-5);
  });
}

TEST(Kernel, SlopeIsTheDerivative) {
  for_each_case([](KernelKind kind, int dim, double length) {
    const double support = kernel_reach(kind) * length, step = 1e-5 * length;
    const double scale = evaluate(kind, dim, length, 0).w / length;
    for (int k = 1; k < 100; ++k) {
      const double r = k / 100.0 * support;
      const double difference =
          (evaluate(kind, dim, length, r + step).w - evaluate(kind, dim, length, r - step).w) / (2 * step);
      EXPECT_NEAR(evaluate(kind, dim, length, r).slope * r, difference, 1e-6 * scale) << r / length;
    }
  });
}

TEST(Kernel, NothingAtAndBeyondTheSupport) {
  for_each_case([](KernelKind kind, int dim, double length) {
    const double support = kernel_reach(kind) * length;
    for (const double factor : {1 + 1e-12, 1.001, 2.0, 1e5}) {
      EXPECT_EQ(evaluate(kind, dim, length, factor * support).w, 0) << factor;
      EXPECT_EQ(evaluate(kind, dim, length, factor * support).slope, 0) << factor;
    }
  });
}

TEST(Kernel, ContinuousFallingAndFinite) {
  for_each_case([](KernelKind kind, int dim, double length) {
    const double support = kernel_reach(kind) * length, top = evaluate(kind, dim, length, 0).w;
    constexpr int steps = 2000;
    double before = top;
    ASSERT_TRUE(std::isfinite(top) && std::isfinite(evaluate(kind, dim, length, 0).slope));
    for (int k = 1; k <= steps; ++k) {
      const Values v = evaluate(kind, dim, length, k * (1 + 1e-12) / steps * support);
      EXPECT_LE(v.w, before);
      EXPECT_LE(v.slope, 0);
      const double jump = k == steps && kind == KernelKind::gaussian ? 2 * std::exp(-9.0) : 0;
      EXPECT_LT(before - v.w, (4.0 / steps + jump) * top);
      before = v.w;
    }
  });
}

TEST(Kernel, CubicSplineIsTheTextbooks) {
  for (int k = 0; k <= 2100; ++k) {
    const double q = k / 1000.0;
    const double w = q < 1 ? 1 - 1.5 * q * q + 0.75 * q * q * q : q < 2 ? 0.25 * std::pow(2 - q, 3) : 0;
    const double slope = q < 1 ? -3 + 2.25 * q : q < 2 ? -0.75 * (2 - q) * (2 - q) / q : 0;
    const auto s = cubic_spline_shape(Scalar(q));
    EXPECT_NEAR(s.w.v, w, 2e-15) << q;
    EXPECT_NEAR(s.slope.v, slope, 2e-15) << q;
  }
}

TEST(Kernel, WeightAndScale) {
  // Twice the weight doubles; W scales as h^−d and W'/r as h^−(d+2).
  for_each_case([](KernelKind kind, int dim, double length) {
    const double r = 0.3 * kernel_reach(kind);
    const Values one = evaluate(kind, dim, 1, r), scaled = evaluate(kind, dim, length, r * length);
    EXPECT_NEAR(scaled.w * std::pow(length, dim) / one.w, 1, 1e-12);
    EXPECT_NEAR(scaled.slope * std::pow(length, dim + 2) / one.slope, 1, 1e-12);
    const double twice =
        with_kernel<double>(kind, dim, length, 2.0, [&](const auto& k) { return k(Scalar(r * length)).w.v; });
    EXPECT_NEAR(twice / scaled.w, 2, 1e-12);
  });
}

/// Compares all lanes of a bundle with the scalar twin in double.
template <class Real> void compare_lanes(KernelKind kind, int dim, double tolerance) {
  constexpr int N = native_lanes<Real>;
  with_kernel<Real>(kind, dim, 1.0, 1.0, [&](const auto& kernel) {
    const Values top = evaluate(kind, dim, 1, 0.02);
    for (int k = 1; k < 400; k += N) {
      Lanes<Real, N> r;
      for (int n = 0; n < N; ++n) r.v[n] = Real((k + n) / 390.0 * kernel_reach(kind));
      const auto many = kernel(r);
      for (int n = 0; n < N; ++n) {
        const Values one = evaluate(kind, dim, 1, double(r.v[n]));
        EXPECT_NEAR(many.w.v[n], one.w, tolerance * top.w) << r.v[n];
        EXPECT_NEAR(many.slope.v[n], one.slope, tolerance * std::abs(top.slope)) << r.v[n];
        const auto alone = kernel(Lanes<Real, 1>(r.v[n]));
        EXPECT_NEAR(many.slope.v[n], alone.slope.v, tolerance * std::abs(top.slope)) << r.v[n];
      }
    }
  });
}

TEST(Kernel, ManyLanesEqualOne) {
  for (const KernelKind kind : all_kernels)
    for (int dim = 1; dim <= 3; ++dim) {
      SCOPED_TRACE(testing::Message() << "kernel " << int(kind) << ", " << dim << "-D");
      compare_lanes<float>(kind, dim, 1e-6);
      compare_lanes<double>(kind, dim, 1e-14);
    }
}

TEST(Kernel, PrintedConstantsAreNotNormalised) {
  // The misprints that this file's integrals would catch: [D] 3.20 quadratic 1-D, [D] 3.24 Wendland 3-D, [Q] 4.3 poly6.
  const auto of_one = [](double printed, KernelKind kind, int dim) { return printed / kernel_constant(kind, dim); };
  EXPECT_NEAR(of_one(3. / 4, KernelKind::quadratic, 1), 3. / 4, 1e-12);
  EXPECT_NEAR(of_one(7 / (8 * pi), KernelKind::wendland_c2, 3), 2. / 3, 1e-12);
  EXPECT_NEAR(of_one(1, KernelKind::poly6, 3), 64 * pi / 315, 1e-12);
}

TEST(Kernel, ConductionConstants) {
  // c_d = h² ∫ |W'|/r dV bounds the time step of conduction; molten takes the Wendland kernel's 3.5 in 2-D and 3-D.
  const auto constant = [](KernelKind kind, int dim) {
    return integral(dim, kernel_reach(kind), [&](double r) { return -evaluate(kind, dim, 1, r).slope; });
  };
  EXPECT_NEAR(constant(KernelKind::wendland_c2, 2), 3.5, 1e-4);
  EXPECT_NEAR(constant(KernelKind::wendland_c2, 3), 3.5, 1e-4);
  EXPECT_NEAR(constant(KernelKind::cubic_spline, 2), 2.857, 1e-3);
  EXPECT_NEAR(constant(KernelKind::cubic_spline, 3), 3.0, 1e-3);
}

}  // namespace
}  // namespace molten::kernel_test
