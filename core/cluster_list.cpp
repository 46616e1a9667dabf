#include "core/cluster_list.h"

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
constexpr int boxes_at_once = 8;            // in the search for neighbours
constexpr std::int32_t segments_a_row = 1;  // from the first cluster's to the last one's, at most

}  // namespace

template <int Dim, class Real>
void ClusterList<Dim, Real>::place_boxes(const ClusterOrder<Dim>& order, Particles<Dim, Real>& particles) {
  constexpr float out_of_reach = std::numeric_limits<float>::max() / 4;
  const std::size_t length = order.clusters() + boxes_at_once;
  const bool lasting = order.piles() > order.grid.columns();
  auto* memory = lasting ? nullptr : static_cast<float*>(particles.scratch(2 * Dim * length * sizeof(float)));
  for (int d = 0; d < Dim; ++d)
    for (const bool upper : {false, true}) {
      float*& side = upper ? boxes_.upper[d] : boxes_.lower[d];
      std::vector<float>& own = lasting_boxes_[2 * d + upper];
      if (lasting) own.resize(length);
      side = lasting ? own.data() : memory + (2 * d + upper) * length;
      std::fill_n(side + order.clusters(), boxes_at_once, out_of_reach);
    }
}

template <int Dim, class Real>
void ClusterList<Dim, Real>::find_boxes(const ClusterOrder<Dim>& order, Particles<Dim, Real>& particles,
                                        std::size_t first_cluster) {
  place_boxes(order, particles);
  const auto local = particles[local_position];
  for_each_slot(order.clusters() - first_cluster, [&](std::size_t k) {
    const std::size_t c = first_cluster + k;
    for (int d = 0; d < Dim; ++d) {
      Real lower = std::numeric_limits<Real>::max(), upper = std::numeric_limits<Real>::lowest();
      for (std::size_t s = c * cluster_size; s < (c + 1) * cluster_size; ++s) {
        if (particles.is_padding(s)) continue;
        lower = std::min(lower, local[d][s]);
        upper = std::max(upper, local[d][s]);
      }
      const double origin = d == Grid<Dim>::along ? (order.cells[c][d] + 0.5) * order.grid.width[d] : 0;
      boxes_.lower[d][c] = static_cast<float>(origin + lower);
      boxes_.upper[d][c] = static_cast<float>(origin + upper);
    }
  });
}

/// Particles that a shell holds are within this of each other (m): a little slack, since boxes are floats and rounding
/// must never lose a pair.
template <int Dim, class Real> double ClusterList<Dim, Real>::range(const ClusterOrder<Dim>& order, int shell) const {
  constexpr int along = Grid<Dim>::along;
  return (settings_.support_radius + settings_.skin * (shell + 1) / shells) * (1 + 1e-5) +
         4e-7 * order.grid.cells[along] * order.grid.width[along];
}

template <int Dim, class Real> void ClusterList<Dim, Real>::number_shifts(const ClusterOrder<Dim>& order) {
  // When relisting, particles may have left their cell by half a skin each.
  const double farthest = range(order, shells - 1) + settings_.skin;
  std::size_t count = 1;
  for (int d = 0; d < Dim; ++d) {
    shifts_.reach[d] = static_cast<int>(std::ceil(
        (farthest + (d == Grid<Dim>::along ? longest_cluster * settings_.spacing : 0)) / order.grid.width[d]));
    count *= 2 * shifts_.reach[d] + 1;
  }
  // Entries of a row are seen from its first cluster, which may be some segments before another.
  shifts_.slots_a_group = group_size<Real>;
  shifts_.group_bits = 32 - static_cast<int>(std::bit_width(count - 1 + segments_a_row));
  const std::size_t groups = order.clusters() * groups_a_cluster<Real>;
  if (groups >> shifts_.group_bits)
    throw Error(ExitCode::usage, "numerics: " + std::to_string(order.clusters() * cluster_size) +
                                     " particles at this support radius are more than one neighbour list holds; lower "
                                     "numerics.smoothing_ratio or the number of particles");
  shifts_.shift.resize(count);
  for (std::size_t n = 0; n < count; ++n) {
    std::size_t rest = n;
    for (int d = Dim - 1; d >= 0; --d) {
      const int sides = 2 * shifts_.reach[d] + 1;
      shifts_.shift[n][d] = order.grid.shift(d, static_cast<int>(rest % sides) - shifts_.reach[d]);
      rest /= sides;
    }
  }
  in_columns_.resize(groups + ClusterChunk::mask_bits);
  for_each_slot(groups, [&](std::size_t g) {
    const Cell<Dim>& cell = order.cells[g / groups_a_cluster<Real>];
    in_columns_[g] = static_cast<ListEntry>(g) - shifts_.seen_from(-cell[Grid<Dim>::along]);
  });
}

