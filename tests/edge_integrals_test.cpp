// What lies beyond an edge, from the tables, against quadrature along it.
#include "core/boundary/edge_integrals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/boundary/gauss.h"

namespace molten::edge_integrals_test {
namespace {

constexpr double smoothing_length = 1.3;

/// ∫ over the edge: of P p/ρ² for what is beyond it, of P along it; t = p sinh s crowds the nodes near the foot.
EdgeIntegrals::Beyond quadrature(const RadialIntegrals& radial, double h, double p) {
  const Gauss<16> rule;
  const int pieces = 20;
  const double last = std::asinh(std::sqrt(radial.reach() * radial.reach() - h * h - p * p) / p);
  EdgeIntegrals::Beyond sum{0, 0, 0};
  for (int k = 0; k < pieces; ++k) {
    const auto integral = [&](auto&& f) { return 2 * rule(k * last / pieces, (k + 1) * last / pieces, f); };
    const auto distance = [&](double s) { return std::hypot(h, p * std::cosh(s)); };
    sum.weight += integral([&](double s) { return radial.weight_beyond(distance(s)) / std::cosh(s); });
    sum.hidden +=
        integral([&](double s) { return h * radial.hidden_beyond(distance(s)) / distance(s) / std::cosh(s); });
    sum.along += integral([&](double s) { return radial.weight_beyond(distance(s)) * p * std::cosh(s); });
  }
  return sum;
}

TEST(EdgeIntegrals, TablesAreAsQuadrature) {
  for (const auto kind : {KernelKind::wendland_c2, KernelKind::cubic_spline, KernelKind::gaussian, KernelKind::spiky}) {
    const RadialIntegrals radial(kind, 3, smoothing_length);
    const EdgeIntegrals edge(radial);
    const double reach = radial.reach(), whole = radial.plane(1e-9).weight;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> even(0, 1);
    for (int n = 0; n < 2000; ++n) {
      const double near = n % 3 == 0 ? 0.03 : 1;  // the hidden part depends on the angle alone there
      const double h = near * reach * even(random), p = (n % 5 == 0 ? 0.01 : 1) * near * reach * even(random);
      if (h * h + p * p >= reach * reach) continue;
      const auto is = edge.beyond(h, p), should = quadrature(radial, h, p);
      const std::string place = std::to_string(h / reach) + ' ' + std::to_string(p / reach);
      ASSERT_NEAR(is.weight, should.weight, 4e-5 * whole) << place;
      ASSERT_NEAR(is.hidden, should.hidden, 1e-5) << place;
      ASSERT_NEAR(is.along, should.along, 4e-5 * whole * reach) << place;
    }
  }
}

TEST(EdgeIntegrals, AnEdgeUnderTheParticleHalvesThePlane) {
  const RadialIntegrals radial(KernelKind::wendland_c2, 3, smoothing_length);
  const EdgeIntegrals edge(radial);
  for (const double h : {0.01, 0.4, 1.0, 2.0}) {
    EXPECT_NEAR(edge.beyond(h, 0).weight, radial.plane(h).weight / 2, 2e-5);
    EXPECT_NEAR(edge.beyond(h, 0).hidden, radial.plane(h).hidden / 2, 1e-5);
  }
  EXPECT_EQ(edge.beyond(radial.reach(), 0).weight, 0);
  EXPECT_EQ(edge.beyond(0.5, radial.reach()).hidden, 0);
}

}  // namespace
}  // namespace molten::edge_integrals_test
