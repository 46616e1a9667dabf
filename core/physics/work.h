// Internal energy (Monaghan 1992; [Q] 4.8 and [D] 4.7 put right): each pair's force a_ij on i does the work that both
// particles' internal energies share alike, de_i/dt = −½ Σ v_ij·a_ij. For pressure and viscosity that is
// ½ Σ m_j [(p_i/ρ_i² + p_j/ρ_j² + Π_ij) v_ij·∇W − v_ij·(S_i/ρ_i² + S_j/ρ_j²)·∇W]; of any forces it closes the sum of
// kinetic and internal energy to round-off.
#pragma once

#include <tuple>

#include "core/pair_pass.h"

namespace molten {

/// Terms that sum accelerations, and the work that they do.
template <class... Forces> struct WithWork {
  using Reads = typename UnionOf<FieldList<Velocity>, typename Forces::Reads...>::type;
  using Sums = FieldList<Acceleration, InternalEnergyRate>;
  static constexpr bool on = true;
  bool work = false;
  std::tuple<Forces...> forces;

  WithWork(bool work_, const Forces&... forces_) : work(work_), forces(forces_...) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    Values<FieldList<Acceleration>, Pair::dim, L> own;
    pair_pass_detail::clear(own);
    pair_pass_detail::Out<FieldList<Acceleration>, FieldList<Acceleration>, Pair::dim, L> of_pair{own, out.kernel, {}};
    pair_pass_detail::clear(of_pair.radial);
    std::apply([&](const Forces&... force) { ((force.on ? force(ij, i, j, of_pair) : void()), ...); }, forces);
    of_pair.add_radial(FieldList<Acceleration>{}, ij.x);
    out.plain(acceleration, own[acceleration]);
    if (work) out.plain(internal_energy_rate, L(-0.5) * dot(i[velocity] - j[velocity], own[acceleration]));
  }
};

}  // namespace molten
