// Lanes: N numbers handled as one. The hot loops are written once in terms of Lanes<Real, N>; N = 1 is the plain scalar
// twin that the tests hold them against. Machine instructions stand in this file only. (The zero-masked forms with a
// full mask are the plain instructions; g++ 12 warns of undefined values in its own header for the unmasked ones.)
#pragma once

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace molten {

/// The widest lanes that this build's machine handles in one instruction.
template <class Real>
inline constexpr int native_lanes =
#if defined(__AVX512F__)
    64 / static_cast<int>(sizeof(Real));
#else
    32 / static_cast<int>(sizeof(Real));
#endif

inline constexpr int vector_registers =
#if defined(__AVX512F__)
    32;
#else
    16;
#endif

/// The compilers' vector types by name: g++ 12 does not take a vector size that depends on a template's parameters.
template <class Real, int N> struct NativeVector;
template <class Real> struct NativeVector<Real, 1> { typedef Real type; };
template <> struct NativeVector<float, 4> { typedef float type __attribute__((vector_size(16))); };
template <> struct NativeVector<float, 8> { typedef float type __attribute__((vector_size(32))); };
template <> struct NativeVector<float, 16> { typedef float type __attribute__((vector_size(64))); };
template <> struct NativeVector<double, 4> { typedef double type __attribute__((vector_size(32))); };
template <> struct NativeVector<double, 8> { typedef double type __attribute__((vector_size(64))); };

template <class Real, int N> struct Lanes {
  using Native = typename NativeVector<Real, N>::type;
  Native v;

  Lanes() = default;
  Lanes(Native native) : v(native) {}
  Lanes(Real s) requires(N > 1) : v(s - Native{}) {}

  friend Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
  friend Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
  friend Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
  friend Lanes operator/(Lanes a, Lanes b) { return a.v / b.v; }
  friend Lanes operator-(Lanes a) { return -a.v; }
  Lanes& operator+=(Lanes b) {
    v += b.v;
    return *this;
  }
  Lanes& operator-=(Lanes b) {
    v -= b.v;
    return *this;
  }
  Lanes& operator*=(Lanes b) {
    v *= b.v;
    return *this;
  }
};

// ---- elementwise functions ------------------------------------------------------------------------------------------

/// a < b ? x : y, lane by lane.
template <class Real, int N>
inline Lanes<Real, N> select_less(Lanes<Real, N> a, Lanes<Real, N> b, Lanes<Real, N> x, Lanes<Real, N> y) {
  return a.v < b.v ? x.v : y.v;
}
inline double select_less(double a, double b, double x, double y) { return a < b ? x : y; }

/// 8 consecutive numbers from memory.
inline Lanes<float, 8> load_8(const float* p) { return Lanes<float, 8>((Lanes<float, 8>::Native)_mm256_loadu_ps(p)); }

template <class Real, int N> inline Lanes<Real, N> max(Lanes<Real, N> a, Lanes<Real, N> b) {
  using V [[maybe_unused]] = decltype(a.v);
  if constexpr (N == 1) return std::max(a.v, b.v);
#if defined(__AVX512F__)
  else if constexpr (N == 16)
    return {(V)_mm512_maskz_max_ps(0xffff, (__m512)a.v, (__m512)b.v)};
  else if constexpr (N == 8 && sizeof(Real) == 8)
    return {(V)_mm512_maskz_max_pd(0xff, (__m512d)a.v, (__m512d)b.v)};
#endif
  else if constexpr (N == 8)
    return {(V)_mm256_max_ps((__m256)a.v, (__m256)b.v)};
  else if constexpr (sizeof(Real) == 8)
    return {(V)_mm256_max_pd((__m256d)a.v, (__m256d)b.v)};
  else
    return {(V)_mm_max_ps((__m128)a.v, (__m128)b.v)};
}
template <class Real, int N> inline Lanes<Real, N> min(Lanes<Real, N> a, Lanes<Real, N> b) {
  using V [[maybe_unused]] = decltype(a.v);
  if constexpr (N == 1) return std::min(a.v, b.v);
#if defined(__AVX512F__)
  else if constexpr (N == 16)
    return {(V)_mm512_maskz_min_ps(0xffff, (__m512)a.v, (__m512)b.v)};
  else if constexpr (N == 8 && sizeof(Real) == 8)
    return {(V)_mm512_maskz_min_pd(0xff, (__m512d)a.v, (__m512d)b.v)};
#endif
  else if constexpr (N == 8)
    return {(V)_mm256_min_ps((__m256)a.v, (__m256)b.v)};
  else if constexpr (sizeof(Real) == 8)
    return {(V)_mm256_min_pd((__m256d)a.v, (__m256d)b.v)};
  else
    return {(V)_mm_min_ps((__m128)a.v, (__m128)b.v)};
}

/// 1/a to the precision of Real less about one bit: the hardware's estimate and one Newton step in single, a division
/// in double.
template <class Real, int N> inline Lanes<Real, N> reciprocal(Lanes<Real, N> a) {
  if constexpr (sizeof(Real) == 4 && N > 1) {
    Lanes<Real, N> e;
#if defined(__AVX512F__)
    if constexpr (N == 16)
      e.v = (typename Lanes<Real, N>::Native)_mm512_maskz_rcp14_ps(0xffff, (__m512)a.v);
    else
#endif
        if constexpr (N == 8)
      e.v = (typename Lanes<Real, N>::Native)_mm256_rcp_ps((__m256)a.v);
    else
      return Lanes<Real, N>(Real(1)) / a;
    return e * (Lanes<Real, N>(Real(2)) - a * e);
  } else {
    return Lanes<Real, N>(Real(1)) / a;
  }
}

/// c0 + c1 √a for a > 0, to the precision of Real less about one bit: in single with the hardware's e ≈ 1/√a and s = a
/// e one Newton step is √a ≈ s (3 − s e)/2.
template <class Real, int N> inline Lanes<Real, N> affine_root(Lanes<Real, N> a, Real c0, Real c1) {
  using L = Lanes<Real, N>;
  if constexpr (N == 1)
    return c0 + c1 * std::sqrt(a.v);
  else if constexpr (sizeof(Real) == 4) {
    L e;
#if defined(__AVX512F__)
    if constexpr (N == 16)
      e.v = (typename L::Native)_mm512_maskz_rsqrt14_ps(0xffff, (__m512)a.v);
    else
#endif
        if constexpr (N == 8)
      e.v = (typename L::Native)_mm256_rsqrt_ps((__m256)a.v);
    else
      e.v = (typename L::Native)_mm_rsqrt_ps((__m128)a.v);
    const L s = a * e;
    return L(c0) + s * (L(Real(1.5) * c1) - L(Real(0.5) * c1) * (s * e));
  } else {
    L root;
#if defined(__AVX512F__)
    if constexpr (N == 8)
      root.v = (typename L::Native)_mm512_maskz_sqrt_pd(0xff, (__m512d)a.v);
    else
#endif
      root.v = (typename L::Native)_mm256_sqrt_pd((__m256d)a.v);
    return L(c0) + L(c1) * root;
  }
}

/// f of each lane, where no instruction does it.
template <class F> inline double each_lane(double a, F&& f) { return f(a); }
template <class Real, int N, class F> inline Lanes<Real, N> each_lane(Lanes<Real, N> a, F&& f) {
  if constexpr (N == 1)
    return f(a.v);
  else {
    Lanes<Real, N> r;
    for (int k = 0; k < N; ++k) r.v[k] = f(a.v[k]);
    return r;
  }
}

// ---- the particles of a cluster, side by side -----------------------------------------------------------------------

template <int N, class Real> inline Lanes<Real, N> load(const Real* p) {
  Lanes<Real, N> a;
  std::memcpy(&a.v, p, sizeof a.v);
  return a;
}
template <class Real, int N> inline void store(Lanes<Real, N> a, Real* p) { std::memcpy(p, &a.v, sizeof a.v); }

/// The same as doubles, whatever is stored.
template <int N, class Real> inline Lanes<double, N> load_double(const Real* p) {
  if constexpr (sizeof(Real) == sizeof(double))
    return load<N>(p);
  else
    return {__builtin_convertvector(load<N>(p).v, typename Lanes<double, N>::Native)};
}
template <class Real, int N> inline void store_rounded(Lanes<double, N> a, Real* p) {
  if constexpr (sizeof(Real) == sizeof(double))
    store(a, p);
  else
    store(Lanes<Real, N>(__builtin_convertvector(a.v, typename Lanes<Real, N>::Native)), p);
}

template <class Real, int N> inline Real lane(Lanes<Real, N> a, int k) {
  if constexpr (N == 1)
    return a.v;
  else
    return a.v[k];
}

template <class Real, int N> inline void set_lane(Lanes<Real, N>& a, int k, Real value) {
  if constexpr (N == 1)
    a.v = value;
  else
    a.v[k] = value;
}

/// Is every lane a number and not above the bound?
template <class Real, int N> inline bool all_at_most(Lanes<Real, N> a, Real bound) {
  if constexpr (N == 4 && sizeof(Real) == 4)
    return _mm_movemask_ps(_mm_cmp_ps((__m128)a.v, _mm_set1_ps(bound), _CMP_NLE_UQ)) == 0;
  else if constexpr (N == 4)
    return _mm256_movemask_pd(_mm256_cmp_pd((__m256d)a.v, _mm256_set1_pd(bound), _CMP_NLE_UQ)) == 0;
  else {
    bool all = true;
    for (int k = 0; k < N; ++k) all &= lane(a, k) <= bound;
    return all;
  }
}

/// Bit k: is lane k of a below that of b?
template <class Real, int N> inline unsigned less_lanes(Lanes<Real, N> a, Lanes<Real, N> b) {
#if defined(__AVX512F__)
  if constexpr (N == 16)
    return _mm512_cmp_ps_mask((__m512)a.v, (__m512)b.v, _CMP_LT_OQ);
  else if constexpr (N == 8 && sizeof(Real) == 8)
    return _mm512_cmp_pd_mask((__m512d)a.v, (__m512d)b.v, _CMP_LT_OQ);
  else
#endif
      if constexpr (N == 8 && sizeof(Real) == 4)
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps((__m256)a.v, (__m256)b.v, _CMP_LT_OQ)));
  else {
    static_assert(N == 4 && sizeof(Real) == 8);
    return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd((__m256d)a.v, (__m256d)b.v, _CMP_LT_OQ)));
  }
}

