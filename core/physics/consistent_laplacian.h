// A Laplacian that is exact for quadratic fields wherever the particles lie, so of first order in disorder and of
// second on a lattice, where the conservative form (heat_conduction.h, laminar_viscosity.h) errs by a share of the
// gradient over the spacing, which grows as that shrinks. Its weights are those of the conservative form times a
// polynomial of the particle's own,
//   ∇²f ≈ Σ V_j 2 (W'/r) (1 + a·x_ij + x_ij·B x_ij)(f_i − f_j),
// with a and B such that all of a linear field vanishes and of a quadratic one the Laplacian is left, as in the
// renormalised second derivatives of Fatehi & Manzari (2011), with weights as in King, Lind & Nasar (2020). What i
// takes from j is no longer what j gives to i: heat and momentum are conserved to the error of the operator only.
// At free surfaces a and B fade away.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <type_traits>

#include "core/fields.h"
#include "core/physics/gradient_correction.h"
#include "core/simd.h"

namespace molten {

/// Products of `order` components of a vector: which components each is made of, in the order of the sums' fields.
template <int Dim, int order> struct Monomials {
  using Axes = std::array<int, order>;
  static constexpr int count = monomial_count(Dim, order);

  /// Non-decreasing tuples of axes.
  static constexpr std::array<Axes, count> axes = [] {
    std::array<Axes, count> all{};
    Axes next{};
    for (Axes& a : all) {
      a = next;
      int k = order - 1;
      while (k >= 0 && next[k] == Dim - 1) --k;
      if (k < 0) break;
      std::fill(next.begin() + k, next.end(), next[k] + 1);
    }
    return all;
  }();

  static constexpr int place(Axes of) {
    std::sort(of.begin(), of.end());
    return static_cast<int>(std::find(axes.begin(), axes.end(), of) - axes.begin());
  }

  template <class L> [[gnu::always_inline]] static Vec<count, L> of(const Vec<Dim, L>& x) {
    Vec<count, L> products;
    unrolled<count>([&](auto k) {
      products[k] = x[axes[k][0]];
      unrolled<order - 1>([&](auto n) { products[k] = products[k] * x[axes[k][n + 1]]; });
    });
    return products;
  }
};

/// Sums ρ0 Σ V_j (W'/r) times x_ij, x_ij x_ij and so on to the fourth power.
template <int Dim> struct LaplacianMoments {
  using Reads = FieldList<>;
  using Sums = FieldList<FirstMoment, Moment, ThirdMoment, FourthMoment>;
  static constexpr bool on = true;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    GradientMoment{}(ij, i, j, out);
    out.gradW(first_moment, ij.x);
    out.gradW(third_moment, Monomials<Dim, 3>::of(ij.x));
    out.gradW(fourth_moment, Monomials<Dim, 4>::of(ij.x));
  }
};

