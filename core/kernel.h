// Smoothing kernels W(r, h): normalised in 1-D, 2-D and 3-D ([Q] 2.16, 2.17, 4.3, 4.4; [D] 3.17-3.23, with the
// misprints in the constants of [D] 3.19 and 3.23 put right; tests/kernel_test.cpp proves each by quadrature).
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include "core/scene.h"
#include "core/simd.h"

namespace molten {

/// Support radius / smoothing length.
constexpr double kernel_reach(KernelKind kind) {
  switch (kind) {
    case KernelKind::gaussian:
      return 3;
    case KernelKind::quadratic:
    case KernelKind::cubic_spline:
    case KernelKind::wendland_c2:
      return 2;
    default:
      return 1;
  }
}

/// α h^d: the constant in front of the kernel's shape for h = 1 (m).
constexpr double kernel_constant(KernelKind kind, int dim) {
  constexpr double pi = std::numbers::pi;
  const auto of = [dim](double one, double two, double three) { return dim == 1 ? one : dim == 2 ? two : three; };
  switch (kind) {
    case KernelKind::gaussian:
      return of(0.56418958354775629, 1 / pi, 0.17958712212516656);
    case KernelKind::quadratic:
      return of(1, 2 / pi, 5 / (4 * pi));
    case KernelKind::cubic_spline:
      return of(2. / 3, 10 / (7 * pi), 1 / pi);
    case KernelKind::wendland_c2:
      return of(3. / 4, 7 / (4 * pi), 21 / (16 * pi));
    case KernelKind::lucy:
      return of(5. / 4, 5 / pi, 105 / (16 * pi));
    case KernelKind::poly6:
      return of(35. / 32, 4 / pi, 315 / (64 * pi));
    case KernelKind::spiky:
      return of(2, 10 / pi, 15 / pi);
  }
  return 0;
}

/// A kernel's shape w(q) and slope w'(q)/q at q = r/h, zero at and beyond the support.
template <class T> struct ShapeAndSlope { T w, slope; };

template <class T> ShapeAndSlope<T> cubic_spline_shape(T q) {
  // The two branches as one: ¼ (2−q)₊³ − (1−q)₊³, the B-spline written with truncated powers. Near 0 the slope's
  // terms cancel, so there it takes the inner branch, −3 + 9q/4.
  const T a = max(T(2) - q, T(0)), b = max(T(1) - q, T(0));
  const T outer = T(-0.75) * a * a * reciprocal(max(q, T(0.5)));
  return {T(0.25) * a * a * a - b * b * b, select_less(q, T(1), T(2.25) * q - T(3), outer)};
}

template <class T> ShapeAndSlope<T> uncommon_shape(KernelKind kind, T q) {
  const T one(1), zero(0), safe = max(q, T(1e-6));
  switch (kind) {
    case KernelKind::gaussian: {
      const T w = select_less(q, T(3), each_lane(-(q * q), [](auto x) { return std::exp(x); }), zero);
      return {w, T(-2) * w};
    }
    case KernelKind::quadratic: {
      const T t = max(T(2) - q, zero);
      return {T(3. / 16) * t * t, T(-3. / 8) * t / safe};
    }
    case KernelKind::lucy: {
      const T t = max(one - q, zero);
      return {(one + T(3) * q) * t * t * t, T(-12) * t * t};
    }
    case KernelKind::poly6: {
      const T t = max(one - q * q, zero);
      return {t * t * t, T(-6) * t * t};
    }
    default: {  // spiky
      const T t = max(one - q, zero);
      return {t * t * t, T(-3) * t * t / safe};
    }
  }
}

/// What a pass inlines: the two common kernels, or any other through one switch that is the same for all lanes.
enum class KernelChoice { wendland_c2, cubic_spline, other };

/// Evaluates weight · W and weight · W'(r)/r; `weight` is the particle mass (kg).
template <KernelChoice choice, class Real> class Kernel {
 public:
  Kernel(KernelKind kind, int dim, double smoothing_length, double weight) : kind_(kind) {
    const double shape = weight * kernel_constant(kind, dim) / std::pow(smoothing_length, dim);
    const double slope = shape / (smoothing_length * smoothing_length);
    if constexpr (choice == KernelChoice::wendland_c2) {
      // The argument is t = ∛(5 slope) (q/2 − 1), negative within the support, so that W'/r is its cube; W ∝ t⁴ (5 − 4
      // (1 − q/2)) follows from it.
      const double scale = std::cbrt(5 * slope);
      at_0_ = Real(-scale), per_r_ = Real(scale / (2 * smoothing_length));
      w_ = Real(5 * shape / std::pow(scale, 4)), slope_ = Real(4 * shape / std::pow(scale, 5));
    } else {
      at_0_ = 0, per_r_ = Real(1 / smoothing_length);
      w_ = Real(shape), slope_ = Real(slope);
    }
  }

  /// At the distance r (m).
  template <class T> ShapeAndSlope<T> operator()(T r) const { return at(T(at_0_) + T(per_r_) * r); }

  /// The same in two steps, so that a loop may do the first ahead: what the shape is a function of, at the square of
  /// the distance (m², above 0), and the kernel there.
  template <int N> Lanes<Real, N> argument(Lanes<Real, N> r2) const { return affine_root(r2, at_0_, per_r_); }
  template <class T> ShapeAndSlope<T> at(T argument) const {
    if constexpr (choice == KernelChoice::wendland_c2) {
      const T t = min(argument, T(0)), t3 = t * t * t;
      return {t3 * t * (T(w_) + T(slope_) * t), t3};
    } else {
      const ShapeAndSlope<T> s =
          choice == KernelChoice::cubic_spline ? cubic_spline_shape(argument) : uncommon_shape(kind_, argument);
      return {T(w_) * s.w, T(slope_) * s.slope};
    }
  }

 private:
  KernelKind kind_;
  Real at_0_, per_r_;  // the shape's argument at r = 0, and its growth (1/m)
  Real w_, slope_;
};

/// Calls f(kernel) with the kernel's type resolved.
template <class Real, class F>
decltype(auto) with_kernel(KernelKind kind, int dim, double smoothing_length, double weight, F&& f) {
  switch (kind) {
    case KernelKind::wendland_c2:
      return f(Kernel<KernelChoice::wendland_c2, Real>(kind, dim, smoothing_length, weight));
    case KernelKind::cubic_spline:
      return f(Kernel<KernelChoice::cubic_spline, Real>(kind, dim, smoothing_length, weight));
    default:
      return f(Kernel<KernelChoice::other, Real>(kind, dim, smoothing_length, weight));
  }
}

}  // namespace molten