/// The largest lane; a lane that is not a number counts as infinite.
template <class Real, int N> inline Real largest(Lanes<Real, N> a) {
  Real most = lane(a, 0);
  for (int k = 0; k < N; ++k) most = lane(a, k) <= most ? most : lane(a, k) == lane(a, k) ? lane(a, k) : INFINITY;
  return most == most ? most : INFINITY;
}
/// Raises `most` to the largest lane. A running maximum seldom rises: one comparison nearly always.
template <class Most, class Real, int N> inline void raise(Most& most, Lanes<Real, N> a) {
  if (!all_at_most(a, static_cast<Real>(most))) most = largest(a);
}

// ---- a cluster pair's lanes -----------------------------------------------------------------------------------------
// I particles i against J particles j fill I × J = N lanes: lane k holds i = k / J and j = k % J.

/// I values from memory, each repeated N / I times. (By hand: g++ 12 makes a gather of the loop, ten times as slow.)
template <int I, class Real, int N> inline Lanes<Real, N> load_i(const Real* p) {
  using V [[maybe_unused]] = typename Lanes<Real, N>::Native;
  if constexpr (N == I) return load<N>(p);
#if defined(__AVX512F__)
  else if constexpr (N == 16 && I == 4)
    return {(V)_mm512_maskz_permutexvar_ps(0xffff, _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3),
                                           _mm512_castps128_ps512(_mm_loadu_ps(p)))};
  else if constexpr (N == 8 && I == 4 && sizeof(Real) == 8)
    return {(V)_mm512_maskz_permutexvar_pd(0xff, _mm512_setr_epi64(0, 0, 1, 1, 2, 2, 3, 3),
                                           _mm512_castpd256_pd512(_mm256_loadu_pd(p)))};
