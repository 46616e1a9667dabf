#include "core/sleep.h"

#include <algorithm>
#include <atomic>

#include "core/particle_pass.h"
#include "core/state.h"
#include "core/step.h"

namespace molten {

void Sleep::archive(Archive& a) {
  a.value("sleep/asleep", asleep);
  a.value("sleep/warm", warm);
  a.value("sleep/taken_energy", taken_energy);
  a.value("sleep/viscosity", viscosity);
  a.value("sleep/travel", travel);
  a.value("sleep/waste", waste);
  a.value("sleep/warm_time", warm_time);
  a.value("sleep/looked", looked);
}

namespace {

using Marks = std::vector<std::uint8_t>;  // by cell

/// The cells that wake and sleep: as wide as a list reaches, over the grid of the last sort of all.
template <int Dim, class Real> class RestCells {
 public:
  explicit RestCells(const State<Dim, Real>& s) : x_(s.particles[position]), grid_(s.neighbours.grid()) {
    double width = s.neighbours.settings().support_radius + s.neighbours.settings().skin;
    // Bounds the marks, a byte a cell, where a few particles are thrown far: wider cells then. A space that is full of
    // fluid needs more only from 90 (2-D: 30) million particles on. The same from one sort of all to the next, as marks
    // of that sort are held against later ones.
    constexpr std::size_t most_cells = 1 << 22;
    do {
      for (int d = 0; d < Dim; ++d) {
        const double length = grid_.cells[d] * grid_.width[d];
        cells_[d] = std::max(1, static_cast<std::int32_t>(length / width));
        width_[d] = length / cells_[d];
      }
      width *= 2;
    } while (size() > most_cells);
  }

  std::size_t size() const {
    std::size_t n = 1;
    for (int d = 0; d < Dim; ++d) n *= static_cast<std::size_t>(cells_[d]);
    return n;
  }

  std::size_t of(std::size_t slot) const {
    std::size_t n = 0;
    for (int d = Dim - 1; d >= 0; --d) {
      const double k = (x_[d][slot] - grid_.lower[d]) / width_[d];
      n = n * cells_[d] + static_cast<std::size_t>(std::clamp(k, 0.0, cells_[d] - 1.0));
    }
    return n;
  }

  /// The middle of a cell (m), and no point of it is further from there.
  Point<Dim> middle(std::size_t cell) const {
    Point<Dim> x;
    for (int d = 0; d < Dim; ++d, cell /= cells_[d - 1])
      x[d] = grid_.lower[d] + (static_cast<double>(cell % cells_[d]) + 0.5) * width_[d];
    return x;
  }
  double reach() const { return Eigen::Map<const Point<Dim>>(width_.data()).norm() / 2; }

  /// The cells of those slots in [begin, end) for which f(slot).
  template <class F> Marks of_slots(std::size_t begin, std::size_t end, const F& f) const {
    Marks marks(size(), 0);
    for_each_slot(end - begin, [&](std::size_t k) {
      if (f(begin + k)) std::atomic_ref(marks[of(begin + k)]).store(1, std::memory_order_relaxed);
    });
    return marks;
  }

  /// Adds the cells next to those marked, across corners too.
  Marks widened(Marks marks) const {
    std::size_t stride = 1;
    for (int d = 0; d < Dim; ++d) {
      marks = widened_along(marks, stride, static_cast<std::size_t>(cells_[d]), grid_.periodic[d]);
      stride *= static_cast<std::size_t>(cells_[d]);
    }
    return marks;
  }

 private:
  /// The same along one direction, in which there are n cells, `stride` apart.
  Marks widened_along(const Marks& marks, std::size_t stride, std::size_t n, bool wraps) const {
    Marks wide(marks);
    // Cells [begin, begin + count) get what those `ahead` of them hold, and the other way round.
    const auto exchange = [from = marks.data(), to = wide.data()](std::size_t begin, std::size_t count,
                                                                  std::size_t ahead) {
      for (std::size_t c = begin; c < begin + count; ++c) to[c] |= from[c + ahead];
      for (std::size_t c = begin; c < begin + count; ++c) to[c + ahead] |= from[c];
    };
    for_each_slot(marks.size() / (n * stride), [&](std::size_t k) {
      const std::size_t begin = k * n * stride, last = (n - 1) * stride;
      exchange(begin, last, stride);
      if (wraps) exchange(begin, stride, last);
    });
    return wide;
  }

  Column<Position, Dim, double> x_;
  const Grid<Dim>& grid_;
  std::array<std::int32_t, Dim> cells_{};
  std::array<double, Dim> width_{};  // m
};

/// Puts one particle to rest: nothing moves or changes, nothing is left of the last step's sums.
template <int Dim, class Real> void lay_down(State<Dim, Real>& s, std::size_t slot) {
  Particles<Dim, Real>& p = s.particles;
  const auto clear = [&]<class F>(F field) {
    if (!p.has(field)) return;
    for (auto* column : p[field].c) column[slot] = 0;
  };
  for_each_field([&]<class F>(F field) {
    if constexpr (F::lifetime == Lifetime::step && !std::is_same_v<F, LocalPosition>) clear(field);
  });
  clear(velocity), clear(half_velocity), clear(previous_compression_rate), clear(older_compression_rate);
  if (p.has(half_compression)) p[half_compression][0][slot] = p[compression][0][slot];
  if (s.features.stress)
    p[viscosity][0][slot] =
        static_cast<Real>(s.parameters.viscosity_at(0.0, s.features.heat ? p[temperature][0][slot] : 0.0));
}

template <int Dim, class Real> double kinetic_energy(const State<Dim, Real>& s, std::size_t slot) {
  double v2 = 0;
  for (int d = 0; d < Dim; ++d) v2 += double(s.particles[velocity][d][slot]) * s.particles[velocity][d][slot];
  return s.parameters.particle_mass * v2 / 2;
}

/// What the sleepers are, all told; of those in slots below `end`.
template <int Dim, class Real> void take_stock(State<Dim, Real>& s, std::size_t end) {
  struct Stock {
    std::int64_t count = 0, warm = 0;
    double energy = 0, viscosity = 0;
  };
  const Particles<Dim, Real>& p = s.particles;
  const std::size_t first_warm = s.neighbours.first_slot(Block::warm);
  const Stock stock = reduce_slots(
      end, Stock{},
      [&](std::size_t slot, Stock& sum) {
        const double energy = kinetic_energy(s, slot);
        lay_down(s, slot);  // padding, too: what a sort leaves there in a step's columns depends on the run's past
        if (p.is_padding(slot)) return;
        ++sum.count;
        sum.warm += slot >= first_warm;
        sum.energy += energy;
        if (s.features.stress)
          sum.viscosity = std::max(sum.viscosity, p[viscosity][0][slot] / (s.parameters.eos.rest_density *
                                                                           (1 + double(p[compression][0][slot]))));
      },
      [](Stock& a, const Stock& b) {
        a.count += b.count;
        a.warm += b.warm;
        a.energy += b.energy;
        a.viscosity = std::max(a.viscosity, b.viscosity);
      });
  s.sleep.asleep = stock.count;
  s.sleep.warm = stock.warm;
  s.sleep.taken_energy += stock.energy;
  s.sleep.viscosity = stock.viscosity;
}

/// Sorts all, those outside the marked cells into the block asleep.
template <int Dim, class Real> void sort_in_blocks(State<Dim, Real>& s, const std::vector<Block>& block_of) {
  const auto scope = s.timer.scope("sort and list");
  s.neighbours.rebuild(s.particles, block_of);
  take_stock(s, s.neighbours.first_slot(Block::active));
  look_for_walls(s);
  prepare(s);
  mark_sleepers(s);
}

/// Is a particle of the marked cells asleep?
bool any_asleep(const Marks& marks, const Marks& asleep) {
  for (std::size_t c = 0; c < asleep.size(); ++c)
    if (marks[c] && asleep[c]) return true;
  return false;
}

}  // namespace

template <int Dim, class Real> void mark_sleepers(State<Dim, Real>& s) {
  const RestCells<Dim, Real> cells(s);
  const auto particle = [&p = s.particles](std::size_t slot) { return !p.is_padding(slot); };
  s.sleep.cold = cells.of_slots(0, s.neighbours.first_slot(Block::warm), particle);
  s.sleep.still = cells.of_slots(0, s.neighbours.first_slot(Block::active), particle);
}

namespace {

/// Which cells must be active or warm, and which a sort would make so: one cell more around them.
struct Calls {
  Marks active, warm, wide_active, wide_warm;
};

/// Marks the cells at bodies that move. A free one would fall through what sleeps, so it counts as moving.
template <int Dim, class Real>
void mark_bodies(const State<Dim, Real>& s, const RestCells<Dim, Real>& cells, Marks& marks) {
  for (std::size_t k = 0; k < s.bodies.count(); ++k) {
    if (!s.bodies.body(k).inertia && s.bodies.speed(k) <= s.parameters.rest->speed) continue;
    const Pose<Dim>& pose = s.bodies.motion(k).start;
    for_each_slot(cells.size(), [&](std::size_t c) {
      if (s.contact.may_touch_body(k, pose, cells.middle(c), cells.reach())) marks[c] = 1;
    });
  }
}

template <int Dim, class Real> Calls find_calls(const State<Dim, Real>& s, const RestCells<Dim, Real>& cells) {
  const Particles<Dim, Real>& p = s.particles;
  const auto after = static_cast<Real>(s.parameters.rest->after);
  const std::size_t first = s.neighbours.first_slot(Block::warm);
  const auto restless = [&](const Real* time) {
    return cells.of_slots(first, p.slots(),
                          [&](std::size_t slot) { return !p.is_padding(slot) && time[slot] < after; });
  };
  Calls calls;
  calls.active = restless(p[rest_time][0]);
  mark_bodies(s, cells, calls.active);
  calls.active = cells.widened(calls.active);
  calls.wide_active = cells.widened(calls.active);
  if (!s.features.heat) return calls;
  calls.warm = cells.widened(restless(p[heat_rest_time][0]));
  calls.wide_warm = cells.widened(calls.warm);
  return calls;
}

/// Where a particle goes at a sort of all.
Block block_for(const Calls& calls, std::size_t cell) {
  if (calls.wide_active[cell]) return Block::active;
  return !calls.wide_warm.empty() && calls.wide_warm[cell] ? Block::warm : Block::asleep;
}

/// How many particles would do with less than they get; heat alone counts for a third of all.
template <int Dim, class Real>
double count_idle(const State<Dim, Real>& s, const RestCells<Dim, Real>& cells, const Calls& calls) {
  const Particles<Dim, Real>& p = s.particles;
  const std::size_t first = s.neighbours.first_slot(Block::warm), first_active = s.neighbours.first_slot(Block::active);
  const std::int64_t thirds = reduce_slots(
      p.slots() - first, std::int64_t{0},
      [&](std::size_t k, std::int64_t& n) {
        if (p.is_padding(first + k)) return;
        const Block now = first + k < first_active ? Block::warm : Block::active;
        const Block then = std::min(now, block_for(calls, cells.of(first + k)));
        constexpr std::array<int, block_count> cost = {0, 1, 3};
        n += cost[static_cast<std::size_t>(now)] - cost[static_cast<std::size_t>(then)];
      },
      [](std::int64_t& a, std::int64_t b) { a += b; });
  return static_cast<double>(thirds) / 3;
}

}  // namespace

template <int Dim, class Real> void wake_and_rest(State<Dim, Real>& s) {
  Sleep& sleep = s.sleep;
  const Particles<Dim, Real>& p = s.particles;
  // A disturbance that was not at a cell at the last look has since crossed half of it at most.
  const bool heat_due = sleep.warm > 0 && sleep.warm_time > conduction_limit(s.parameters) / 2;
  if (sleep.travel < s.parameters.support_radius / 2 && !heat_due) return;
  const auto scope = s.timer.scope("wake and rest");
  sleep.travel = 0;
  if (heat_due) conduct_at_rest(s);
  const RestCells<Dim, Real> cells(s);
  const Calls calls = find_calls(s, cells);
  sleep.waste += count_idle(s, cells, calls) * static_cast<double>(s.clock.step - sleep.looked);
  sleep.looked = s.clock.step;
  const bool calm =
      !any_asleep(calls.active, sleep.still) && (calls.warm.empty() || !any_asleep(calls.warm, sleep.cold));
  if (calm && sleep.waste < static_cast<double>(p.count())) return;
  if (s.features.heat) conduct_at_rest(s);  // for as long as those have waited who now leave the block
  std::vector<Block> block_of(p.slots(), Block::asleep);
  for_each_slot(p.slots(), [&](std::size_t slot) {
    if (!p.is_padding(slot)) block_of[slot] = block_for(calls, cells.of(slot));
  });
  sort_in_blocks(s, block_of);
  sleep.waste = 0;
}

template <int Dim, class Real> void sort_active(State<Dim, Real>& s) {
  const bool in_blocks = s.sleep.asleep > 0;
  if (in_blocks && s.neighbours.covers_active(s.particles)) {
    const auto scope = s.timer.scope("sort and list");
    s.neighbours.rebuild_active(s.particles);
    look_for_walls(s);
    prepare(s, s.neighbours.first_slot(Block::active));
    return;
  }
  std::vector<Block> block_of(s.particles.slots(), Block::active);
  if (in_blocks) {
    std::fill_n(block_of.begin(), s.neighbours.first_slot(Block::active), Block::warm);
    std::fill_n(block_of.begin(), s.neighbours.first_slot(Block::warm), Block::asleep);
  }
  sort_in_blocks(s, block_of);
}

#define MOLTEN_INSTANTIATE(Dim, Real)             \
  template void wake_and_rest(State<Dim, Real>&); \
  template void sort_active(State<Dim, Real>&);   \
  template void mark_sleepers(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
