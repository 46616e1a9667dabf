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
constexpr int boxes_at_once = 8;  // in the search for neighbours

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

/// Clusters whose boxes are within this are neighbours (m): the support and the skin, and a little slack, since boxes
/// are floats and rounding must never lose a pair.
template <int Dim, class Real> double ClusterList<Dim, Real>::range(const ClusterOrder<Dim>& order) const {
  constexpr int along = Grid<Dim>::along;
  return (settings_.support_radius + settings_.skin) * (1 + 1e-5) +
         4e-7 * order.grid.cells[along] * order.grid.width[along];
}

template <int Dim, class Real> void ClusterList<Dim, Real>::number_shifts(const ClusterOrder<Dim>& order) {
  // When relisting, particles may have left their cell by half a skin each.
  const double farthest = range(order) + settings_.skin;
  std::size_t count = 1;
  for (int d = 0; d < Dim; ++d) {
    shifts_.reach[d] = static_cast<int>(std::ceil(
        (farthest + (d == Grid<Dim>::along ? longest_cluster * settings_.spacing : 0)) / order.grid.width[d]));
    count *= 2 * shifts_.reach[d] + 1;
  }
  shifts_.cluster_bits = 32 - static_cast<int>(std::bit_width(count - 1));
  if (order.clusters() >> shifts_.cluster_bits)
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
}

/// Lists the neighbours of a chunk's clusters. The clusters of a column look at the same columns around it, each with a
/// cursor that only moves forward.
template <int Dim, class Real> class ClusterList<Dim, Real>::Lister {
 public:
  Lister(const ClusterList& list, const ClusterOrder<Dim>& order, const Particles<Dim, Real>& particles)
      : list_(list),
        order_(order),
        local_(particles[local_position]),
        range_(list_.range(order)),
        reach2_(static_cast<float>(range_ * range_)),
        // Boxes follow one another along the column, after a restart up to half a skin out of order.
        slack_(static_cast<float>(range_ + list_.settings_.skin)) {}

  void list(ClusterChunk& chunk) {
    found_.resize(std::size_t{chunk.end - chunk.begin} * 128);
    count_ = 0;
    chunk.entry_begin.assign(1, 0);
    for (std::uint32_t c = chunk.begin; c < chunk.end; ++c) {
      if (c == chunk.begin || order_.grid.column(order_.cells[c]) != order_.grid.column(order_.cells[c - 1]))
        look_around(order_.cells[c]);
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
      Target target{order_.pile_begin[pile], order_.pile_begin[pile + 1], {}, 0};
      for (int d = 0; d < along; ++d) target.shift[d] = static_cast<float>(offset[d] * grid.width[d]);
      target.shift[along] = static_cast<float>(image * length);
      target.number = static_cast<std::int32_t>(list_.shifts_.number(offset)) + image * grid.cells[along];
      targets_.push_back(target);
    }
  }

  /// Appends the clusters of a column whose boxes come within range of the cluster's.
  void list_column(std::uint32_t cluster, Target& target) {
    const Boxes& boxes = list_.boxes_;
    std::array<float, Dim> lower, upper;  // of the cluster, as seen from the column
    for (int d = 0; d < Dim; ++d) {
      lower[d] = boxes.lower[d][cluster] - target.shift[d];
      upper[d] = boxes.upper[d][cluster] - target.shift[d];
    }
    const float* top = boxes.upper[along];
    const float* bottom = boxes.lower[along];
    // The clusters that follow here lie no lower than this one by more than the slack allows for.
    while (target.cursor < target.end && top[target.cursor] < lower[along] - slack_) ++target.cursor;
    const std::int32_t number = target.number - order_.cells[cluster][along];
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
      const L gap = max(L(0.f), max(load_8(list_.boxes_.lower[d] + first) - L(upper[d]),
                                    L(lower[d]) - load_8(list_.boxes_.upper[d] + first)));
      distance2 += gap * gap;
    }
    if (count_ + boxes_at_once > found_.size()) found_.resize(2 * found_.size());
    for (unsigned hit = less_mask(distance2, L(reach2_)) & ((1u << count) - 1); hit; hit &= hit - 1) {
      const std::uint32_t other = first + static_cast<std::uint32_t>(std::countr_zero(hit));
      const auto shift = static_cast<std::uint32_t>(number + order_.cells[other][along]);
      found_[count_] = shift << list_.shifts_.cluster_bits | other;
      count_ += meets(other, list_.shifts_.shift[shift]);
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

  const ClusterList& list_;
  const ClusterOrder<Dim>& order_;
  Column<LocalPosition, Dim, Real> local_;
  Vec<Dim, Wide> own_[cluster_size / I];  // local positions of the cluster that lists
  double range_;                          // m
  float reach2_, slack_;
  std::vector<Target> targets_;
  std::vector<ListEntry> found_;  // of the chunk; count_ of them
  std::size_t count_ = 0;
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
  std::size_t sum = 0;
  for (const std::vector<float>& side : lasting_boxes_) sum += bytes_of(side);
  for (const auto* chunks : {&chunks_, &warm_chunks_}) {
    sum += bytes_of(*chunks);
    for (const ClusterChunk& c : *chunks) sum += bytes_of(c.entries) + bytes_of(c.entry_begin);
  }
  return sum;
}

template class ClusterList<2, float>;
template class ClusterList<2, double>;
template class ClusterList<3, float>;
template class ClusterList<3, double>;

}  // namespace molten
