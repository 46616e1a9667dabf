#include "core/levels.h"

#include <algorithm>
#include <cmath>

#include "core/particle_pass.h"
#include "core/physics/viscous_stress.h"
#include "core/rates_pass.h"

namespace molten {

std::size_t Levels::bytes() const {
  std::size_t sum = of.capacity();
  for (const auto* chunks : {&stiff, &beside})
    for (const PartialChunk& chunk : *chunks) sum += sizeof chunk + chunk.bytes();
  return sum;
}

namespace {

/// The least s that is stable: s² + s at least λ over the step, which is at most how many times as long as the viscous
/// limit the step is (tests/levels_test.cpp).
int stages_for(double limits) { return static_cast<int>(std::ceil((std::sqrt(1 + 4 * limits) - 1) / 2)); }

template <int Dim, class Real> void find_levels(State<Dim, Real>& s) {
  const Particles<Dim, Real>& p = s.particles;
  const Real *const eta = p[viscosity][0], *const delta = p[compression][0];
  const double stable = viscous_limit(s, s.clock.dt) * (1 + 1e-6);  // m²/s; for which the step is, but for rounding
  s.levels.of.resize(s.neighbours.clusters());
  using Counts = std::array<std::int64_t, most_levels + 1>;
  s.levels.particles = reduce_slots(
      s.neighbours.clusters(), Counts{},
      [&](std::size_t c, Counts& counts) {
        double largest = 0;
        std::int64_t count = 0;
        for (std::size_t slot = c * cluster_size; slot < (c + 1) * cluster_size; ++slot) {
          if (p.is_padding(slot)) continue;
          largest = std::max(largest, eta[slot] / (s.parameters.eos.rest_density * (1 + double(delta[slot]))));
          ++count;
        }
        int level = 0;
        while (level < most_levels && largest > std::ldexp(stable, level)) ++level;
        s.levels.of[c] = static_cast<std::uint8_t>(level);
        counts[static_cast<std::size_t>(level)] += count;
      },
      [](Counts& a, const Counts& b) {
        for (std::size_t k = 0; k < a.size(); ++k) a[k] += b[k];
      });
}

/// The pairs with a cluster above level 0, from the lists of all.
template <int Dim, class Real> void list_stiff_pairs(State<Dim, Real>& s) {
  const std::span<const ClusterChunk> chunks = s.neighbours.chunks();
  const ShiftTable<Dim>& shifts = s.neighbours.shifts();
  Levels& levels = s.levels;
  levels.stiff.resize(chunks.size());
  levels.beside.resize(chunks.size());
  for_each_piece(chunks.size(), [&](std::size_t k) {
    levels.stiff[k].clear(), levels.beside[k].clear();
    s.neighbours.for_each_list(chunks[k], [&](std::uint32_t cluster, std::span<const ListEntry> list) {
      PartialChunk& to = levels.of[cluster] > 0 ? levels.stiff[k] : levels.beside[k];
      const auto first = static_cast<std::uint32_t>(to.entries.size());
      if (levels.of[cluster] > 0)
        to.entries.insert(to.entries.end(), list.begin(), list.end());
      else
        std::copy_if(list.begin(), list.end(), std::back_inserter(to.entries),
                     [&](ListEntry e) { return levels.of[shifts.cluster(e)] > 0; });
      const auto end = static_cast<std::uint32_t>(to.entries.size());
      if (end > first) to.rows.push_back({cluster, first, end});
    });
  });
}

/// What becomes of the sums of forces: f(the first of some slots, their accelerations in lanes).
template <class F> struct ForceFinish {
  F f;

  const ForceFinish& for_chunk(std::size_t) const { return *this; }
  template <class Sums> void operator()(std::size_t slot, const Sums& sums) const { f(slot, sums[acceleration]); }
};
template <class F> ForceFinish(F) -> ForceFinish<F>;

/// The stages of one step, over the pairs that are listed for them.
template <int Dim, class Real> class Stages {
  using Wide = Lanes<Real, cluster_size>;
  using Columns = std::array<Real*, Dim>;

 public:
  /// For a step of so many times the viscous limit.
  Stages(State<Dim, Real>& s, double limits)
      : s_(s),
        p_(s.particles),
        leap_frog_(s.features.integrator == IntegratorKind::leap_frog),
        count_(stages_for(limits)),
        time_(kick_time(s)),
        weight_(2 / (count_ * (count_ + 1.0))),
        held_(static_cast<Real>(1 / (1 + limits))),
        force_(StressForce<Dim, Real>(true, s.parameters.eos.rest_density, s.parameters.kernel_second_moment)) {}

  void take() {
    begin();
    for (int j = 1; j <= count_; ++j) {
      // Leap-frog: the forces at the start are of another velocity than the one that the stages start from.
      if (j > 1 || leap_frog_) {
        find_stresses();
        add_forces(j);
      }
      if (j < count_) set_velocities(j * (j + 1) * weight_ / 2);
    }
    finish();
  }

 private:
  void begin() const {
    sum_forces([to = at_start_](std::size_t slot, const auto& a) {
      for (int d = 0; d < Dim; ++d) store(a[d], to[d] + slot);
    });
    for_each_cluster([this](std::size_t slot) {
      for (int d = 0; d < Dim; ++d) {
        store(Wide(0), change_[d] + slot);
        store(Wide(0), earlier_[d] + slot);
        const Wide v = load<cluster_size>((leap_frog_ ? start_ : velocity_)[d] + slot);
        store(v, (leap_frog_ ? velocity_ : start_)[d] + slot);
      }
    });
  }

  /// The stresses of the stiff clusters at the stage's velocities.
  void find_stresses() const {
    const auto finish =
        PlainFinish{[rho0 = static_cast<Real>(s_.parameters.eos.rest_density), to = p_[stress], eta = p_[viscosity][0],
                     delta = p_[compression][0]](std::size_t slot, const auto& sums) {
          to.set(slot, stress_term(eta[slot], rho0 * (1 + delta[slot]), (Real(1) / rho0) * sums[strain_rate]));
        }};
    over_pairs(s_.levels.stiff, finish, StrainRateTerm{});
  }

  /// The change that stage j makes, in place of that two stages before.
  void add_forces(int j) {
    const double mu = (2.0 * j - 1) / j;
    sum_forces([own = static_cast<Real>(mu), other = static_cast<Real>(1 - mu),
                force = static_cast<Real>(mu * weight_ * time_), change = change_, to = earlier_,
                at_start = at_start_](std::size_t slot, const auto& a) {
      using L = std::decay_t<decltype(a[0])>;
      constexpr int I = sizeof(L) / sizeof(Real);
      for (int d = 0; d < Dim; ++d)
        store(L(own) * load<I>(change[d] + slot) + L(other) * load<I>(to[d] + slot) +
                  L(force) * (a[d] - load<I>(at_start[d] + slot)),
              to[d] + slot);
    });
    std::swap(change_, earlier_);
  }

  /// Those of a stage that ends at a share of the time.
  void set_velocities(double share) const {
    const Wide time(static_cast<Real>(share * time_));
    for_each_cluster([&](std::size_t slot) {
      const Wide moving = lanes([&](std::size_t k) { return is_driven(k) || is_stuck(k) ? Real(0) : Real(1); }, slot);
      for (int d = 0; d < Dim; ++d) {
        const Wide kick = time * load<cluster_size>(acceleration_[d] + slot) + load<cluster_size>(change_[d] + slot);
        store(load<cluster_size>(start_[d] + slot) + moving * kick, velocity_[d] + slot);
      }
    });
  }

  /// A vent moves what is in it at its own speed.
  bool is_driven(std::size_t slot) const { return inlet_ && inlet_[slot] >= 0; }

  /// A wall has stopped the particle in the last step, and holds it throughout this one: else the fluid beside it would
  /// carry it along between two contacts, and feel the less of the wall the longer the step.
  bool is_stuck(std::size_t slot) const {
    if (!s_.features.contact || s_.clock.step == 0) return false;
    if (!s_.free_way.within(FreeWay::part_of(FreeWay::longest), slot)) return false;  // at rest elsewhere
    return std::all_of(start_.begin(), start_.end(), [slot](const Real* v) { return v[slot] == 0; });
  }
  bool is_changed(std::size_t slot) const {
    return std::any_of(change_.begin(), change_.end(), [slot](const Real* v) { return v[slot] != 0; });
  }

  template <class F> static Wide lanes(const F& f, std::size_t slot) {
    Wide all;
    for (int n = 0; n < cluster_size; ++n) set_lane(all, n, f(slot + n));
    return all;
  }

  /// The mean acceleration; the velocity is again that of before. What was held has felt forces that its own motion
  /// would have damped: it gets what is left of them. Nothing stays behind: whether a cluster takes part to no effect
  /// depends on the list's age.
  void finish() const {
    const Wide rate(static_cast<Real>(1 / time_));
    for_each_cluster([&](std::size_t slot) {
      const Wide share = lanes([&](std::size_t k) { return is_stuck(k) && is_changed(k) ? held_ : Real(1); }, slot);
      for (int d = 0; d < Dim; ++d) {
        Real* const a = acceleration_[d] + slot;
        store(share * (load<cluster_size>(a) + rate * load<cluster_size>(change_[d] + slot)), a);
        store(load<cluster_size>(start_[d] + slot), velocity_[d] + slot);
        for (Real* column : {at_start_[d], change_[d], earlier_[d]}) store(Wide(0), column + slot);
        if (!leap_frog_) store(Wide(0), start_[d] + slot);
      }
    });
  }

  /// f(first slot) for all clusters that take part.
  template <class F> void for_each_cluster(const F& f) const {
    for (const auto* chunks : {&s_.levels.stiff, &s_.levels.beside})
      for_each_piece(chunks->size(), [&](std::size_t k) {
        for (const PartialChunk::Row& row : (*chunks)[k].rows) f(std::size_t{row.cluster} * cluster_size);
      });
  }

  template <class F> void sum_forces(const F& f) const {
    over_pairs(s_.levels.stiff, ForceFinish{f}, force_);
    over_pairs(s_.levels.beside, ForceFinish{f}, force_);
  }

  template <class Finish, class Term>
  void over_pairs(const std::vector<PartialChunk>& chunks, const Finish& finish, const Term& term) const {
    with_run_kernel(s_, [&](const auto& kernel) {
      pair_pass_over<native_lanes<Real>>(std::span(chunks), s_.neighbours, p_, kernel, finish, term);
    });
  }

  State<Dim, Real>& s_;
  Particles<Dim, Real>& p_;
  bool leap_frog_;
  int count_;
  double time_;    // s
  double weight_;  // w
  Real held_;      // what is left of the forces on particles that walls hold
  Always<StressForce<Dim, Real>> force_;
  Columns velocity_ = p_[velocity].c, acceleration_ = p_[acceleration].c, at_start_ = p_[stiff_acceleration].c;
  Columns start_ = leap_frog_ ? p_[half_velocity].c : p_[start_velocity].c;
  Columns change_ = p_[stage_change].c, earlier_ = p_[earlier_change].c;
  const std::int64_t* inlet_ = p_[inlet][0];  // null without vents
};

/// The bound on a particle's way counts the mean accelerations.
template <int Dim, class Real> double largest_acceleration2(const State<Dim, Real>& s) {
  using L = Lanes<Real, cluster_size>;
  const auto a = s.particles[acceleration];
  return reduce_slots(
      s.neighbours.clusters(), 0.0,
      [&](std::size_t c, double& all) {
        L a2(0);
        for (int d = 0; d < Dim; ++d) {
          const L own = load<cluster_size>(a[d] + c * cluster_size);
          a2 += own * own;
        }
        raise(all, a2);
      },
      [](double& x, double y) { x = std::max(x, y); });
}

}  // namespace

template <int Dim, class Real> void take_stages(State<Dim, Real>& s) {
  const double stable = viscous_limit(s, s.extremes.kinematic_viscosity);
  const double limits = kick_time(s) / stable;
  s.levels.stages = s.clock.dt <= stable ? 0 : stages_for(limits);
  if (s.levels.stages == 0) {
    s.levels.particles = {static_cast<std::int64_t>(s.particles.count())};
    return;
  }
  const auto scope = s.timer.scope("stages");
  find_levels(s);
  list_stiff_pairs(s);
  Stages<Dim, Real>(s, limits).take();
  s.extremes.acceleration2 = largest_acceleration2(s);
}

#define MOLTEN_INSTANTIATE(Dim, Real) template void take_stages(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
