// Particles with a neighbour list but without a run, and their pairs by the list and by brute force.
#pragma once

#include <algorithm>
#include <tuple>

#include "core/neighbours.h"
#include "tests/particle_sets.h"

namespace molten::clouds {

using namespace particle_sets;

/// Particles and their list, without a run.
template <int Dim, class Real> struct Cloud {
  Domain<Dim> domain;
  NeighbourSettings settings;
  Particles<Dim, Real> particles{field_set(FieldList<Id, Position, LocalPosition>{})};
  Neighbours<Dim, Real> neighbours;

  Cloud(const Points& points, double spacing, const Domain<Dim>& where, double support = 2.6, double skin = 0.2)
      : domain(where), settings{spacing, support * spacing, skin * spacing}, neighbours(settings, where) {
    particles.resize((points.size() + cluster_size - 1) / cluster_size * cluster_size, points.size());
    for (std::size_t s = 0; s < particles.slots(); ++s) {
      particles[id][0][s] = s < points.size() ? static_cast<std::int64_t>(s) : padding_id;
      for (int d = 0; d < Dim; ++d) particles[position][d][s] = s < points.size() ? points[s][d] : 0;
    }
    neighbours.rebuild(particles);
  }
};

template <int Dim> Domain<Dim> domain_between(double lower, double upper, std::array<bool, 3> periodic = {}) {
  Domain<Dim> domain;
  domain.lower.fill(lower);
  domain.upper.fill(upper);
  for (int d = 0; d < Dim; ++d)
    if (periodic[d]) domain.periodic.lower[d] = lower, domain.periodic.period[d] = upper - lower;
  return domain;
}

template <int Dim> Points random_points(int count, double lower, double upper, unsigned seed = 7) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> of(lower, upper);
  Points points(count, {0, 0, 0});
  for (auto& p : points)
    for (int d = 0; d < Dim; ++d) p[d] = of(random);
  return points;
}

template <int Dim> using Image = std::array<int, Dim>;  // periods added to j's position

/// x_i − x_j (m) for one image of j.
template <int Dim> struct ImagePair {
  std::uint32_t i, j;
  Image<Dim> image;
  std::array<double, Dim> x;

  auto key() const { return std::tie(i, j, image); }
  double distance() const {
    double r2 = 0;
    for (const double a : x) r2 += a * a;
    return std::sqrt(r2);
  }
  bool operator<(const ImagePair& b) const { return key() < b.key(); }
};

/// Adds the pairs (i, j) of all images within reach, axis by axis from d on.
template <int Dim>
void add_images(std::vector<ImagePair<Dim>>& pairs, ImagePair<Dim> p, const Domain<Dim>& domain, double reach,
                double r2 = 0, int d = 0) {
  if (r2 >= reach * reach) return;
  if (d == Dim) {
    if (p.i != p.j || p.image != Image<Dim>{}) pairs.push_back(p);
    return;
  }
  const double x = p.x[d], period = domain.periodic.period[d];
  int first = 0, last = 0;
  if (domain.periodic.along(d)) {
    first = static_cast<int>(std::ceil((x - reach) / period));
    last = static_cast<int>(std::floor((x + reach) / period));
  }
  for (p.image[d] = first; p.image[d] <= last; ++p.image[d]) {
    p.x[d] = x - p.image[d] * period;
    add_images(pairs, p, domain, reach, r2 + p.x[d] * p.x[d], d + 1);
  }
}

/// All directed pairs and images within reach by brute force; a particle's own images count, itself does not.
template <int Dim, class Real> std::vector<ImagePair<Dim>> brute_pairs(const Cloud<Dim, Real>& c, double reach) {
  std::vector<ImagePair<Dim>> pairs;
  const auto x = c.particles[position];
  for (std::uint32_t i = 0; i < c.particles.slots(); ++i)
    for (std::uint32_t j = 0; j < c.particles.slots(); ++j) {
      if (c.particles.is_padding(i) || c.particles.is_padding(j)) continue;
      ImagePair<Dim> p{i, j, {}, {}};
      for (int d = 0; d < Dim; ++d) p.x[d] = x[d][i] - x[d][j];
      add_images(pairs, p, c.domain, reach);
    }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Calls f(i, j, x_i − x_j as the pair pass has it) for all listed pairs of particles.
template <int Dim, class Real, class F> void for_each_listed(const Cloud<Dim, Real>& c, F&& f) {
  const auto local = c.particles[local_position];
  for (const ClusterChunk& chunk : c.neighbours.chunks())
    c.neighbours.for_each_list(chunk, [&](std::uint32_t cluster, std::span<const ListEntry> list) {
      for (const ListEntry entry : list) {
        const auto first = static_cast<std::uint32_t>(c.neighbours.shifts().first_slot(entry));
        const auto& shift = c.neighbours.shifts().of(entry);
        for (std::uint32_t i = cluster * cluster_size; i < (cluster + 1) * cluster_size; ++i)
          for (std::uint32_t j = first; j < first + group_size<Real>; ++j) {
            if (c.particles.is_padding(i) || c.particles.is_padding(j)) continue;
            std::array<Real, Dim> v;
            for (int d = 0; d < Dim; ++d) v[d] = (local[d][i] - static_cast<Real>(shift[d])) - local[d][j];
            f(i, j, v);
          }
      }
    });
}

/// The listed pairs with their images, sorted; those far out of reach are left out.
template <int Dim, class Real> std::vector<ImagePair<Dim>> listed_pairs(const Cloud<Dim, Real>& c, double reach) {
  std::vector<ImagePair<Dim>> pairs;
  const auto x = c.particles[position];
  for_each_listed(c, [&](std::uint32_t i, std::uint32_t j, const auto& v) {
    ImagePair<Dim> p{i, j, {}, {}};
    double r2 = 0;
    for (int d = 0; d < Dim; ++d) {
      p.x[d] = v[d];
      r2 += p.x[d] * p.x[d];
      if (c.domain.periodic.along(d))
        p.image[d] = static_cast<int>(std::lround((x[d][i] - x[d][j] - v[d]) / c.domain.periodic.period[d]));
    }
    if (r2 < 2 * reach * reach && (i != j || p.image != Image<Dim>{})) pairs.push_back(p);
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace molten::clouds