/// Lists the neighbours of a chunk's clusters, row by row. The rows of a column look at the same columns around it,
/// each with a cursor that only moves forward: first all clusters whose boxes are near the row's, then of their groups
/// the ones of which a particle is near one of the row's.
template <int Dim, class Real> class ClusterList<Dim, Real>::Lister {
 public:
  Lister(const ClusterList& list, const ClusterOrder<Dim>& order, const Particles<Dim, Real>& particles)
      : list_(list),
        order_(order),
        local_(particles[local_position]),
        range_(static_cast<float>(list_.range(order, shells - 1))),
        // Boxes follow one another along the column, after a restart up to half a skin out of order.
        slack_(static_cast<float>(range_ + list_.settings_.skin)) {
    for (int s = 0; s < shells; ++s) {
      const double range = list_.range(order, s);
      for (int g = 0; g < clusters_a_row; ++g) reach2_[flag(g, s)] = static_cast<Real>(range * range);
    }
  }

  void list(ClusterChunk& chunk) {
    chunk.rows.clear();
    run_begins_.clear();
    run_lengths_.clear();
    masks_.clear();
    for (std::uint32_t c = chunk.begin; c < chunk.end;) {
      if (c == chunk.begin || !same_column(c, c - 1)) look_around(order_.cells[c]);
      const Row row{c, row_end(c, chunk.end)};
      chunk.rows.push_back(row_from(c));
      list_row(row);
      c = row.end;
    }
    chunk.rows.push_back(row_from(chunk.end));
    const auto no_more_than_needed = [](const auto& v) { return std::decay_t<decltype(v)>(v.begin(), v.end()); };
    chunk.run_begins = no_more_than_needed(run_begins_);
    chunk.run_lengths = no_more_than_needed(run_lengths_);
    chunk.masks = no_more_than_needed(masks_);
  }

 private:
  static constexpr int along = Dim - 1;
  static constexpr int N = native_lanes<Real>, I = cluster_size, J = group_size<Real>, groups = groups_a_cluster<Real>;
  using Wide = Lanes<Real, N>;
  static_assert(N >= cluster_size && clusters_a_row == 4 && shells == 3 && shell_bits == 2);

  /// Of the row's cluster g and a shell: which bit.
  static constexpr int flag(int g, int shell) { return shell * clusters_a_row + g; }

  struct Row {
    std::uint32_t begin, end;  // clusters
  };
  /// A column around the present one, or a periodic image of it.
  struct Target {
    std::uint32_t cursor, end;     // clusters
    std::array<float, Dim> shift;  // m; its origin as seen from here
    std::int32_t number;           // of the shift to its segment 0
    std::int32_t segments;         // to the image
  };

  /// The row that begins with this cluster and with the next run.
  ClusterChunk::Row row_from(std::uint32_t cluster) const {
    return {cluster, static_cast<std::uint32_t>(run_begins_.size()), static_cast<std::uint32_t>(masks_.size())};
  }

  bool same_column(std::uint32_t a, std::uint32_t b) const {
    return order_.grid.column(order_.cells[a]) == order_.grid.column(order_.cells[b]);
  }

  std::uint32_t row_end(std::uint32_t begin, std::uint32_t end) const {
    std::uint32_t c = begin + 1;
    while (c < end && c < begin + clusters_a_row && same_column(begin, c) &&
           order_.cells[c][along] <= order_.cells[begin][along] + segments_a_row)
      ++c;
    return c;
  }

  void look_around(const Cell<Dim>& cell) {
    targets_.clear();
    Cell<Dim> offset{};
    const int far = Dim == 3 ? list_.shifts_.reach[1] : 0;
    for (int b = -far; b <= far; ++b)
      for (int a = -list_.shifts_.reach[0]; a <= list_.shifts_.reach[0]; ++a) {
        offset[0] = a;
        if constexpr (Dim == 3) offset[1] = b;
        add_column(cell, offset);
      }
  }

  void add_column(const Cell<Dim>& cell, Cell<Dim> offset) {
    const Grid<Dim>& grid = order_.grid;
    Cell<Dim> column{};
    for (int d = 0; d < along; ++d) {
      column[d] = cell[d] + offset[d];
      if (grid.periodic[d])
        column[d] = ((column[d] % grid.cells[d]) + grid.cells[d]) % grid.cells[d];
      else if (column[d] < 0 || column[d] >= grid.cells[d])
        return;
    }
    offset[along] = 0;
    for (std::size_t pile = grid.column(column); pile < order_.piles(); pile += grid.columns()) add_pile(pile, offset);
  }

  void add_pile(std::size_t pile, const Cell<Dim>& offset) {
    const Grid<Dim>& grid = order_.grid;
    const double length = grid.cells[along] * grid.width[along];
    const int images = grid.periodic[along] ? 1 + static_cast<int>(slack_ / length) : 0;
    if (order_.pile_begin[pile] == order_.pile_begin[pile + 1]) return;
    for (int image = -images; image <= images; ++image) {
      Target target{order_.pile_begin[pile], order_.pile_begin[pile + 1], {}, 0, image * grid.cells[along]};
      for (int d = 0; d < along; ++d) target.shift[d] = static_cast<float>(offset[d] * grid.width[d]);
      target.shift[along] = static_cast<float>(image * length);
      target.number = static_cast<std::int32_t>(list_.shifts_.number(offset)) + target.segments;
      targets_.push_back(target);
    }
  }

  // ---- clusters with near boxes ----

  struct Box {
    std::array<float, Dim> lower, upper;  // m, as boxes_
  };

  void list_row(const Row& row) {
    Box box;
    for (int d = 0; d < Dim; ++d) {
      box.lower[d] = *std::min_element(list_.boxes_.lower[d] + row.begin, list_.boxes_.lower[d] + row.end);
      box.upper[d] = *std::max_element(list_.boxes_.upper[d] + row.begin, list_.boxes_.upper[d] + row.end);
    }
    near_count_ = 0;
    for (std::uint32_t k = 0; k < targets_.size(); ++k) search_column(box, k);
    keep_met(row);
  }

  void search_column(const Box& box, std::uint32_t number) {
    const Boxes& boxes = list_.boxes_;
    Target& target = targets_[number];
    Box seen = box;  // from the column
    for (int d = 0; d < Dim; ++d) {
      seen.lower[d] -= target.shift[d];
      seen.upper[d] -= target.shift[d];
    }
    const float* top = boxes.upper[along];
    const float* bottom = boxes.lower[along];
    // The clusters that follow here lie no lower than this row by more than the slack allows for.
    while (target.cursor < target.end && top[target.cursor] < seen.lower[along] - slack_) ++target.cursor;
    for (std::uint32_t first = target.cursor; first < target.end && bottom[first] <= seen.upper[along] + slack_;
         first += boxes_at_once)
      add_near(first, std::min<std::uint32_t>(target.end - first, boxes_at_once), seen, number);
  }

  /// Those of `count` boxes from `first` on that are near.
  void add_near(std::uint32_t first, std::uint32_t count, const Box& box, std::uint32_t target) {
    using L = Lanes<float, boxes_at_once>;
    L distance2(0.f);
    for (int d = 0; d < Dim; ++d) {
      const L gap = max(L(0.f), max(load_8(list_.boxes_.lower[d] + first) - L(box.upper[d]),
                                    L(box.lower[d]) - load_8(list_.boxes_.upper[d] + first)));
      distance2 += gap * gap;
    }
    if (near_count_ + boxes_at_once > near_.size())
      near_.resize(2 * near_.size() + 256), target_of_.resize(near_.size());
    const unsigned hits = less_lanes(distance2, L(range_ * range_)) & ((1u << count) - 1);
    std::fill_n(target_of_.begin() + static_cast<std::ptrdiff_t>(near_count_), boxes_at_once, target);
    near_count_ += static_cast<std::size_t>(write_set_bits(hits, first, near_.data() + near_count_));
  }

  // ---- of these, the groups of which a particle is within reach of one of the row's ----

  void keep_met(const Row& row) {
    load_own(row);
    entries_.resize(near_count_ * groups + 1 + ClusterChunk::mask_bits);
    flags_.resize(near_count_ * groups + ClusterChunk::mask_bits);
    std::size_t count = 0;
    const std::int32_t segment = order_.cells[row.begin][along];
    for (std::size_t k = 0; k < near_count_; ++k) {
      const Target& target = targets_[target_of_[k]];
      const std::int32_t further = order_.cells[near_[k]][along] - segment;
      const std::array<std::uint16_t, groups> met = meetings(near_[k], target, further);
      const ListEntry first = list_.shifts_.seen_from(target.number - segment) | near_[k] * groups;
      unsigned any = 0;
      unrolled<groups>([&](auto part) {
        any |= flags_[count + part] = met[part];
        entries_[1 + count + part] = first + part;
      });
      // All of a cluster or none: runs are longer so.
      count += any != 0 ? groups : 0;
    }
    keep_runs(count);
    std::fill_n(flags_.begin() + static_cast<std::ptrdiff_t>(count), ClusterChunk::mask_bits, 0);
    for (std::uint32_t g = 0; g < own_count_; ++g) keep_shells(static_cast<int>(g), count);
  }

  /// The row's entries.
  void keep_runs(std::size_t count) {
    std::size_t begin = 0;
    const auto end_run = [&](std::size_t end) {
      run_begins_.push_back(entries_[1 + begin]);
      run_lengths_.push_back(static_cast<std::uint8_t>(end - begin));
      begin = end;
    };
    for (std::size_t k = 0; k < count; k += ClusterChunk::mask_bits) {
      const bool long_enough = k % ClusterChunk::longest_run == 0;
      for (unsigned ends = breaks(&entries_[1 + k]) | long_enough; ends; ends &= ends - 1)
        if (const std::size_t end = k + static_cast<unsigned>(std::countr_zero(ends)); end > begin && end < count)
          end_run(end);
    }
    if (count > 0) end_run(count);
  }

  /// The bits of one of the row's clusters.
  void keep_shells(int g, std::size_t count) {
    const std::size_t words = ClusterChunk::words(count), low = masks_.size(), high = low + words;
    masks_.resize(low + shell_bits * words);
    for (std::size_t w = 0; w < words; ++w) {
      std::array<unsigned, shells> in;
      for (int s = 0; s < shells; ++s) in[s] = gather_bit(flags_.data() + w * ClusterChunk::mask_bits, flag(g, s));
      masks_[low + w] = static_cast<std::uint16_t>(in[0] | (in[2] & ~in[1]));
      masks_[high + w] = static_cast<std::uint16_t>(in[2] & ~in[0]);
    }
  }

  /// Positions of the row's particles from the origin of its first cluster; far from all where a row has fewer
  /// clusters.
  void load_own(const Row& row) {
    own_count_ = row.end - row.begin;
    for (std::uint32_t g = 0; g < clusters_a_row; ++g)
      for (int d = 0; d < Dim; ++d)
        own_[g][d] = g < own_count_ ? load_i<I, Real, N>(local_[d] + std::size_t{row.begin + g} * cluster_size)
                                    : Wide(Real(1e18));
    for (std::uint32_t g = 0; g < own_count_; ++g) {
      const std::int32_t further = order_.cells[row.begin + g][along] - order_.cells[row.begin][along];
      own_[g][along] += Wide(static_cast<Real>(further * order_.grid.width[along]));
    }
  }

  /// Of each group of a cluster, bit flag(g, s): is one of its particles within shell s of one of the row's cluster g?
  [[gnu::always_inline]] std::array<std::uint16_t, groups> meetings(std::uint32_t other, const Target& target,
                                                                    std::int32_t further) const {
    Vec<Dim, Wide> shift;
    for (int d = 0; d < along; ++d) shift[d] = Wide(static_cast<Real>(target.shift[d]));
    shift[along] = Wide(static_cast<Real>((further + target.segments) * order_.grid.width[along]));
    std::array<std::uint16_t, groups> met;
    unrolled<groups>([&](auto part) __attribute__((always_inline)) {
      Vec<Dim, Wide> x;
      unrolled<Dim>([&](auto d) {
        x[d] = load_j<J, Real, N>(local_[d] + std::size_t{other} * cluster_size + part * J) + shift[d];
      });
      std::array<Wide, clusters_a_row> distance2;
      unrolled<clusters_a_row>([&](auto g) {
        const Vec<Dim, Wide> way = own_[g] - x;
        distance2[g] = dot(way, way);
      });
      met[part] = static_cast<std::uint16_t>(any_less_bits<clusters_a_row * shells>(distance2, reach2_));
    });
    return met;
  }

  const ClusterList& list_;
  const ClusterOrder<Dim>& order_;
  Column<LocalPosition, Dim, Real> local_;
  float range_, slack_;                             // m
  std::array<Real, 16> reach2_{};                   // m², by flag
  std::array<Vec<Dim, Wide>, clusters_a_row> own_;  // of the row; own_count_ of them
  std::uint32_t own_count_ = 0;
  std::vector<Target> targets_;
  std::vector<std::uint32_t> near_, target_of_;  // clusters with boxes near the row's; near_count_ of them
  std::size_t near_count_ = 0;
  std::vector<ListEntry> entries_;     // of the row, from number 1 on, to segment 0 of their columns
  std::vector<std::uint16_t> flags_;   // of these
  std::vector<ListEntry> run_begins_;  // of the chunk
  std::vector<std::uint8_t> run_lengths_;
  std::vector<std::uint16_t> masks_;
};