#endif
  else if constexpr (N == 8 && I == 4 && sizeof(Real) == 4)
    return {(V)_mm256_permutevar8x32_ps(_mm256_castps128_ps256(_mm_loadu_ps(p)),
                                        _mm256_setr_epi32(0, 0, 1, 1, 2, 2, 3, 3))};
  else {
    Lanes<Real, N> r;
    for (int k = 0; k < N; ++k) r.v[k] = p[k / (N / I)];
    return r;
  }
}

/// J values from memory, the whole repeated N / J times.
template <int J, class Real, int N> inline Lanes<Real, N> load_j(const Real* p) {
  using L = Lanes<Real, N>;
  if constexpr (J == 1)
    return L(*p);
  else {
    using V = typename L::Native;
#if defined(__AVX512F__)
    if constexpr (sizeof(L) == 64 && sizeof(Real) == 4 && J == 4)
      return {(V)_mm512_maskz_broadcast_f32x4(0xffff, _mm_loadu_ps(p))};
    else if constexpr (sizeof(L) == 64 && sizeof(Real) == 8 && J == 2)
      return {(V)_mm512_maskz_broadcast_f64x2(0xff, _mm_loadu_pd(p))};
    else
#endif
        if constexpr (sizeof(L) == 32 && sizeof(Real) == 4 && J == 2)
      return {(V)_mm256_castpd_ps(_mm256_broadcast_sd(reinterpret_cast<const double*>(p)))};
    else {
      L r;
      for (int k = 0; k < N; ++k) r.v[k] = p[k % J];
      return r;
    }
  }
}

