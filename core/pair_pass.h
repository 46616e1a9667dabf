// The only neighbour loop. A physics term is a small functor that names the fields it reads and the fields it sums, and
// adds its contribution for one pair; terms are fused at compile time into one pass over the cluster pairs. Sums are
// gathered onto i only: no races, the same bits for any number of threads.
//
//   struct Example {
//     using Reads = FieldList<Velocity>;
//     using Sums = FieldList<CompressionRate>;
//     using Radial = FieldList<>;                            // those of Sums to which it adds along x_ij, if any
//     bool on = true;                                        // the same for the whole pass; off adds nothing
//     template <class Pair, class I, class J, class Out>
//     [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
//       out.gradW(compression_rate, dot(i[velocity] - j[velocity], ij.x));   // adds m_j (v_ij · x_ij) W'/r
//     }
//   };
//
// A contribution is always a multiple of m_j W or of m_j ∇W = m_j (W'/r) x_ij, which vanish beyond the support, so
// lanes without a pair add exactly zero.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

#include "core/kernel.h"
#include "core/neighbours.h"
#include "core/particle_pass.h"
#include "core/particles.h"
#include "core/simd.h"

namespace molten {

/// Pair quantities of N lanes.
template <int Dim, class L> struct Pair {
  static constexpr int dim = Dim;
  Vec<Dim, L> x;  // x_i − x_j, m
  L r2;           // |x|², m²; a particle with itself: far below any distance, above 0
};

/// One value for each field of a list.
template <class F, int Dim, class T> struct Slot { value_t<F, Dim, T> value; };
template <class List, int Dim, class T> struct Values;
template <class... F, int Dim, class T> struct Values<FieldList<F...>, Dim, T> : Slot<F, Dim, T>... {
  using List = FieldList<F...>;
  template <class G>
  requires is_among<G, FieldList<F...>> value_t<G, Dim, T>
  &operator[](G) { return Slot<G, Dim, T>::value; }
  template <class G>
  requires is_among<G, FieldList<F...>>
  const value_t<G, Dim, T>& operator[](G) const { return Slot<G, Dim, T>::value; }
};

namespace pair_pass_detail {

/// The columns that a pass reads, fetched once.
template <class List, int Dim, class Real> struct Columns;
template <class... F, int Dim, class Real>
struct Columns<FieldList<F...>, Dim, Real> : Column<F, Dim, stored_t<F, Real>>... {
  explicit Columns(const Particles<Dim, Real>& p) : Column<F, Dim, stored_t<F, Real>>(p[F{}])... {}
  template <class G> const Column<G, Dim, stored_t<G, Real>>& operator[](G) const { return *this; }
};

/// The values of J neighbours from `slot` on, loaded when a term asks for them.
template <int J, class L, int Dim, class Real, class Cols> struct Neighbour {
  const Cols& columns;
  std::size_t slot;

  template <class F> value_t<F, Dim, L> operator[](F) const {
    static_assert(F::storage == Storage::real, "pair arithmetic reads columns of the run's precision");
    value_t<F, Dim, L> v;
    const auto& column = columns[F{}];
    unrolled<components<F, Dim>>(
        [&](auto k) { component(v, k) = load_j<J, Real, sizeof(L) / sizeof(Real)>(column[k] + slot); });
    return v;
  }
};

/// The fields to which a term adds along x_ij; a term without any need not say so.
template <class Term> struct RadialOf { using type = FieldList<>; };
template <class Term>
requires requires { typename Term::Radial; }
struct RadialOf<Term> {
  using type = typename Term::Radial;
};

/// Where the terms add their contributions of one pair. What several terms add along x_ij is joined before it is
/// multiplied.
template <class Sums, class Radial, int Dim, class L> struct Out {
  Values<Sums, Dim, L>& sums;
  const ShapeAndSlope<L>& kernel;
  Values<Radial, Dim, L> radial;  // component 0 only

  /// Adds m_j W'/r · v
  template <class F> [[gnu::always_inline]] void gradW(F, const value_t<F, Dim, L>& v) {
    unrolled<components<F, Dim>>([&](auto k) { component(sums[F{}], k) += kernel.slope * component(v, k); });
  }
  /// Adds m_j ∇W · s to a vector.
  template <class F> [[gnu::always_inline]] void along(F, const L& s) { radial[F{}][0] += s; }
  /// Adds v as it is: for a kernel of the term's own, zero beyond the support.
  template <class F> [[gnu::always_inline]] void plain(F, const value_t<F, Dim, L>& v) {
    unrolled<components<F, Dim>>([&](auto k) { component(sums[F{}], k) += component(v, k); });
  }
  /// Adds m_j W · v
  template <class F> [[gnu::always_inline]] void W(F, const value_t<F, Dim, L>& v) {
    unrolled<components<F, Dim>>([&](auto k) { component(sums[F{}], k) += kernel.w * component(v, k); });
  }

  template <class... F> [[gnu::always_inline]] void add_radial(FieldList<F...>, const Vec<Dim, L>& x) {
    (add_radial(F{}, x), ...);
  }
  template <class F> [[gnu::always_inline]] void add_radial(F, const Vec<Dim, L>& x) {
    const L s = kernel.slope * radial[F{}][0];
    unrolled<Dim>([&](auto d) { sums[F{}][d] += s * x[d]; });
  }
};

template <class... F, int Dim, class L> void clear(Values<FieldList<F...>, Dim, L>& values) {
  (unrolled<components<F, Dim>>([&](auto k) { component(values[F{}], k) = L(0); }), ...);
}

}  // namespace pair_pass_detail

/// A named pass: which lanes it runs on and what it fuses.
///   The callable is called once for every I slots (padding too) with their sums as Values<Sums, Dim, Lanes<Real, I>>,
///   I = 4 or, on one lane, 1.
///   finish.for_chunk(number) gives the callable for one chunk, which may hold that chunk's share of a reduction.
template <int N, int Dim, class Real, class KernelType, class Finish, class... Terms> class PairPass {
  using L = Lanes<Real, N>;
  using Reads = typename UnionOf<FieldList<LocalPosition>, typename Terms::Reads...>::type;
  using Sums = typename UnionOf<typename Terms::Sums...>::type;
  using Radial = typename UnionOf<typename pair_pass_detail::RadialOf<Terms>::type...>::type;
  using AllTerms = std::tuple<Terms...>;
  static constexpr int I = N < cluster_size ? N : cluster_size, J = N / I;
  using Columns = pair_pass_detail::Columns<Reads, Dim, Real>;

 public:
  PairPass(const Neighbours<Dim, Real>& neighbours, const Particles<Dim, Real>& particles, const KernelType& kernel,
           const Finish& finish, const Terms&... terms)
      : neighbours_(neighbours), kernel_(kernel), finish_(finish), terms_(terms...), columns_(particles) {
    const ShiftTable<Dim>& table = neighbours.shifts();
    group_bits_ = table.group_bits;
    group_mask_ = table.group(~ListEntry{0});
    for (const auto& shift : table.shift)
      for (int d = 0; d < Dim; ++d) shifts_.push_back(static_cast<Real>(shift[d]));
  }

  template <class Chunk> void run(std::span<const Chunk> chunks) const {
    for_each_piece(chunks.size(), [&](std::size_t k) { run_chunk(chunks[k], k); });
  }

 private:
  template <class Chunk> void run_chunk(const Chunk& chunk, std::size_t number) const {
    auto finish = finish_.for_chunk(number);
    neighbours_.for_each_list(chunk, [&](std::uint32_t c, std::span<const ListEntry> list) {
      for (int i = 0; i < cluster_size; i += I) sum_up(std::size_t{c} * cluster_size + i, list, finish);
    });
  }

  /// The sums of I particles from `slot` on.
  template <class ChunkFinish>
  __attribute__((flatten, noinline)) void sum_up(std::size_t slot, std::span<const ListEntry> list,
                                                 ChunkFinish& finish) const {
    const auto i = load_own(slot, Reads{});
    Values<Sums, Dim, L> sums;
    pair_pass_detail::clear(sums);
    const AllTerms terms = terms_;
    const KernelType kernel = kernel_;
    const std::size_t count = list.size() * parts;
    const auto at = [&](std::size_t k) __attribute__((always_inline)) {
      return place(i[local_position], kernel, list, k);
    };
    if constexpr (looks_ahead) {
      // One copy of the terms for all pairs: a copy for the last one may round otherwise, and which pair is the last of
      // those that matter depends on when the list was made.
      if (count > 0) {
        Place next = at(0);
        for (std::size_t k = 0; k < count; ++k) {
          const Place now = next;
          next = at(std::min(k + 1, count - 1));
          add_pairs(i, now, kernel, terms, sums);
        }
      }
    } else {
      for (std::size_t k = 0; k < count; ++k) add_pairs(i, at(k), kernel, terms, sums);
    }
    hand_over(slot, sums, finish, Sums{});
  }

  // Where the next pair lies is worked out before the present one's terms, so that its root is there in time: an eighth
  // quicker, as long as all of it fits into the registers; with 16 of them it is slower.
  static constexpr bool looks_ahead =
      vector_registers == 32 && total_components<Reads, Dim> + total_components<Sums, Dim> <= 16;
  static constexpr int parts = group_size<Real> / J;  // of a group: 1 on native lanes

  /// N pairs before the terms see them.
  struct Place {
    Pair<Dim, L> ij;
    L argument;  // of the kernel
    std::size_t slot;
  };

  __attribute__((always_inline)) Place place(const Vec<Dim, L>& own, const KernelType& kernel,
                                             std::span<const ListEntry> list, std::size_t k) const {
    const ListEntry e = list[k / parts];
    const Real* const shift = shifts_.data() + static_cast<std::size_t>(std::uint64_t{e} >> group_bits_) * Dim;
    Place p;
    p.slot = std::size_t{e & group_mask_} * group_size<Real> + k % parts * J;
    const pair_pass_detail::Neighbour<J, L, Dim, Real, Columns> j{columns_, p.slot};
    const Vec<Dim, L> other = j[local_position];
    // Relative to the other's origin first: exact, all are multiples of the grid's quantum.
    unrolled<Dim>([&](auto d) { p.ij.x[d] = own[d] - L(shift[d]) - other[d]; });
    p.ij.r2 = L(std::numeric_limits<Real>::min() * Real(1e8));
    unrolled<Dim>([&](auto d) { p.ij.r2 = p.ij.x[d] * p.ij.x[d] + p.ij.r2; });
    p.argument = kernel.argument(p.ij.r2);
    return p;
  }

  template <class Own>
  __attribute__((always_inline)) void add_pairs(const Own& i, const Place& place, const KernelType& kernel,
                                                const AllTerms& terms, Values<Sums, Dim, L>& sums) const {
    const pair_pass_detail::Neighbour<J, L, Dim, Real, Columns> j{columns_, place.slot};
    const ShapeAndSlope<L> w = kernel.at(place.argument);
    pair_pass_detail::Out<Sums, Radial, Dim, L> out{sums, w, {}};
    pair_pass_detail::clear(out.radial);
    std::apply([&](const Terms&... term) { (add_term(term, place.ij, i, j, out), ...); }, terms);
    out.add_radial(Radial{}, place.ij.x);
  }

  template <class Term, class Own, class Other, class Out>
  __attribute__((always_inline)) static void add_term(const Term& term, const Pair<Dim, L>& ij, const Own& i,
                                                      const Other& j, Out& out) {
    if (term.on) term(ij, i, j, out);
  }

  template <class... F> Values<Reads, Dim, L> load_own(std::size_t slot, FieldList<F...>) const {
    Values<Reads, Dim, L> v;
    const auto load = [&]<class G>(G) {
      unrolled<components<G, Dim>>([&](auto k) {
        const auto* column = columns_[G{}][k];
        component(v[G{}], k) = column ? load_i<I, Real, N>(column + slot) : L(0);
      });
    };
    (load(F{}), ...);
    return v;
  }

  template <class ChunkFinish, class... F>
  static void hand_over(std::size_t slot, const Values<Sums, Dim, L>& sums, ChunkFinish& finish, FieldList<F...>) {
    Values<Sums, Dim, Lanes<Real, I>> of;
    const auto join = [&]<class G>(G) {
      unrolled<components<G, Dim>>([&](auto k) { component(of[G{}], k) = sum_j<I, Real, N>(component(sums[G{}], k)); });
    };
    (join(F{}), ...);
    finish(slot, of);
  }

  const Neighbours<Dim, Real>& neighbours_;
  KernelType kernel_;
  const Finish& finish_;
  AllTerms terms_;
  Columns columns_;
  int group_bits_;
  ListEntry group_mask_;
  std::vector<Real> shifts_;  // Dim for each shift, m
};

/// A term that is on in every run that a pass is compiled for: its flag is not tested.
template <class Term> struct Always : Term {
  static constexpr bool on = true;
  explicit Always(const Term& term) : Term(term) {}
};

/// A term must not read what a term of the same pass sums: such terms belong in different passes.
template <class... Terms>
concept Fusable = disjoint < typename UnionOf<typename Terms::Reads...>::type,
typename UnionOf<typename Terms::Sums...>::type > ;

/// Runs fused terms over the listed pairs of some chunks, whole or partial, on N lanes.
template <int N, class Chunk, int Dim, class Real, class KernelType, class Finish, class... Terms>
requires Fusable<Terms...>
void pair_pass_over(std::span<const Chunk> chunks, const Neighbours<Dim, Real>& neighbours,
                    const Particles<Dim, Real>& particles, const KernelType& kernel, const Finish& finish,
                    const Terms&... terms) {
  PairPass<N, Dim, Real, KernelType, Finish, Terms...>(neighbours, particles, kernel, finish, terms...).run(chunks);
}

/// Runs fused terms over all pairs on N lanes.
template <int N, int Dim, class Real, class KernelType, class Finish, class... Terms>
requires Fusable<Terms...>
void pair_pass(const Neighbours<Dim, Real>& neighbours, const Particles<Dim, Real>& particles, const KernelType& kernel,
               const Finish& finish, const Terms&... terms) {
  pair_pass_over<N>(neighbours.chunks(), neighbours, particles, kernel, finish, terms...);
}

/// A finish particle by particle, without reductions: f(slot, sums as Values<Sums, Dim, Real>).
template <class F> struct PlainFinish {
  F f;

  const PlainFinish& for_chunk(std::size_t) const { return *this; }
  template <class... G, int Dim, class Real, int I>
  void operator()(std::size_t slot, const Values<FieldList<G...>, Dim, Lanes<Real, I>>& sums) const {
    for (int n = 0; n < I; ++n) {
      Values<FieldList<G...>, Dim, Real> own;
      (unrolled<components<G, Dim>>([&](auto k) { component(own[G{}], k) = lane(component(sums[G{}], k), n); }), ...);
      f(slot + n, own);
    }
  }
};
template <class F> PlainFinish(F) -> PlainFinish<F>;

}  // namespace molten
