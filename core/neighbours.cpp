#include "core/neighbours.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/particle_pass.h"
#include "core/simd.h"

namespace molten {

namespace {

constexpr std::uint32_t clusters_a_chunk = 128;
constexpr int segment_columns = 4;       // a segment is about this many column widths long
constexpr double longest_cluster = 4.0;  // spacings; a sparser cluster ends early, so that local positions stay small
constexpr int boxes_at_once = 8;         // in the search for neighbours
constexpr double far_away = 1e5;         // spacings; where padding slots sit

/// Width of a column in spacings: a cluster of 4 then is about as long as it is wide.
template <int Dim> constexpr double column_width = Dim == 2 ? 2.0 : 1.5874;

template <class T> std::size_t bytes_of(const std::vector<T>& v) { return v.capacity() * sizeof(T); }

}  // namespace

template <int Dim, class Real>
Neighbours<Dim, Real>::Neighbours(const NeighbourSettings& settings, const Domain<Dim>& domain)
    : settings_(settings), domain_(domain) {
  for (int d = 0; d < Dim; ++d) grid_.periodic[d] = domain.periodic.along(d);
}

template <int Dim, class Real> void Neighbours<Dim, Real>::rebuild(Particles<Dim, Real>& particles) {
  choose_grid(particles, {});
  column_begin_.assign(grid_.columns() + 1, 0);
  sort(particles, 0, {});
  find_boxes(particles, 0);
  list_neighbours(particles);
  displacement_ = 0;
}

template <int Dim, class Real>
void Neighbours<Dim, Real>::rebuild(Particles<Dim, Real>& particles, std::span<const Block> block_of) {
  Cell<Dim> margin;
  margin.fill(2 * segment_columns);
  margin[Grid<Dim>::along] = 2;
  choose_grid(particles, margin);
  column_begin_.assign(block_count * grid_.columns() + 1, 0);
  sort(particles, 0, block_of);
  find_boxes(particles, 0);
  list_neighbours(particles);
  displacement_ = 0;
}

template <int Dim, class Real> void Neighbours<Dim, Real>::rebuild_active(Particles<Dim, Real>& particles) {
  const std::size_t first_cluster = first_slot(Block::active) / cluster_size;
  sort(particles, piles() - grid_.columns(), {});
  find_boxes(particles, first_cluster);
  list_neighbours(particles);
  displacement_ = 0;
}

template <int Dim, class Real> std::size_t Neighbours<Dim, Real>::first_slot(Block block) const {
  const std::size_t from_end = block_count - static_cast<std::size_t>(block), blocks = piles() / grid_.columns();
  return blocks < from_end ? 0 : column_begin_[(blocks - from_end) * grid_.columns()] * std::size_t{cluster_size};
}

template <int Dim, class Real> bool Neighbours<Dim, Real>::covers_active(const Particles<Dim, Real>& particles) const {
  const std::size_t first = first_slot(Block::active);
  const auto x = particles[position];
  return reduce_slots(
      particles.slots() - first, true,
      [&](std::size_t k, bool& all) {
        if (particles.is_padding(first + k)) return;
        for (int d = 0; d < Dim; ++d) {
          const double upper = grid_.lower[d] + grid_.cells[d] * grid_.width[d];
          all &= grid_.periodic[d] || (x[d][first + k] >= grid_.lower[d] && x[d][first + k] < upper);
        }
      },
      [](bool& all, bool block) { all &= block; });
}

template <int Dim, class Real> void Neighbours<Dim, Real>::relist(Particles<Dim, Real>& particles) {
  find_boxes(particles, 0);
  list_neighbours(particles);
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
  const double across = std::ceil(column_width<Dim> * settings_.spacing / unit) * unit;
  for (int d = 0; d < Dim; ++d) {
    const double wanted = d == Grid<Dim>::along ? segment_columns * across : across;
    if (grid_.periodic[d]) {
      grid_.lower[d] = domain_.periodic.lower[d];
      grid_.cells[d] = std::max(1, static_cast<std::int32_t>(domain_.periodic.period[d] / wanted));
      grid_.width[d] = domain_.periodic.period[d] / grid_.cells[d];
    } else {
      grid_.width[d] = wanted;
      grid_.lower[d] = (std::floor(extent.lower[d] / wanted) - margin[d]) * wanted;
      grid_.cells[d] = static_cast<std::int32_t>((extent.upper[d] - grid_.lower[d]) / wanted) + 1 + margin[d];
    }
  }
  // A few particles thrown far must not make the table of columns larger than the particles: wider columns then.
  const double most_columns = 65536 + 8.0 * static_cast<double>(particles.count());
  while (static_cast<double>(grid_.columns()) > most_columns) {
    bool widened = false;
    for (int d = 0; d < Grid<Dim>::along; ++d) {
      if (grid_.cells[d] <= 1) continue;
      grid_.cells[d] = (grid_.cells[d] + 1) / 2;
      grid_.width[d] = grid_.periodic[d] ? domain_.periodic.period[d] / grid_.cells[d] : 2 * grid_.width[d];
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
  for (int d = 0; d < Dim; ++d) largest = std::max(largest, 0.5 * grid_.width[d] + reach);
  const int digits = std::numeric_limits<Real>::digits;
  // Not finer than double positions resolve.
  grid_.quantum = std::exp2(std::ceil(std::log2(largest)) - std::min(digits, 44));
}

template <int Dim, class Real>
void Neighbours<Dim, Real>::localise(Particles<Dim, Real>& particles, std::size_t slot) const {
  const auto local = particles[local_position];
  const auto x = particles[position];
  const bool padding = particles.is_padding(slot);
  const Cell<Dim>& c = cells_[slot / cluster_size];
  for (int d = 0; d < Dim; ++d)
    local[d][slot] = static_cast<Real>(padding ? far_away * settings_.spacing
                                               : grid_.on_quantum(x[d][slot] - grid_.origin(d, c[d])));
}

// ---- order ----------------------------------------------------------------------------------------------------------

/// Sorts the particles of the piles from first_pile on, and drops those of them that are outside the domain.
template <int Dim, class Real>
void Neighbours<Dim, Real>::sort(Particles<Dim, Real>& particles, std::size_t first_pile,
                                 std::span<const Block> block_of) {
  const auto x = particles[position];
  const std::size_t first = column_begin_[first_pile] * std::size_t{cluster_size};
  for_each_slot(particles.slots() - first, [&](std::size_t k) {
    for (int d = 0; d < Dim; ++d) x[d][first + k] = domain_.periodic.wrapped(d, x[d][first + k]);
  });
  const std::size_t outside = sort_columns(particles, first_pile, block_of);
  dropped_ += outside;
  particles.permute(cluster_order(first_pile), particles.count() - outside, first);
  for_each_slot(particles.slots() - first, [&](std::size_t k) { localise(particles, first + k); });
}

/// Fills entries_ pile by pile, each sorted along the column; ties by id, so that the order depends on state alone.
/// Returns how many particles are outside the domain.
template <int Dim, class Real>
std::size_t Neighbours<Dim, Real>::sort_columns(Particles<Dim, Real>& particles, std::size_t first_pile,
                                                std::span<const Block> block_of) {
  const std::size_t columns = piles() - first_pile, first = column_begin_[first_pile] * std::size_t{cluster_size};
  const std::size_t slots = particles.slots() - first;
  const auto x = particles[position];
  const auto ids = particles[id][0];
  std::vector<std::uint32_t> column_of(slots), next(columns + 1, 0);
  constexpr std::uint32_t nowhere = ~0u;
  for_each_slot(slots, [&](std::size_t k) {
    const std::size_t s = first + k;
    Cell<Dim> c{};
    bool inside = ids[s] != padding_id;
    for (int d = 0; d < Dim && inside; ++d) {
      inside = grid_.periodic[d] || (x[d][s] >= domain_.lower[d] && x[d][s] <= domain_.upper[d]);
      if (d < Grid<Dim>::along) c[d] = grid_.index(d, x[d][s]);
    }
    const std::size_t block = block_of.empty() ? 0 : static_cast<std::size_t>(block_of[s]);
    column_of[k] = inside ? static_cast<std::uint32_t>(block * grid_.columns() + grid_.column(c)) : nowhere;
  });
  std::size_t outside = 0;
  for (std::size_t k = 0; k < slots; ++k)
    if (column_of[k] != nowhere)
      ++next[column_of[k] + 1];
    else
      outside += ids[first + k] != padding_id;
  for (std::size_t c = 0; c < columns; ++c) next[c + 1] += next[c];
  entry_begin_.assign(next.begin(), next.end());
  const std::size_t entries = next[columns];
  entries_ = {static_cast<Entry*>(particles.scratch(entries * sizeof(Entry))), entries};
  for (std::size_t k = 0; k < slots; ++k)
    if (column_of[k] != nowhere)
      entries_[next[column_of[k]]++] = {static_cast<float>(x[Dim - 1][first + k] - grid_.lower[Dim - 1]),
                                        static_cast<std::int32_t>(first + k)};
  const auto before = [ids](const Entry& a, const Entry& b) {
    return a.along != b.along ? a.along < b.along : ids[a.slot] < ids[b.slot];
  };
  for_each_piece((columns + 63) / 64, [&](std::size_t group) {
    for (std::size_t c = group * 64; c < std::min(columns, (group + 1) * 64); ++c)
      std::sort(entries_.begin() + entry_begin_[c], entries_.begin() + entry_begin_[c + 1], before);
  });
  return outside;
}

/// Cuts the sorted piles into clusters; gives their cells_ and column_begin_, and for every new slot its old one.
template <int Dim, class Real> std::vector<std::int32_t> Neighbours<Dim, Real>::cluster_order(std::size_t first_pile) {
  const std::size_t columns = piles() - first_pile;
  const float longest = static_cast<float>(longest_cluster * settings_.spacing);
  const auto cluster_end = [&](std::uint32_t begin, std::uint32_t end) {
    std::uint32_t k = begin + 1;
    while (k < end && k < begin + cluster_size && entries_[k].along - entries_[begin].along <= longest) ++k;
    return k;
  };
  std::uint32_t* const cluster_begin = column_begin_.data() + first_pile;
  std::fill_n(cluster_begin + 1, columns, 0);
  for_each_piece((columns + 63) / 64, [&](std::size_t group) {
    for (std::size_t c = group * 64; c < std::min(columns, (group + 1) * 64); ++c)
      for (std::uint32_t k = entry_begin_[c]; k < entry_begin_[c + 1]; k = cluster_end(k, entry_begin_[c + 1]))
        ++cluster_begin[c + 1];
  });
  for (std::size_t c = 0; c < columns; ++c) cluster_begin[c + 1] += cluster_begin[c];
  const std::uint32_t first = cluster_begin[0], end = cluster_begin[columns];
  cells_.resize(end);
  std::vector<std::int32_t> order(std::size_t{end - first} * cluster_size, -1);
  for_each_piece((columns + 63) / 64, [&](std::size_t group) {
    for (std::size_t c = group * 64; c < std::min(columns, (group + 1) * 64); ++c) {
      Cell<Dim> cell{};
      for (std::size_t d = 0, rest = c; d < Grid<Dim>::along; ++d) {
        cell[d] = static_cast<std::int32_t>(rest % grid_.cells[d]);
        rest /= grid_.cells[d];
      }
      std::uint32_t cluster = cluster_begin[c];
      for (std::uint32_t k = entry_begin_[c]; k < entry_begin_[c + 1]; ++cluster) {
        const std::uint32_t next = cluster_end(k, entry_begin_[c + 1]);
        cell[Dim - 1] = grid_.index(Dim - 1, grid_.lower[Dim - 1] + entries_[k].along);
        cells_[cluster] = cell;
        for (std::size_t i = std::size_t{cluster - first} * cluster_size; k < next; ++k, ++i)
          order[i] = entries_[k].slot;
      }
    }
  });
  return order;
}

// ---- the list -------------------------------------------------------------------------------------------------------

template <int Dim, class Real> void Neighbours<Dim, Real>::place_boxes(Particles<Dim, Real>& particles) {
  constexpr float out_of_reach = std::numeric_limits<float>::max() / 4;
  const std::size_t length = clusters() + boxes_at_once;
  const bool lasting = piles() > grid_.columns();
  auto* memory = lasting ? nullptr : static_cast<float*>(particles.scratch(2 * Dim * length * sizeof(float)));
  for (int d = 0; d < Dim; ++d)
    for (const bool upper : {false, true}) {
      float*& side = upper ? boxes_.upper[d] : boxes_.lower[d];
      std::vector<float>& own = lasting_boxes_[2 * d + upper];
      if (lasting) own.resize(length);
      side = lasting ? own.data() : memory + (2 * d + upper) * length;
      std::fill_n(side + clusters(), boxes_at_once, out_of_reach);
    }
}

template <int Dim, class Real>
void Neighbours<Dim, Real>::find_boxes(Particles<Dim, Real>& particles, std::size_t first_cluster) {
  place_boxes(particles);
  const auto local = particles[local_position];
  for_each_slot(clusters() - first_cluster, [&](std::size_t k) {
    const std::size_t c = first_cluster + k;
    for (int d = 0; d < Dim; ++d) {
      Real lower = std::numeric_limits<Real>::max(), upper = std::numeric_limits<Real>::lowest();
      for (std::size_t s = c * cluster_size; s < (c + 1) * cluster_size; ++s) {
        if (particles.is_padding(s)) continue;
        lower = std::min(lower, local[d][s]);
        upper = std::max(upper, local[d][s]);
      }
      const double origin = d == Grid<Dim>::along ? (cells_[c][d] + 0.5) * grid_.width[d] : 0;
      boxes_.lower[d][c] = static_cast<float>(origin + lower);
      boxes_.upper[d][c] = static_cast<float>(origin + upper);
    }
  });
}

/// Clusters whose boxes are within this are neighbours (m): the support and the skin, and a little slack, since boxes
/// are floats and rounding must never lose a pair.
template <int Dim, class Real> double Neighbours<Dim, Real>::list_range() const {
  constexpr int along = Grid<Dim>::along;
  return (settings_.support_radius + settings_.skin) * (1 + 1e-5) + 4e-7 * grid_.cells[along] * grid_.width[along];
}

template <int Dim, class Real> void Neighbours<Dim, Real>::number_shifts() {
  // When relisting, particles may have left their cell by half a skin each.
  const double range = list_range() + settings_.skin;
  std::size_t count = 1;
  for (int d = 0; d < Dim; ++d) {
    shifts_.reach[d] = static_cast<int>(
        std::ceil((range + (d == Grid<Dim>::along ? longest_cluster * settings_.spacing : 0)) / grid_.width[d]));
    count *= 2 * shifts_.reach[d] + 1;
  }
  shifts_.cluster_bits = 32 - static_cast<int>(std::bit_width(count - 1));
  if (clusters() >> shifts_.cluster_bits)
    throw Error(ExitCode::usage, "numerics: " + std::to_string(clusters() * cluster_size) +
                                     " particles at this support radius are more than one neighbour list holds; lower "
                                     "numerics.smoothing_ratio or the number of particles");
  shifts_.shift.resize(count);
  for (std::size_t n = 0; n < count; ++n) {
    std::size_t rest = n;
    for (int d = Dim - 1; d >= 0; --d) {
      const int sides = 2 * shifts_.reach[d] + 1;
      shifts_.shift[n][d] = grid_.shift(d, static_cast<int>(rest % sides) - shifts_.reach[d]);
      rest /= sides;
    }
  }
}

/// Lists the neighbours of a chunk's clusters. The clusters of a column look at the same columns around it, each with a
/// cursor that only moves forward.
template <int Dim, class Real> class Neighbours<Dim, Real>::Lister {
 public:
  Lister(const Neighbours& neighbours, const Particles<Dim, Real>& particles)
      : n_(neighbours),
        local_(particles[local_position]),
        range_(n_.list_range()),
        reach2_(static_cast<float>(range_ * range_)),
        // Boxes follow one another along the column, after a restart up to half a skin out of order.
        slack_(static_cast<float>(range_ + n_.settings_.skin)) {}

  void list(ClusterChunk& chunk) {
    found_.resize(std::size_t{chunk.end - chunk.begin} * 128);
    count_ = 0;
    chunk.entry_begin.assign(1, 0);
    for (std::uint32_t c = chunk.begin; c < chunk.end; ++c) {
      if (c == chunk.begin || n_.grid_.column(n_.cells_[c]) != n_.grid_.column(n_.cells_[c - 1]))
        look_around(n_.cells_[c]);
      load_own(c);
      for (Target& target : targets_) list_column(c, target);
      chunk.entry_begin.push_back(static_cast<std::uint32_t>(count_));
    }
    chunk.entries.assign(found_.begin(), found_.begin() + static_cast<std::ptrdiff_t>(count_));
  }

 private:
  static constexpr int along = Dim - 1;

  /// A column around the present one, or a periodic image of it.
  struct Target {
    std::uint32_t cursor, end;     // clusters
    std::array<float, Dim> shift;  // m; its origin as seen from here
    std::int32_t number;           // of the shift to its segment 0
  };

  void look_around(const Cell<Dim>& cell) {
    targets_.clear();
    Cell<Dim> offset{};
    const int far = Dim == 3 ? n_.shifts_.reach[1] : 0;
    for (int b = -far; b <= far; ++b)
      for (int a = -n_.shifts_.reach[0]; a <= n_.shifts_.reach[0]; ++a) {
        offset[0] = a;
        if constexpr (Dim == 3) offset[1] = b;
        add_column(cell, offset);
      }
  }

  void add_column(const Cell<Dim>& cell, Cell<Dim> offset) {
    const Grid<Dim>& grid = n_.grid_;
    Cell<Dim> column{};
    for (int d = 0; d < along; ++d) {
      column[d] = cell[d] + offset[d];
      if (grid.periodic[d])
        column[d] = ((column[d] % grid.cells[d]) + grid.cells[d]) % grid.cells[d];
      else if (column[d] < 0 || column[d] >= grid.cells[d])
        return;
    }
    offset[along] = 0;
    for (std::size_t pile = grid.column(column); pile < n_.piles(); pile += grid.columns()) add_pile(pile, offset);
  }

  void add_pile(std::size_t pile, const Cell<Dim>& offset) {
    const Grid<Dim>& grid = n_.grid_;
    const double length = grid.cells[along] * grid.width[along];
    const int images = grid.periodic[along] ? 1 + static_cast<int>(slack_ / length) : 0;
    if (n_.column_begin_[pile] == n_.column_begin_[pile + 1]) return;
    for (int image = -images; image <= images; ++image) {
      Target target{n_.column_begin_[pile], n_.column_begin_[pile + 1], {}, 0};
      for (int d = 0; d < along; ++d) target.shift[d] = static_cast<float>(offset[d] * grid.width[d]);
      target.shift[along] = static_cast<float>(image * length);
      target.number = static_cast<std::int32_t>(n_.shifts_.number(offset)) + image * grid.cells[along];
      targets_.push_back(target);
    }
  }

  /// Appends the clusters of a column whose boxes come within range of the cluster's.
  void list_column(std::uint32_t cluster, Target& target) {
    const Boxes& boxes = n_.boxes_;
    std::array<float, Dim> lower, upper;  // of the cluster, as seen from the column
    for (int d = 0; d < Dim; ++d) {
      lower[d] = boxes.lower[d][cluster] - target.shift[d];
      upper[d] = boxes.upper[d][cluster] - target.shift[d];
    }
    const float* top = boxes.upper[along];
    const float* bottom = boxes.lower[along];
    // The clusters that follow here lie no lower than this one by more than the slack allows for.
    while (target.cursor < target.end && top[target.cursor] < lower[along] - slack_) ++target.cursor;
    const std::int32_t number = target.number - n_.cells_[cluster][along];
    for (std::uint32_t first = target.cursor; first < target.end && bottom[first] <= upper[along] + slack_;
         first += boxes_at_once)
      append(first, std::min<std::uint32_t>(target.end - first, boxes_at_once), lower, upper, number);
  }

  /// Those of `count` boxes from `first` on that are within reach.
  void append(std::uint32_t first, std::uint32_t count, const std::array<float, Dim>& lower,
              const std::array<float, Dim>& upper, std::int32_t number) {
    using L = Lanes<float, boxes_at_once>;
    L distance2(0.f);
    for (int d = 0; d < Dim; ++d) {
      const L gap = max(L(0.f), max(load_8(n_.boxes_.lower[d] + first) - L(upper[d]),
                                    L(lower[d]) - load_8(n_.boxes_.upper[d] + first)));
      distance2 += gap * gap;
    }
    if (count_ + boxes_at_once > found_.size()) found_.resize(2 * found_.size());
    for (unsigned hit = less_mask(distance2, L(reach2_)) & ((1u << count) - 1); hit; hit &= hit - 1) {
      const std::uint32_t other = first + static_cast<std::uint32_t>(std::countr_zero(hit));
      const auto shift = static_cast<std::uint32_t>(number + n_.cells_[other][along]);
      found_[count_] = shift << n_.shifts_.cluster_bits | other;
      count_ += meets(other, n_.shifts_.shift[shift]);
    }
  }

  // ---- of those with near boxes, the ones of which a particle is within reach of one here: a seventh fewer ----

  static constexpr int N = native_lanes<Real>;
  static constexpr int I = N < cluster_size ? N : cluster_size, J = N / I;
  using Wide = Lanes<Real, N>;

  void load_own(std::uint32_t cluster) {
    for (int i = 0; i < cluster_size; i += I)
      for (int d = 0; d < Dim; ++d)
        own_[i / I][d] = load_i<I, Real, N>(local_[d] + std::size_t{cluster} * cluster_size + i);
  }

  bool meets(std::uint32_t other, const std::array<double, Dim>& shift) const {
    bool near = false;
    for (const auto& own : own_)
      for (int j = 0; j < cluster_size; j += J) {
        Wide distance2(Real(0));
        unrolled<Dim>([&](auto d) {
          const Wide x = own[d] - Wide(static_cast<Real>(shift[d])) -
                         load_j<J, Real, N>(local_[d] + std::size_t{other} * cluster_size + j);
          distance2 = x * x + distance2;
        });
        near |= any_less(distance2, Wide(static_cast<Real>(reach2_)));
      }
    return near;
  }

  const Neighbours& n_;
  Column<LocalPosition, Dim, Real> local_;
  Vec<Dim, Wide> own_[cluster_size / I];  // local positions of the cluster that lists
  double range_;                          // m
  float reach2_, slack_;
  std::vector<Target> targets_;
  std::vector<ListEntry> found_;  // of the chunk; count_ of them
  std::size_t count_ = 0;
};

template <int Dim, class Real> void Neighbours<Dim, Real>::list_neighbours(const Particles<Dim, Real>& particles) {
  number_shifts();
  list_clusters(chunks_, first_slot(Block::active) / cluster_size, clusters(), particles);
  warm_listed_ = false;
}

template <int Dim, class Real>
std::span<const ClusterChunk> Neighbours<Dim, Real>::warm_chunks(const Particles<Dim, Real>& particles) {
  if (!warm_listed_)
    list_clusters(warm_chunks_, first_slot(Block::warm) / cluster_size, first_slot(Block::active) / cluster_size,
                  particles);
  warm_listed_ = true;
  return warm_chunks_;
}

/// Lists the clusters from begin to end.
template <int Dim, class Real>
void Neighbours<Dim, Real>::list_clusters(std::vector<ClusterChunk>& chunks, std::size_t begin, std::size_t end,
                                          const Particles<Dim, Real>& particles) {
  chunks.resize((end - begin + clusters_a_chunk - 1) / clusters_a_chunk);
  for_each_piece_with(chunks.size(), Lister(*this, particles), [&](std::size_t k, Lister& lister) {
    ClusterChunk& chunk = chunks[k];
    chunk.begin = static_cast<std::uint32_t>(begin + k * clusters_a_chunk);
    chunk.end = static_cast<std::uint32_t>(std::min(end, begin + (k + 1) * clusters_a_chunk));
    lister.list(chunk);
  });
}

template <int Dim, class Real> std::size_t Neighbours<Dim, Real>::bytes() const {
  std::size_t sum = bytes_of(cells_) + bytes_of(column_begin_) + bytes_of(entry_begin_);
  for (const std::vector<float>& side : lasting_boxes_) sum += bytes_of(side);
  for (const auto* chunks : {&chunks_, &warm_chunks_}) {
    sum += bytes_of(*chunks);
    for (const ClusterChunk& c : *chunks) sum += bytes_of(c.entries) + bytes_of(c.entry_begin);
  }
  return sum;
}

template <int Dim, class Real> void Neighbours<Dim, Real>::archive(Archive& a) {
  a.value("neighbours/displacement", displacement_);
  auto dropped = static_cast<std::int64_t>(dropped_);
  a.value("neighbours/dropped", dropped);
  dropped_ = static_cast<std::size_t>(dropped);
  a.value("grid/quantum", grid_.quantum);
  a.array("grid/lower", NumberType::f64, grid_.lower.data(), Dim);
  a.array("grid/width", NumberType::f64, grid_.width.data(), Dim);
  a.array("grid/cells", NumberType::i32, grid_.cells.data(), Dim);
  a.vector("grid/column_begin", column_begin_);
  std::vector<std::int32_t> flat;
  if (!a.loading())
    for (const Cell<Dim>& c : cells_) flat.insert(flat.end(), c.begin(), c.end());
  a.vector("grid/cluster_cells", flat);
  if (a.loading()) {
    cells_.resize(flat.size() / Dim);
    for (std::size_t k = 0; k < flat.size(); ++k) cells_[k / Dim][k % Dim] = flat[k];
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