/// Adds up the J lanes of each i, pairwise.
template <int I, class Real, int N> inline Lanes<Real, I> sum_j(Lanes<Real, N> a) {
  constexpr int J = N / I;
  if constexpr (J == 1) return a;
#if defined(__AVX512F__)
  else if constexpr (J == 4 && N == 16) {
    __m512 s = (__m512)a.v;
    s = _mm512_add_ps(s, _mm512_maskz_permute_ps(0xffff, s, 0xB1));
    s = _mm512_add_ps(s, _mm512_maskz_permute_ps(0xffff, s, 0x4E));
    return {(typename Lanes<Real, I>::Native)_mm512_maskz_extractf32x4_ps(0xf, _mm512_maskz_compress_ps(0x1111, s), 0)};
  } else if constexpr (J == 2 && N == 8 && sizeof(Real) == 8) {
    __m512d s = (__m512d)a.v;
    s = _mm512_add_pd(s, _mm512_maskz_permute_pd(0xff, s, 0x55));
    return {(typename Lanes<Real, I>::Native)_mm512_maskz_extractf64x4_pd(0xf, _mm512_maskz_compress_pd(0x55, s), 0)};
  }
#endif
  else if constexpr (J == 2 && N == 8 && sizeof(Real) == 4) {
    const __m256 s = _mm256_add_ps((__m256)a.v, _mm256_movehdup_ps((__m256)a.v));
    return {(typename Lanes<Real, I>::Native)_mm256_castps256_ps128(
        _mm256_permutevar8x32_ps(s, _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6)))};
  } else {
    Lanes<Real, I> sums;
    for (int i = 0; i < I; ++i) {
      Real s = 0;
      for (int j = 0; j < J; ++j) s += a.v[i * J + j];
      sums.v[i] = s;
    }
    return sums;
  }
}