/// a and B of one particle, from the sums over ρ0.
template <int Dim> class LaplacianWeights {
  static constexpr int squares = SymTensor<Dim, double>::size, unknowns = Dim + squares;
  using Matrix = Eigen::Matrix<double, unknowns, unknowns>;
  using Column = Eigen::Matrix<double, unknowns, 1>;
  /// How far weights may be from 1: displaced by 0.3 spacings particles need up to 5. More is asked where neighbours do
  /// not tell quadratic fields apart, as those of some short-ranged kernels on a lattice: there the plain form is left.
  static constexpr double furthest = 6;

 public:
  Vec<Dim, double> tilt = Vec<Dim, double>::filled(0);              // a, 1/m
  SymTensor<Dim, double> bend = SymTensor<Dim, double>::filled(0);  // B, 1/m²

  /// `reach`: support radius (m), the unit of length of the equations.
  template <class Sums> LaplacianWeights(const Sums& sums, double per_density, double reach) {
    SymTensor<Dim, double> second;
    for (int k = 0; k < squares; ++k) second[k] = -per_density * sums[moment][k];
    // A surface's own particles have a least eigenvalue of 0.5, inner ones displaced by 0.2 spacings 0.7 or more.
    const double share = std::clamp((GradientCorrection<Dim>(second).least - 0.5) / 0.1, 0.0, 1.0);
    if (share == 0) return;
    Matrix m;
    Column missing;
    for (int a = 0; a < Dim; ++a) {
      missing[a] = per_density * reach * sums[first_moment][a];
      for (int b = 0; b < Dim; ++b) m(a, b) = second(a, b);
      for (int k = 0; k < squares; ++k)
        m(a, Dim + k) = m(Dim + k, a) = -per_density / reach * sums[third_moment][thirds[a][k]];
    }
    for (int k = 0; k < squares; ++k) {
      missing[Dim + k] = (k < Dim) - second[k];
      for (int l = 0; l < squares; ++l)
        m(Dim + k, Dim + l) = -per_density / (reach * reach) * sums[fourth_moment][fourths[k][l]];
    }
    const Column found = share * m.ldlt().solve(missing);
    if (!(found.template head<Dim>().norm() + found.template tail<squares>().norm() < furthest)) return;
    for (int a = 0; a < Dim; ++a) tilt[a] = found[a] / reach;
    // x·B x counts what is off the diagonal twice.
    for (int k = 0; k < squares; ++k) bend[k] = found[Dim + k] / (reach * reach) * (k < Dim ? 1 : 0.5);
  }

 private:
  /// The axes of a symmetric tensor's component.
  static constexpr std::array<int, 2> pair_of(int k) {
    for (int a = 0; a < Dim; ++a)
      for (int b = a; b < Dim; ++b)
        if (SymTensor<Dim, double>::index(a, b) == k) return {a, b};
    return {};
  }
  static constexpr auto thirds = [] {
    std::array<std::array<int, squares>, Dim> places{};
    for (int a = 0; a < Dim; ++a)
      for (int k = 0; k < squares; ++k) places[a][k] = Monomials<Dim, 3>::place({a, pair_of(k)[0], pair_of(k)[1]});
    return places;
  }();
  static constexpr auto fourths = [] {
    std::array<std::array<int, squares>, squares> places{};
    for (int k = 0; k < squares; ++k)
      for (int l = 0; l < squares; ++l)
        places[k][l] = Monomials<Dim, 4>::place({pair_of(k)[0], pair_of(k)[1], pair_of(l)[0], pair_of(l)[1]});
    return places;
  }();
};

/// 1 + a·x + x·B x
template <class Pair, class I> [[gnu::always_inline]] inline auto laplacian_weight_of(const Pair& ij, const I& i) {
  using L = std::decay_t<decltype(ij.r2)>;
  return L(1) + dot(i[laplacian_tilt] + i[laplacian_bend] * ij.x, ij.x);
}

/// dv/dt = η/ρ ∇²v
template <class Real> struct ConsistentViscosity {
  using Reads = FieldList<Velocity, Compression, LaplacianTilt, LaplacianBend>;
  using Sums = FieldList<Acceleration>;
  bool on = false;
  Real strength = 0;  // 2 η/ρ0², Pa s m⁶/kg²

  ConsistentViscosity(double viscosity, double rest_density)
      : on(viscosity > 0), strength(Real(2 * viscosity / (rest_density * rest_density))) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    const L factor = L(strength) * reciprocal(L(1) + i[compression]) * laplacian_weight_of(ij, i);
    out.gradW(acceleration, factor * (i[velocity] - j[velocity]));
  }
};

/// dT/dt = k ∇²T
template <class Real> struct ConsistentConduction {
  using Reads = FieldList<LocalTemperature, LaplacianTilt, LaplacianBend>;
  using Sums = FieldList<TemperatureRate>;
  bool on = false;
  Real strength = 0;  // 2 k/ρ0, m⁵/(kg s)

  ConsistentConduction(double diffusivity, double rest_density)
      : on(diffusivity > 0), strength(Real(2 * diffusivity / rest_density)) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    out.gradW(temperature_rate,
              L(strength) * laplacian_weight_of(ij, i) * (i[local_temperature] - j[local_temperature]));
  }
};

}  // namespace molten
