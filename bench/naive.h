// The naive twin of a pair pass: terms summed by brute force over all particles, in double, from the true positions.
// And a number that counts its operations, for the arithmetic a pass needs a pair.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "core/pair_pass.h"
#include "core/state.h"

namespace molten::bench {

/// Calls f(field, component) for each component of a list of fields.
template <int Dim, class... Fs, class F> void for_each_component(FieldList<Fs...>, F&& f) {
  [[maybe_unused]] const auto of = [&]<class G>(G field) {
    for (int k = 0; k < components<G, Dim>; ++k) f(field, k);
  };
  (of(Fs{}), ...);
}

/// Where terms add what one pair gives, written out plainly. What goes along x_ij is multiplied once, in finish().
template <class Sums, int Dim, class T> class PlainOut {
 public:
  Values<Sums, Dim, T> sums;

  PlainOut(const ShapeAndSlope<T>& kernel, const Vec<Dim, T>& x) : kernel_(kernel), x_(x) {
    for_each_component<Dim>(Sums{}, [&](auto field, int k) {
      component(sums[field], k) = T(0);
      component(radial_[field], k) = T(0);
    });
  }

  template <class F> void gradW(F, value_t<F, Dim, T> v) {
    for (int k = 0; k < components<F, Dim>; ++k) component(sums[F{}], k) += kernel_.slope * component(v, k);
  }
  template <class F> void W(F, value_t<F, Dim, T> v) {
    for (int k = 0; k < components<F, Dim>; ++k) component(sums[F{}], k) += kernel_.w * component(v, k);
  }
  template <class F> void along(F, const T& s) {
    radial_[F{}][0] += s;
    has_radial_.set(field_index<F>);
  }
  void finish() {
    for_each_field([&]<class F>(F) {
      if constexpr (is_among<F, Sums> && F::shape == FieldShape::vector) {
        if (!has_radial_.test(field_index<F>)) return;
        const T s = kernel_.slope * radial_[F{}][0];
        for (int d = 0; d < Dim; ++d) sums[F{}][d] += s * x_[d];
      }
    });
  }

 private:
  ShapeAndSlope<T> kernel_;      // times m_j
  Vec<Dim, T> x_;                // x_i − x_j
  Values<Sums, Dim, T> radial_;  // component 0 only
  FieldSet has_radial_;
};

template <class... Terms> using ReadsOf = typename UnionOf<typename Terms::Reads...>::type;
template <class... Terms> using SumsOf = typename UnionOf<typename Terms::Sums...>::type;

/// What the terms sum for the particle in slot i, and `scale`: the sum of the sizes of what the pairs give, which
/// round-off is relative to.
template <int Dim, class... Terms> struct NaiveSums {
  using T = Lanes<double, 1>;
  using Sums = SumsOf<Terms...>;
  static constexpr Sums fields{};
  Values<Sums, Dim, T> value, scale;

  template <class Real> NaiveSums(const State<Dim, Real>& s, std::size_t i, const Terms&... terms) {
    clear(value), clear(scale);
    const Particles<Dim, Real>& p = s.particles;
    const auto x = p[position];
    const double support = s.parameters.support_radius;
    const auto own = read(p, i);
    for (std::size_t j = 0; j < p.slots(); ++j) {
      if (j == i || p.is_padding(j)) continue;
      Pair<Dim, T> ij;
      for (int d = 0; d < Dim; ++d) ij.x[d] = x[d][i] - x[d][j];
      ij.r2 = dot(ij.x, ij.x);
      if (ij.r2.v < support * support) add_pair(s.parameters, ij, own, read(p, j), terms...);
    }
  }

 private:
  using Read = ReadsOf<Terms...>;

  static void clear(Values<Sums, Dim, T>& v) {
    for_each_component<Dim>(Sums{}, [&](auto field, int k) { component(v[field], k) = T(0); });
  }

  template <class Real> static Values<Read, Dim, T> read(const Particles<Dim, Real>& p, std::size_t slot) {
    Values<Read, Dim, T> v;
    for_each_component<Dim>(
        Read{}, [&](auto field, int k) { component(v[field], k) = p.has(field) ? T(p[field][k][slot]) : T(0); });
    return v;
  }

  void add_pair(const Parameters<Dim>& q, const Pair<Dim, T>& ij, const Values<Read, Dim, T>& i,
                const Values<Read, Dim, T>& j, const Terms&... terms) {
    const auto kernel = with_kernel<double>(q.kernel, Dim, q.smoothing_length, q.particle_mass,
                                            [&](const auto& k) { return k(T(std::sqrt(ij.r2.v))); });
    const auto add = [&](const auto& term) {
      if (!term.on) return;
      PlainOut<Sums, Dim, T> out(kernel, ij.x);
      term(ij, i, j, out);
      out.finish();
      for_each_component<Dim>(Sums{}, [&](auto field, int k) {
        const double v = component(out.sums[field], k).v;
        component(value[field], k).v += v;
        component(scale[field], k).v += std::abs(v);
      });
    };
    (add(terms), ...);
  }
};

/// A number that counts the additions, multiplications, minima, divisions and roots made with its like, each as one.
struct Counted {
  static inline thread_local std::int64_t operations = 0;
  Counted() = default;
  explicit Counted(double) {}
  static Counted one_more() {
    ++operations;
    return {};
  }
  friend Counted operator+(Counted, Counted) { return one_more(); }
  friend Counted operator-(Counted, Counted) { return one_more(); }
  friend Counted operator*(Counted, Counted) { return one_more(); }
  friend Counted operator/(Counted, Counted) { return one_more(); }
  friend Counted operator-(Counted) { return {}; }  // part of an addition that follows
  Counted& operator+=(Counted) { return one_more(), *this; }
  friend Counted min(Counted, Counted) { return one_more(); }
  friend Counted max(Counted, Counted) { return one_more(); }
  friend Counted reciprocal(Counted) { return one_more(); }
};

/// Of the Wendland kernel's slope alone, where no term uses its value: the minimum with 0, the third power.
constexpr std::int64_t slope_operations = 3;

/// Operations a directed pair: distance, Wendland kernel, and the terms that are on; what depends on i alone included.
template <int Dim, class... Terms> std::int64_t operations_a_pair(const Terms&... terms) {
  using T = Counted;
  const std::int64_t before = T::operations;
  Values<ReadsOf<Terms...>, Dim, T> i, j;
  Pair<Dim, T> ij;
  Vec<Dim, T> a, b;
  ij.x = a - b;
  ij.r2 = dot(ij.x, ij.x);
  const T root = T::one_more();
  const T q = root * T(1);
  const std::int64_t before_kernel = T::operations;
  const Kernel<KernelChoice::wendland_c2, double> wendland(KernelKind::wendland_c2, Dim, 1, 1);
  const ShapeAndSlope<T> kernel = wendland.at(q);
  if (!is_among<XsphVelocity, SumsOf<Terms...>>) T::operations = before_kernel + slope_operations;
  PlainOut<SumsOf<Terms...>, Dim, T> out(kernel, ij.x);
  const auto add = [&](const auto& term) {
    if (term.on) term(ij, i, j, out);
  };
  (add(terms), ...);
  out.finish();
  return T::operations - before;
}

}  // namespace molten::bench