/// The least lanes of four vectors, again and again: lane k has that of a[k % 4].
template <class Real, int N> inline Lanes<Real, N> least_lanes(const std::array<Lanes<Real, N>, 4>& a) {
  using V = typename Lanes<Real, N>::Native;
#if defined(__AVX512F__)
  if constexpr (N == 16) {
    const auto of = [&](int k) { return (__m512)a[k].v; };
    const auto least = [](__m512 x, __m512 y) { return _mm512_maskz_min_ps(0xffff, x, y); };
    // In each block of four lanes: the least of a[0], a[1], a[2], a[3] there; then the least of the blocks.
    const __m512 of_01 =
        least(_mm512_maskz_unpacklo_ps(0xffff, of(0), of(1)), _mm512_maskz_unpackhi_ps(0xffff, of(0), of(1)));
    const __m512 of_23 =
        least(_mm512_maskz_unpacklo_ps(0xffff, of(2), of(3)), _mm512_maskz_unpackhi_ps(0xffff, of(2), of(3)));
    __m512 m =
        least(_mm512_maskz_shuffle_ps(0xffff, of_01, of_23, 0x44), _mm512_maskz_shuffle_ps(0xffff, of_01, of_23, 0xEE));
    m = least(m, _mm512_maskz_shuffle_f32x4(0xffff, m, m, 0x4E));
    return {(V)least(m, _mm512_maskz_shuffle_f32x4(0xffff, m, m, 0xB1))};
  } else if constexpr (N == 8 && sizeof(Real) == 8) {
    const auto of = [&](int k) { return (__m512d)a[k].v; };
    const auto least = [](__m512d x, __m512d y) { return _mm512_maskz_min_pd(0xff, x, y); };
    // Blocks of two lanes: of a[0] and a[1], the same, of a[2] and a[3], the same
    const __m512d of_01 =
        least(_mm512_maskz_unpacklo_pd(0xff, of(0), of(1)), _mm512_maskz_unpackhi_pd(0xff, of(0), of(1)));
    const __m512d of_23 =
        least(_mm512_maskz_unpacklo_pd(0xff, of(2), of(3)), _mm512_maskz_unpackhi_pd(0xff, of(2), of(3)));
    __m512d m = least(_mm512_maskz_shuffle_f64x2(0xff, of_01, of_23, 0x44),
                      _mm512_maskz_shuffle_f64x2(0xff, of_01, of_23, 0xEE));
    m = least(m, _mm512_maskz_shuffle_f64x2(0xff, m, m, 0xB1));
    return {(V)_mm512_maskz_shuffle_f64x2(0xff, m, m, 0x88)};
  } else
#endif
      if constexpr (N == 8 && sizeof(Real) == 4) {
    const auto of = [&](int k) { return (__m256)a[k].v; };
    const __m256 of_01 = _mm256_min_ps(_mm256_unpacklo_ps(of(0), of(1)), _mm256_unpackhi_ps(of(0), of(1)));
    const __m256 of_23 = _mm256_min_ps(_mm256_unpacklo_ps(of(2), of(3)), _mm256_unpackhi_ps(of(2), of(3)));
    const __m256 m = _mm256_min_ps(_mm256_shuffle_ps(of_01, of_23, 0x44), _mm256_shuffle_ps(of_01, of_23, 0xEE));
    return {(V)_mm256_min_ps(m, _mm256_permute2f128_ps(m, m, 0x01))};
  } else {
    static_assert(N == 4 && sizeof(Real) == 8);
    const auto of = [&](int k) { return (__m256d)a[k].v; };
    const __m256d of_01 = _mm256_min_pd(_mm256_unpacklo_pd(of(0), of(1)), _mm256_unpackhi_pd(of(0), of(1)));
    const __m256d of_23 = _mm256_min_pd(_mm256_unpacklo_pd(of(2), of(3)), _mm256_unpackhi_pd(of(2), of(3)));
    return {(V)_mm256_min_pd(_mm256_permute2f128_pd(of_01, of_23, 0x20), _mm256_permute2f128_pd(of_01, of_23, 0x31))};
  }
}

/// Bit k: is a lane of a[k % 4] below bounds[k], k < Bounds?
template <int Bounds, class Real, int N>
inline unsigned any_less_bits(const std::array<Lanes<Real, N>, 4>& a, const std::array<Real, 16>& bounds) {
  static_assert(N % 4 == 0 && Bounds <= 16);
  const Lanes<Real, N> least = least_lanes(a);
  unsigned bits = 0;
  for (int k = 0; k < Bounds; k += N) bits |= less_lanes(least, load<N>(bounds.data() + k)) << k;
  return bits & ((1u << Bounds) - 1);
}

// ---- lists of numbers -----------------------------------------------------------------------------------------------

/// Asks for this memory, or what may follow its end, ahead of time.
template <class T> inline void prefetch(const T* p, std::size_t count) {
  constexpr std::size_t line = 64;  // bytes
  for (std::size_t k = 0; k < count * sizeof(T); k += line) __builtin_prefetch(reinterpret_cast<const char*>(p) + k);
}

