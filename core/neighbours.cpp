#include "core/neighbours.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>

#include "core/particle_pass.h"
#include "core/simd.h"

namespace molten {

namespace {

constexpr int segment_columns = 4;  // a segment is about this many column widths long
constexpr double far_away = 1e5;    // spacings; where padding slots sit
constexpr std::uint32_t nowhere = ~0u;

/// Width of a column in spacings. Where layers of fluid are still to be told apart, 2 × 2 particles of one are a
/// cluster: flat, so fewer clusters meet (3-D: 12.1 a particle in a jittered lattice, 13.6 with cubes of 4); where none
/// are, about as many meet.
constexpr double column_width = 2.0;

/// f(pile, begin, end) for the stretches of slots that are of one pile, in parallel: long ones, once particles are
/// sorted.
template <class F> void for_each_stretch(std::span<const std::uint32_t> pile_of, const F& f) {
  for_each_piece((pile_of.size() + block_size - 1) / block_size, [&](std::size_t block) {
    const std::size_t end = std::min(pile_of.size(), (block + 1) * block_size);
    for (std::size_t k = block * block_size, next; k < end; k = next) {
      for (next = k + 1; next < end && pile_of[next] == pile_of[k];) ++next;
      if (pile_of[k] != nowhere) f(pile_of[k], k, next);
    }
  });
}

/// Adds to a number that several threads count in; returns what it was.
std::uint32_t count_in(std::uint32_t& number, std::size_t by) {
  return std::atomic_ref(number).fetch_add(static_cast<std::uint32_t>(by), std::memory_order_relaxed);
}

/// Sorts what was sorted some steps ago: few have changed places since, so each is put in among those before it. Where
/// that takes many moves it is no such case.
template <class It, class Before> void sort_again(It begin, It end, const Before& before) {
  std::ptrdiff_t moves = 8 * (end - begin);
  for (It k = begin; k != end; ++k) {
    const auto entry = *k;
    It to = k;
    for (; to != begin && before(entry, to[-1]); --to) *to = to[-1];
    *to = entry;
    if ((moves -= k - to) < 0) return std::sort(begin, end, before);
  }
}

}  // namespace

template <int Dim, class Real>
Neighbours<Dim, Real>::Neighbours(const NeighbourSettings& settings, const Domain<Dim>& domain)
    : settings_(settings), domain_(domain), list_(settings) {
  for (int d = 0; d < Dim; ++d) order_.grid.periodic[d] = domain.periodic.along(d);
}

template <int Dim, class Real> void Neighbours<Dim, Real>::rebuild(Particles<Dim, Real>& particles) {
  choose_grid(particles, {});
  order_.pile_begin.assign(order_.grid.columns() + 1, 0);
  sort(particles, 0, {});
  list_.make(order_, particles, 0);
  displacement_ = 0;
}

template <int Dim, class Real>
void Neighbours<Dim, Real>::rebuild(Particles<Dim, Real>& particles, std::span<const Block> block_of) {
  Cell<Dim> margin;
  margin.fill(2 * segment_columns);
  margin[Grid<Dim>::along] = 2;
  choose_grid(particles, margin);
  order_.pile_begin.assign(block_count * order_.grid.columns() + 1, 0);
  sort(particles, 0, block_of);
  list_.make(order_, particles, 0);
  displacement_ = 0;
}

template <int Dim, class Real> void Neighbours<Dim, Real>::rebuild_active(Particles<Dim, Real>& particles) {
  const std::size_t first_cluster = first_slot(Block::active) / cluster_size;
  sort(particles, order_.piles() - order_.grid.columns(), {});
  list_.make(order_, particles, first_cluster);
  displacement_ = 0;
}

template <int Dim, class Real> bool Neighbours<Dim, Real>::covers_active(const Particles<Dim, Real>& particles) const {
  const std::size_t first = first_slot(Block::active);
  const auto x = particles[position];
  return reduce_slots(
      particles.slots() - first, true,
      [&](std::size_t k, bool& all) {
        if (particles.is_padding(first + k)) return;
        for (int d = 0; d < Dim; ++d) {
          const double upper = order_.grid.lower[d] + order_.grid.cells[d] * order_.grid.width[d];
          all &= order_.grid.periodic[d] || (x[d][first + k] >= order_.grid.lower[d] && x[d][first + k] < upper);
        }
      },
      [](bool& all, bool block) { all &= block; });
}

template <int Dim, class Real> void Neighbours<Dim, Real>::relist(Particles<Dim, Real>& particles) {
  list_.make(order_, particles, 0);
}

// ---- the grid -------------------------------------------------------------------------------------------------------

template <int Dim, class Real>
void Neighbours<Dim, Real>::choose_grid(const Particles<Dim, Real>& particles, const Cell<Dim>& margin) {
  struct Extent {
    std::array<double, Dim> lower, upper;
  };
  Extent none;
  none.lower.fill(std::numeric_limits<double>::max());
  none.upper.fill(std::numeric_limits<double>::lowest());
  const auto x = particles[position];
  const auto join = [](Extent& a, const Extent& b) {
    for (int d = 0; d < Dim; ++d) {
      a.lower[d] = std::min(a.lower[d], b.lower[d]);
      a.upper[d] = std::max(a.upper[d], b.upper[d]);
    }
  };
  Extent extent = reduce_slots(
      particles.slots(), none,
      [&](std::size_t s, Extent& e) {
        if (particles.is_padding(s)) return;
        Extent own;
        for (int d = 0; d < Dim; ++d)
          own.lower[d] = own.upper[d] = std::clamp(x[d][s], domain_.lower[d], domain_.upper[d]);
        join(e, own);
      },
      join);
  if (extent.lower[0] > extent.upper[0]) extent.lower = extent.upper = domain_.lower;  // no particles

  // A quantum that divides every width, so that cells' origins lie on it: a power of two far below the spacing.
  const double unit = std::exp2(std::floor(std::log2(settings_.spacing)) - 12);
  const double across = std::ceil(column_width * settings_.spacing / unit) * unit;
  for (int d = 0; d < Dim; ++d) {
    const double wanted = d == Grid<Dim>::along ? segment_columns * across : across;
    if (order_.grid.periodic[d]) {
      order_.grid.lower[d] = domain_.periodic.lower[d];
      order_.grid.cells[d] = std::max(1, static_cast<std::int32_t>(domain_.periodic.period[d] / wanted));
      order_.grid.width[d] = domain_.periodic.period[d] / order_.grid.cells[d];
    } else {
      order_.grid.width[d] = wanted;
      order_.grid.lower[d] = (std::floor(extent.lower[d] / wanted) - margin[d]) * wanted;
      order_.grid.cells[d] =
          static_cast<std::int32_t>((extent.upper[d] - order_.grid.lower[d]) / wanted) + 1 + margin[d];
    }
  }
  // A few particles thrown far must not make the table of columns larger than the particles: wider columns then.
  const double most_columns = 65536 + 8.0 * static_cast<double>(particles.count());
  while (static_cast<double>(order_.grid.columns()) > most_columns) {
    bool widened = false;
    for (int d = 0; d < Grid<Dim>::along; ++d) {
      if (order_.grid.cells[d] <= 1) continue;
      order_.grid.cells[d] = (order_.grid.cells[d] + 1) / 2;
      order_.grid.width[d] =
          order_.grid.periodic[d] ? domain_.periodic.period[d] / order_.grid.cells[d] : 2 * order_.grid.width[d];
      widened = true;
    }
    if (!widened) break;
  }
  choose_quantum();
}

template <int Dim, class Real> void Neighbours<Dim, Real>::choose_quantum() {
  // The largest coordinate that a pair within the support can have relative to either origin.
  const double reach = settings_.support_radius + 2 * settings_.skin + longest_cluster * settings_.spacing;
  double largest = 0;
  for (int d = 0; d < Dim; ++d) largest = std::max(largest, 0.5 * order_.grid.width[d] + reach);
  const int digits = std::numeric_limits<Real>::digits;
  // Not finer than double positions resolve.
  order_.grid.quantum = std::exp2(std::ceil(std::log2(largest)) - std::min(digits, 44));
}

template <int Dim, class Real>
void Neighbours<Dim, Real>::localise(Particles<Dim, Real>& particles, std::size_t cluster) const {
  using Wide = Lanes<double, cluster_size>;
  const auto local = particles[local_position];
  const auto x = particles[position];
  const std::size_t slot = cluster * cluster_size;
  const Cell<Dim>& c = order_.cells[cluster];
  for (int d = 0; d < Dim; ++d) {
    const Wide from_origin = load<cluster_size>(x[d] + slot) - Wide(order_.grid.origin(d, c[d]));
    store_rounded(order_.grid.on_quantum(from_origin), local[d] + slot);
  }
  for (std::size_t k = slot; k < slot + cluster_size; ++k)
    if (particles.is_padding(k))
      for (int d = 0; d < Dim; ++d) local[d][k] = static_cast<Real>(far_away * settings_.spacing);
}

// ---- order ----------------------------------------------------------------------------------------------------------

/// Sorts the particles of the piles from first_pile on, and drops those of them that are outside the domain.
template <int Dim, class Real>
void Neighbours<Dim, Real>::sort(Particles<Dim, Real>& particles, std::size_t first_pile,
                                 std::span<const Block> block_of) {
  const auto x = particles[position];
  const std::size_t first = order_.pile_begin[first_pile] * std::size_t{cluster_size};
  for_each_slot(particles.slots() - first, [&](std::size_t k) {
    for (int d = 0; d < Dim; ++d) x[d][first + k] = domain_.periodic.wrapped(d, x[d][first + k]);
  });
  const std::size_t outside = sort_columns(particles, first_pile, block_of);
  dropped_ += outside;
  const std::unique_ptr<std::int32_t[]> order = cluster_order(first_pile);
  const std::size_t first_cluster = first / cluster_size, clusters = order_.clusters() - first_cluster;
  particles.permute({order.get(), clusters * cluster_size}, particles.count() - outside, first);
  for_each_slot(clusters, [&](std::size_t k) { localise(particles, first_cluster + k); });
}

/// Which pile a slot's particle belongs to; nowhere outside the domain, and for padding.
template <int Dim, class Real>
std::uint32_t Neighbours<Dim, Real>::pile_of(const Particles<Dim, Real>& particles, std::size_t slot,
                                             std::size_t block) const {
  if (particles.is_padding(slot)) return nowhere;
  const auto x = particles[position];
  Cell<Dim> c{};
  for (int d = 0; d < Dim; ++d) {
    if (!order_.grid.periodic[d] && !(x[d][slot] >= domain_.lower[d] && x[d][slot] <= domain_.upper[d])) return nowhere;
    if (d < Grid<Dim>::along) c[d] = order_.grid.index(d, x[d][slot]);
  }
  return static_cast<std::uint32_t>(block * order_.grid.columns() + order_.grid.column(c));
}

/// Fills entries_ pile by pile, each sorted along the column; ties by id, so that the order depends on state alone.
/// Returns how many particles are outside the domain.
template <int Dim, class Real>
std::size_t Neighbours<Dim, Real>::sort_columns(Particles<Dim, Real>& particles, std::size_t first_pile,
                                                std::span<const Block> block_of) {
  const std::size_t columns = order_.piles() - first_pile,
                    first = order_.pile_begin[first_pile] * std::size_t{cluster_size};
  const std::size_t slots = particles.slots() - first;
  const auto x = particles[position];
  const auto ids = particles[id][0];
  const auto memory = std::make_unique_for_overwrite<std::uint32_t[]>(slots);
  const std::span<std::uint32_t> column_of(memory.get(), slots);
  std::vector<std::uint32_t> next(columns + 1, 0);
  const std::size_t outside = reduce_slots(
      slots, std::size_t{0},
      [&](std::size_t k, std::size_t& count) {
        const std::size_t s = first + k;
        column_of[k] = pile_of(particles, s, block_of.empty() ? 0 : static_cast<std::size_t>(block_of[s]));
        count += column_of[k] == nowhere && ids[s] != padding_id;
      },
      [](std::size_t& a, std::size_t b) { a += b; });
  for_each_stretch(column_of,
                   [&](std::uint32_t c, std::size_t begin, std::size_t end) { count_in(next[c + 1], end - begin); });
  for (std::size_t c = 0; c < columns; ++c) next[c + 1] += next[c];
  entry_begin_.assign(next.begin(), next.end());
  const std::size_t entries = next[columns];
  entries_ = {static_cast<Entry*>(particles.scratch(entries * sizeof(Entry))), entries};
  for_each_stretch(column_of, [&](std::uint32_t c, std::size_t begin, std::size_t end) {
    Entry* to = &entries_[count_in(next[c], end - begin)];
    for (std::size_t s = first + begin; s < first + end; ++s)
      *to++ = {static_cast<float>(x[Dim - 1][s] - order_.grid.lower[Dim - 1]), static_cast<std::int32_t>(s)};
  });
  const auto before = [ids](const Entry& a, const Entry& b) {
    return a.along != b.along ? a.along < b.along : ids[a.slot] < ids[b.slot];
  };
  for_each_piece((columns + 63) / 64, [&](std::size_t group) {
    for (std::size_t c = group * 64; c < std::min(columns, (group + 1) * 64); ++c)
      sort_again(entries_.begin() + entry_begin_[c], entries_.begin() + entry_begin_[c + 1], before);
  });
  return outside;
}

/// Cuts the sorted piles into clusters; gives their order_.cells and order_.pile_begin, and for every new slot its old
/// one.
template <int Dim, class Real>
std::unique_ptr<std::int32_t[]> Neighbours<Dim, Real>::cluster_order(std::size_t first_pile) {
  const std::size_t columns = order_.piles() - first_pile;
  const float longest = static_cast<float>(longest_cluster * settings_.spacing);
  const auto cluster_end = [&](std::uint32_t begin, std::uint32_t end) {
    std::uint32_t k = begin + 1;
    while (k < end && k < begin + cluster_size && entries_[k].along - entries_[begin].along <= longest) ++k;
    return k;
  };
  std::uint32_t* const cluster_begin = order_.pile_begin.data() + first_pile;
  std::fill_n(cluster_begin + 1, columns, 0);
  for_each_piece((columns + 63) / 64, [&](std::size_t group) {
    for (std::size_t c = group * 64; c < std::min(columns, (group + 1) * 64); ++c)
      for (std::uint32_t k = entry_begin_[c]; k < entry_begin_[c + 1]; k = cluster_end(k, entry_begin_[c + 1]))
        ++cluster_begin[c + 1];
  });
  for (std::size_t c = 0; c < columns; ++c) cluster_begin[c + 1] += cluster_begin[c];
  const std::uint32_t first = cluster_begin[0], end = cluster_begin[columns];
  order_.cells.resize(end);
  auto order = std::make_unique_for_overwrite<std::int32_t[]>(std::size_t{end - first} * cluster_size);
  for_each_piece((columns + 63) / 64, [&](std::size_t group) {
    for (std::size_t c = group * 64; c < std::min(columns, (group + 1) * 64); ++c) {
      Cell<Dim> cell{};
      order_.grid.place(c % order_.grid.columns(), cell);
      std::uint32_t cluster = cluster_begin[c];
      for (std::uint32_t k = entry_begin_[c]; k < entry_begin_[c + 1]; ++cluster) {
        const std::uint32_t next = cluster_end(k, entry_begin_[c + 1]);
        cell[Dim - 1] = order_.grid.index(Dim - 1, order_.grid.lower[Dim - 1] + entries_[k].along);
        order_.cells[cluster] = cell;
        std::int32_t* const slots = &order[std::size_t{cluster - first} * cluster_size];
        for (int i = 0; i < cluster_size; ++i) slots[i] = k < next ? entries_[k++].slot : -1;
      }
    }
  });
  return order;
}

template <int Dim, class Real> std::size_t Neighbours<Dim, Real>::bytes() const {
  return bytes_of(order_.cells) + bytes_of(order_.pile_begin) + bytes_of(entry_begin_) + list_.bytes();
}

template <int Dim, class Real> void Neighbours<Dim, Real>::archive(Archive& a) {
  a.value("neighbours/displacement", displacement_);
  auto dropped = static_cast<std::int64_t>(dropped_);
  a.value("neighbours/dropped", dropped);
  dropped_ = static_cast<std::size_t>(dropped);
  a.value("grid/quantum", order_.grid.quantum);
  a.array("grid/lower", NumberType::f64, order_.grid.lower.data(), Dim);
  a.array("grid/width", NumberType::f64, order_.grid.width.data(), Dim);
  a.array("grid/cells", NumberType::i32, order_.grid.cells.data(), Dim);
  a.vector("grid/column_begin", order_.pile_begin);
  std::vector<std::int32_t> flat;
  if (!a.loading())
    for (const Cell<Dim>& c : order_.cells) flat.insert(flat.end(), c.begin(), c.end());
  a.vector("grid/cluster_cells", flat);
  if (a.loading()) {
    order_.cells.resize(flat.size() / Dim);
    for (std::size_t k = 0; k < flat.size(); ++k) order_.cells[k / Dim][k % Dim] = flat[k];
  }
}

template <int Dim, class Real>
std::vector<std::pair<std::uint32_t, std::uint32_t>> naive_pairs(const Particles<Dim, Real>& particles,
                                                                 const Periodicity<Dim>& periodic,
                                                                 double support_radius) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  const auto x = particles[position];
  for (std::uint32_t i = 0; i < particles.slots(); ++i)
    for (std::uint32_t j = 0; j < particles.slots(); ++j) {
      if (i == j || particles.is_padding(i) || particles.is_padding(j)) continue;
      double r2 = 0;
      for (int d = 0; d < Dim; ++d) {
        double dx = x[d][i] - x[d][j];
        if (periodic.along(d)) dx -= periodic.period[d] * std::round(dx / periodic.period[d]);
        r2 += dx * dx;
      }
      if (r2 < support_radius * support_radius) pairs.emplace_back(i, j);
    }
  return pairs;
}

#define MOLTEN_INSTANTIATE(Dim, Real)                                                                    \
  template class Neighbours<Dim, Real>;                                                                  \
  template std::vector<std::pair<std::uint32_t, std::uint32_t>> naive_pairs(const Particles<Dim, Real>&, \
                                                                            const Periodicity<Dim>&, double);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
