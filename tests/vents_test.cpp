// Vents and outflow: what enters is what was asked, without a jump of density; what leaves is gone; columns grow
// rarely.
#include "core/vents.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/diagnostics.h"
#include "tests/contact_shapes.h"
#include "tests/flavours.h"
#include "tests/particle_sets.h"

namespace molten::vents_test {
namespace {

constexpr double spacing = 0.02;

template <int Dim> VentPatch<Dim> upward(double radius, double rate) {
  VentPatch<Dim> patch;
  patch.normal = Point<Dim>::Unit(Dim - 1);
  patch.offsets = disc_offsets<Dim>(patch.normal, radius, spacing);
  patch.table = {{0, rate, 0}};
  return patch;
}

TEST(VentPatch, VolumeIsTheIntegralOfTheTable) {
  VentPatch<2> patch;
  patch.table = {{1, 2, 100}, {3, 6, 200}, {4, 0, 200}};
  EXPECT_NEAR(patch.volume(0, 1), 2, 1e-14);
  EXPECT_NEAR(patch.volume(1, 3), 8, 1e-14);
  EXPECT_NEAR(patch.volume(0, 5), 2 + 8 + 3 + 0, 1e-14);
  EXPECT_NEAR(patch.volume(1.5, 3.5), (3 + 6) * 1.5 / 2 + (6 + 3) * 0.5 / 2, 1e-14);
  double steps = 0;  // the sum over any steps is the whole
  for (int k = 0; k < 777; ++k) steps += patch.volume(5.0 * k / 777, 5.0 * (k + 1) / 777);
  EXPECT_NEAR(steps, 13, 1e-12);
  EXPECT_EQ(patch.temperature(0), 100);
  EXPECT_EQ(patch.temperature(2), 150);
  EXPECT_EQ(patch.temperature(9), 200);
}

TEST(VentPatch, OffsetsFillTheDisc) {
  const Point<3> n = Point<3>(1, 2, -1).normalized();
  const auto disc = disc_offsets<3>(n, 0.2, spacing);
  EXPECT_NEAR(static_cast<double>(disc.size()) * spacing * spacing, M_PI * 0.04, 0.003);
  for (const auto& x : disc) EXPECT_NEAR(x.dot(n), 0, 1e-15);
  EXPECT_EQ(disc_offsets<2>({0, 1}, 0.1, spacing).size(), 10u);
  EXPECT_EQ(disc_offsets<2>({0, 1}, 0.0001, spacing).size(), 1u);
}

/// A shaft with slippery walls, filled from its floor; a vent as wide as the shaft. In 3-D a square one.
template <int Dim> std::vector<Wall<Dim>> shaft(double half) {
  std::vector<Wall<Dim>> walls;
  for (int d = 0; d < Dim - 1; ++d)
    for (const double side : {-1.0, 1.0})
      walls.push_back(contact_test::plane<Dim>(side * half * Point<Dim>::Unit(d), -side * Point<Dim>::Unit(d), {0, 1}));
  return walls;
}

template <int Dim> VentPatch<Dim> floor_of_shaft(int cells, double rate) {
  VentPatch<Dim> patch = upward<Dim>(spacing, rate);
  patch.offsets.clear();
  for (int k = 0; k < (Dim == 3 ? cells * cells : cells); ++k) {
    Point<Dim> x = Point<Dim>::Zero();
    x[0] = (k % cells + 0.5 - 0.5 * cells) * spacing;
    if (Dim == 3) x[1] = (k / cells + 0.5 - 0.5 * cells) * spacing;
    patch.offsets.push_back(x);
  }
  return patch;
}

template <class F> class VentFlow : public ::testing::Test {};
TYPED_TEST_SUITE(VentFlow, Flavours, FlavourNames);

TYPED_TEST(VentFlow, FillsAShaftAtTheAskedRateWithoutABurst) {
  constexpr int dim = TypeParam::dim;
  using Real = typename TypeParam::Real;
  const int cells = dim == 2 ? 10 : 5;
  const double half = 0.5 * cells * spacing, area = std::pow(cells * spacing, dim - 1), speed = 0.5;
  Scene scene = particle_sets::plain_scene(dim);
  scene.gravity[dim - 1] = -9.81;
  scene.numerics.artificial_viscosity = 0.2;
  scene.numerics.sound_speed = 30;
  Features features = features_of(scene);
  features.contact = features.vents = true;
  Start start;
  start.spacing = spacing;
  start.vents = {{0, 0, 0}};
  const double support = 2.6 * spacing;
  auto s = make_state<dim, Real>(features, parameters_of<dim>(scene, start),
                                 {Contact<dim>(shaft<dim>(half), spacing / 2, support),
                                  {},
                                  Vents<dim>({floor_of_shaft<dim>(cells, speed * area)}, spacing, support)},
                                 start);
  const auto waiting = static_cast<std::int64_t>(s.particles.count());
  double densest = 0, jump = 0;
  std::set<std::size_t> sizes;
  std::vector<double> before;
  while (s.clock.time < 0.8) {
    step(s);
    sizes.insert(s.particles.bytes());
    const Diagnostics d = diagnose(s);
    densest = std::max(densest, d.max_compression);
    const double asked = speed * area * s.clock.time;
    const double got = static_cast<double>(d.particles - waiting) * std::pow(spacing, dim);
    jump = std::max(jump, std::abs(got - asked) / std::pow(spacing, dim) / static_cast<double>(waiting));
  }
  // The hydrostatic g H/c² is 0.0044; a column that is stopped dead would show the water hammer v/c.
  EXPECT_LT(densest, speed / 30);
  EXPECT_LT(jump, 0.3) << "of the layers that wait: never more than one layer ahead or behind";
  const Diagnostics d = diagnose(s);
  EXPECT_NEAR(d.upper[dim - 1], speed * s.clock.time, 1.5 * spacing) << "the level";
  EXPECT_LT(sizes.size(), 30u) << "columns are allocated now and then, not with every layer";
}

TEST(VentFlow, WhatPassesAnOutflowIsGoneAndIdsGoOn) {
  Scene scene = particle_sets::plain_scene(2);
  scene.outflows = {{{0, 0.2, 0}, {0, 1, 0}}};
  Features features = features_of(scene);
  features.vents = true;
  Start start;
  start.spacing = spacing;
  start.vents = {{0, 0, 0}};
  start.vent_speed = 1;
  auto s = make_state<2, float>(
      features, parameters_of<2>(scene, start),
      {Contact<2>({}, spacing / 2, 1), {}, Vents<2>({upward<2>(0.05, 0.1)}, spacing, 2.6 * spacing)}, start);
  while (s.clock.time < 0.6) step(s);
  const Diagnostics d = diagnose(s);
  EXPECT_LT(d.upper[1], 0.2 + spacing);
  std::set<std::int64_t> ids;
  particle_sets::for_each_particle(s.particles, [&](std::size_t k, const auto&) { ids.insert(s.particles[id][0][k]); });
  EXPECT_EQ(ids.size(), s.particles.count()) << "no id twice";
  EXPECT_EQ(ids.size(), static_cast<std::size_t>(d.particles));
  EXPECT_GT(*ids.rbegin(), d.particles + 50) << "others have left";
  EXPECT_EQ(s.neighbours.dropped(), 0u) << "by their own way, not out of the domain";
}

}  // namespace
}  // namespace molten::vents_test
