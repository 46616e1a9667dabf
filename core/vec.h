// Small vectors and symmetric tensors whose components are numbers or lanes. For the hot loops; set-up code uses Eigen.
// Always inlined: a call would spill all registers that hold lanes, and g++ 12 makes calls where vectors have 32 bytes.
#pragma once

#include <array>
#include <utility>

namespace molten {

/// f(0), f(1), … f(n − 1) with the index known at compile time: the compilers then keep lanes in registers.
template <int n, class F> __attribute__((always_inline)) inline constexpr void unrolled(F&& f) {
  [&]<int... k>(std::integer_sequence<int, k...>) __attribute__((always_inline)) {
    (f(std::integral_constant<int, k>{}), ...);
  }
  (std::make_integer_sequence<int, n>{});
}

template <int Dim, class T> struct Vec {
  std::array<T, Dim> c;

  T& operator[](int d) { return c[d]; }
  const T& operator[](int d) const { return c[d]; }
  static Vec filled(T s) {
    Vec r;
    r.c.fill(s);
    return r;
  }

  [[gnu::always_inline]] friend Vec operator+(const Vec& a, const Vec& b) {
    Vec r;
    unrolled<Dim>([&](auto d) { r[d] = a[d] + b[d]; });
    return r;
  }
  [[gnu::always_inline]] friend Vec operator-(const Vec& a, const Vec& b) {
    Vec r;
    unrolled<Dim>([&](auto d) { r[d] = a[d] - b[d]; });
    return r;
  }
  [[gnu::always_inline]] friend Vec operator*(const T& s, const Vec& a) {
    Vec r;
    unrolled<Dim>([&](auto d) { r[d] = s * a[d]; });
    return r;
  }
  [[gnu::always_inline]] Vec& operator+=(const Vec& b) {
    unrolled<Dim>([&](auto d) { c[d] += b[d]; });
    return *this;
  }
  [[gnu::always_inline]] Vec& operator-=(const Vec& b) {
    unrolled<Dim>([&](auto d) { c[d] -= b[d]; });
    return *this;
  }
};

template <int Dim, class T> [[gnu::always_inline]] inline T dot(const Vec<Dim, T>& a, const Vec<Dim, T>& b) {
  T s = a[0] * b[0];
  unrolled<Dim - 1>([&](auto d) { s = s + a[d + 1] * b[d + 1]; });
  return s;
}

/// Components in the order xx, yy, xy (2-D) or xx, yy, zz, xy, xz, yz (3-D).
template <int Dim, class T> struct SymTensor {
  static constexpr int size = Dim * (Dim + 1) / 2;
  std::array<T, size> c;

  static constexpr int index(int a, int b) { return a == b ? a : (Dim == 2 ? 2 : 2 + a + b); }
  T& operator()(int a, int b) { return c[index(a, b)]; }
  const T& operator()(int a, int b) const { return c[index(a, b)]; }
  T& operator[](int k) { return c[k]; }
  const T& operator[](int k) const { return c[k]; }
  static SymTensor filled(T s) {
    SymTensor r;
    r.c.fill(s);
    return r;
  }

  [[gnu::always_inline]] friend SymTensor operator+(const SymTensor& a, const SymTensor& b) {
    SymTensor r;
    unrolled<size>([&](auto k) { r[k] = a[k] + b[k]; });
    return r;
  }
  [[gnu::always_inline]] friend SymTensor operator*(const T& s, const SymTensor& a) {
    SymTensor r;
    unrolled<size>([&](auto k) { r[k] = s * a[k]; });
    return r;
  }
  [[gnu::always_inline]] SymTensor& operator+=(const SymTensor& b) {
    unrolled<size>([&](auto k) { c[k] += b[k]; });
    return *this;
  }
  [[gnu::always_inline]] friend Vec<Dim, T> operator*(const SymTensor& s, const Vec<Dim, T>& x) {
    Vec<Dim, T> r;
    unrolled<Dim>([&](auto a) {
      r[a] = s(a, 0) * x[0];
      unrolled<Dim - 1>([&](auto b) { r[a] = r[a] + s(a, b + 1) * x[b + 1]; });
    });
    return r;
  }
};

/// a bᵀ + b aᵀ
template <int Dim, class T>
[[gnu::always_inline]] inline SymTensor<Dim, T> twice_symmetric(const Vec<Dim, T>& a, const Vec<Dim, T>& b) {
  SymTensor<Dim, T> r;
  unrolled<Dim>([&](auto i) {
    unrolled<Dim>([&](auto j) {
      if constexpr (j >= i) r(i, j) = a[i] * b[j] + b[i] * a[j];
    });
  });
  return r;
}

/// The curl of a field whose gradient is Σ a ⊗ b: Σ b × a. 2-D: its one component is the first, the second is 0.
template <int Dim, class T>
[[gnu::always_inline]] inline Vec<Dim, T> curl_of(const Vec<Dim, T>& a, const Vec<Dim, T>& b) {
  if constexpr (Dim == 2)
    return {{b[0] * a[1] - b[1] * a[0], T(0)}};
  else
    return {{b[1] * a[2] - b[2] * a[1], b[2] * a[0] - b[0] * a[2], b[0] * a[1] - b[1] * a[0]}};
}

/// w × x for a curl w
template <int Dim, class T>
[[gnu::always_inline]] inline Vec<Dim, T> turned_by(const Vec<Dim, T>& w, const Vec<Dim, T>& x) {
  if constexpr (Dim == 2)
    return {{-(w[0] * x[1]), w[0] * x[0]}};
  else
    return {{w[1] * x[2] - w[2] * x[1], w[2] * x[0] - w[0] * x[2], w[0] * x[1] - w[1] * x[0]}};
}

/// tr S²
template <int Dim, class T> [[gnu::always_inline]] inline T square_trace(const SymTensor<Dim, T>& s) {
  T diagonal = T(0), off = T(0);
  unrolled<Dim>([&](auto k) { diagonal = diagonal + s[k] * s[k]; });
  unrolled<SymTensor<Dim, T>::size - Dim>([&](auto k) { off = off + s[Dim + k] * s[Dim + k]; });
  return diagonal + T(2) * off;
}

}  // namespace molten