template <int Dim, class Real>
void ClusterList<Dim, Real>::make(const ClusterOrder<Dim>& order, Particles<Dim, Real>& particles,
                                  std::size_t first_cluster) {
  find_boxes(order, particles, first_cluster);
  number_shifts(order);
  list_clusters(chunks_, order, order.first_cluster(Block::active), order.clusters(), particles);
  warm_listed_ = false;
}

template <int Dim, class Real>
std::span<const ClusterChunk> ClusterList<Dim, Real>::warm_chunks(const ClusterOrder<Dim>& order,
                                                                  const Particles<Dim, Real>& particles) {
  if (!warm_listed_)
    list_clusters(warm_chunks_, order, order.first_cluster(Block::warm), order.first_cluster(Block::active), particles);
  warm_listed_ = true;
  return warm_chunks_;
}

/// Lists the clusters from begin to end.
template <int Dim, class Real>
void ClusterList<Dim, Real>::list_clusters(std::vector<ClusterChunk>& chunks, const ClusterOrder<Dim>& order,
                                           std::size_t begin, std::size_t end, const Particles<Dim, Real>& particles) {
  chunks.resize((end - begin + clusters_a_chunk - 1) / clusters_a_chunk);
  for_each_piece_with(chunks.size(), Lister(*this, order, particles), [&](std::size_t k, Lister& lister) {
    ClusterChunk& chunk = chunks[k];
    chunk.begin = static_cast<std::uint32_t>(begin + k * clusters_a_chunk);
    chunk.end = static_cast<std::uint32_t>(std::min(end, begin + (k + 1) * clusters_a_chunk));
    lister.list(chunk);
  });
}

template <int Dim, class Real> std::size_t ClusterList<Dim, Real>::bytes() const {
  std::size_t sum = bytes_of(in_columns_);
  for (const std::vector<float>& side : lasting_boxes_) sum += bytes_of(side);
  for (const auto* chunks : {&chunks_, &warm_chunks_}) {
    sum += bytes_of(*chunks);
    for (const ClusterChunk& c : *chunks)
      sum += bytes_of(c.rows) + bytes_of(c.run_begins) + bytes_of(c.run_lengths) + bytes_of(c.masks);
  }
  return sum;
}

template class ClusterList<2, float>;
template class ClusterList<2, double>;
template class ClusterList<3, float>;
template class ClusterList<3, double>;

}  // namespace molten