/// Which of 8 bits are set, in order; then zeros.
inline __m256i set_bits(unsigned mask) {
#if defined(__AVX512VL__)
  return _mm256_maskz_compress_epi32(static_cast<__mmask8>(mask), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
#else
  const std::uint64_t bytes = _pdep_u64(mask, 0x0101010101010101) * 0xff;
  return _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(_pext_u64(0x0706050403020100, bytes))));
#endif
}

/// Writes first + k for each bit k of the mask, in order, and returns how many; 8 numbers are written over.
inline int write_set_bits(unsigned mask, std::uint32_t first, std::uint32_t* to) {
  const __m256i numbers = _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(first)), set_bits(mask));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), numbers);
  return std::popcount(mask);
}

/// Writes from[k] + by for k < count. Reads and writes up to 16 beyond the last.
inline void copy_more_by(const std::uint32_t* from, std::size_t count, std::uint32_t by, std::uint32_t* to) {
  using Numbers [[gnu::vector_size(64)]] = std::uint32_t;
  for (std::size_t k = 0; k < count; k += 16) {
    Numbers numbers;
    std::memcpy(&numbers, from + k, sizeof numbers);
    numbers += by;
    std::memcpy(to + k, &numbers, sizeof numbers);
  }
}

/// Bit k: is numbers[k] not the one before and 1? Of 16.
inline unsigned breaks(const std::uint32_t* numbers) {
#if defined(__AVX512F__)
  const __m512i following = _mm512_maskz_add_epi32(0xffff, _mm512_loadu_si512(numbers - 1), _mm512_set1_epi32(1));
  return _mm512_cmpneq_epi32_mask(_mm512_loadu_si512(numbers), following);
#else
  unsigned following = 0;
  for (int k = 0; k < 16; k += 8) {
    const __m256i before = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(numbers + k - 1));
    const __m256i same = _mm256_cmpeq_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(numbers + k)),
                                            _mm256_add_epi32(before, _mm256_set1_epi32(1)));
    following |= static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(same))) << k;
  }
  return ~following & 0xffffu;
#endif
}

/// Copies those numbers whose bits are set, less `by`; returns how many. mask_of(w) has the bits of the 16 from 16 w
/// on. Reads and writes up to 16 beyond the last.
template <class MaskOf>
inline std::size_t select_less_by(const std::uint32_t* from, std::size_t words, std::uint32_t by, std::uint32_t* to,
                                  const MaskOf& mask_of) {
  std::size_t count = 0;
  for (std::size_t w = 0; w < words; ++w) {
    unsigned mask = mask_of(w) & 0xffffu;
#if defined(__AVX512F__)
    const __m512i numbers = _mm512_maskz_sub_epi32(0xffff, _mm512_loadu_si512(from + 16 * w),
                                                   _mm512_maskz_set1_epi32(0xffff, static_cast<int>(by)));
    _mm512_storeu_si512(to + count, _mm512_maskz_compress_epi32(static_cast<__mmask16>(mask), numbers));
    count += static_cast<std::size_t>(std::popcount(mask));
#else
    for (int half = 0; half < 2; ++half, mask >>= 8) {
      const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from + 16 * w + 8 * half));
      const __m256i numbers = _mm256_sub_epi32(all, _mm256_set1_epi32(static_cast<int>(by)));
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + count),
                          _mm256_permutevar8x32_epi32(numbers, set_bits(mask & 0xff)));
      count += static_cast<std::size_t>(std::popcount(mask & 0xff));
    }
#endif
  }
  return count;
}

/// Bit k: does flags[k] have this bit? Of 16.
inline std::uint16_t gather_bit(const std::uint16_t* flags, int bit) {
#if defined(__AVX512BW__) && defined(__AVX512VL__)
  return _mm256_test_epi16_mask(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(flags)),
                                _mm256_set1_epi16(static_cast<short>(1 << bit)));
#else
  // The bit becomes the sign, saturation keeps signs, and the halves are put back in order.
  const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(flags));
  const __m256i signs = _mm256_sll_epi16(all, _mm_cvtsi32_si128(15 - bit));
  const __m128i bytes = _mm_packs_epi16(_mm256_castsi256_si128(signs), _mm256_extracti128_si256(signs, 1));
  return static_cast<std::uint16_t>(_mm_movemask_epi8(bytes));
#endif
}

}  // namespace molten
