// More of the sources' misprints: energy ([Q] 3.53, 4.8; [D] 4.7), gradients ([D] 3.9 to 3.11) and figures of [D].
#include <gtest/gtest.h>

#include <numbers>

#include "tests/particle_sets.h"

namespace molten::energy_misprints_test {
namespace {

using namespace particle_sets;

constexpr double spacing = 0.1, pi = std::numbers::pi;

// ---- energy-bounded step, [Q] 3.51-3.53 -----------------------------------------------------------------------------

/// The bound A α² + B α + C ≤ 0 of one particle when the outer force is gravity alone, surplus 0.
struct Bound {
  double A, B, C;
  Bound(const Eigen::Vector3d& v, const Eigen::Vector3d& a, const Eigen::Vector3d& g, double dt)
      : A(dt * dt * a.squaredNorm() / 2), B(dt * a.dot(v)), C(-dt * dt * g.squaredNorm() / 2) {}

  double root() const { return std::sqrt(B * B - 4 * A * C); }
  /// The largest α in [0, 1], by the form of the larger root that does not cancel.
  double largest() const {
    if (A == 0) return 1;
    return std::min(1.0, B <= 0 ? (-B + root()) / (2 * A) : -2 * C / (B + root()));
  }
  /// [Q]'s rule: the root nearest to 1, cut to [0, 1].
  double nearest_to_one() const {
    const double low = (-B - root()) / (2 * A), high = (-B + root()) / (2 * A);
    return std::clamp(std::abs(low - 1) < std::abs(high - 1) ? low : high, 0.0, 1.0);
  }
};

/// Energy per mass gained by a step with α, as the equations 3.51 and 3.52 move it.
double energy_gained(const Eigen::Vector3d& v, const Eigen::Vector3d& a, const Eigen::Vector3d& g, double dt,
                     double alpha) {
  const Eigen::Vector3d after = v + dt * g + alpha * dt * a, way = dt * after;
  return -g.dot(way) + after.squaredNorm() / 2 - v.squaredNorm() / 2;
}

TEST(Misprints, Q_3_53_TheLargestAlphaNotTheNearestRoot) {
  const Eigen::Vector3d g(0, 0, -9.81);
  const Bound braking({1, 0, 0}, {-5, 0, 0}, g, 1e-3);
  EXPECT_EQ(braking.largest(), 1);
  EXPECT_EQ(braking.nearest_to_one(), 0);
  EXPECT_LT(energy_gained({1, 0, 0}, {-5, 0, 0}, g, 1e-3, 1), 0) << "and yet α = 1 loses energy";
}

TEST(Misprints, Q_3_53_TheLargestAlphaKeepsTheBound) {
  std::mt19937 random(1);
  std::normal_distribution<double> of;
  const auto vector = [&](double size) {
    return Eigen::Vector3d(size * of(random), size * of(random), size * of(random));
  };
  const Eigen::Vector3d g(0, 0, -9.81);
  int wrong = 0;
  constexpr int cases = 20000;
  for (int k = 0; k < cases; ++k) {
    const double dt = 0.002;
    const Eigen::Vector3d v = vector(1), a = vector(50);
    const Bound bound(v, a, g, dt);
    const double alpha = bound.largest();
    EXPECT_LE(energy_gained(v, a, g, dt, alpha), 1e-12);
    if (alpha < 1) {
      EXPECT_GT(energy_gained(v, a, g, dt, alpha * 1.001 + 1e-9), 0);
    }
    wrong += std::abs(bound.nearest_to_one() - alpha) > 1e-9;
  }
  EXPECT_GT(wrong, cases / 5) << "how often the printed rule picks wrongly";
}

// ---- internal energy ------------------------------------------------------------------------------------------------

/// A disordered periodic square with pressure, artificial viscosity and viscous stress; the velocities are random.
State<2, double> stirred() {
  constexpr int cells = 14;
  Scene scene = plain_scene(2);
  make_periodic(scene, cells * spacing);
  scene.numerics.artificial_viscosity = 1;
  scene.fluid.rheology.model = Rheology::Model::smd;
  auto s = state_of<2, double>(scene, cube<2>(cells, spacing, 0.2), spacing);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> of(-1, 1);
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    for (int d = 0; d < 2; ++d) s.particles[velocity][d][k] = of(random);
    s.particles[compression][0][k] = 0.02 * of(random);
    for (int c = 0; c < 3; ++c) s.particles[stress][c][k] = 1e-3 * of(random);
  });
  prepare(s);
  find_rates(s);
  return s;
}

/// What the energy equations need of a pair.
struct PairEnergy {
  double rho_i, rho_j, p_i, p_j, vx, pi_ij, vSx;  // Π_ij; v_ij · (S_i/ρ_i² + S_j/ρ_j²) x_ij
};

PairEnergy energy_of(const State<2, double>& s, const NaivePair& p) {
  const auto& q = s.parameters;
  const auto delta = s.particles[compression][0];
  PairEnergy e{};
  e.rho_i = 1000 * (1 + delta[p.i]), e.rho_j = 1000 * (1 + delta[p.j]);
  e.p_i = q.eos.pressure(delta[p.i]), e.p_j = q.eos.pressure(delta[p.j]);
  Vec<2, double> v, x;
  for (int d = 0; d < 2; ++d) {
    v[d] = s.particles[velocity][d][p.i] - s.particles[velocity][d][p.j];
    x[d] = p.x[d];
  }
  e.vx = dot(v, x);
  const double h = q.smoothing_length, mu = h * e.vx / (p.r * p.r + 0.01 * h * h);
  e.pi_ij = e.vx < 0 ? -q.artificial_viscosity * q.eos.sound_speed * mu / ((e.rho_i + e.rho_j) / 2) : 0;
  e.vSx = dot(v, (s.particles[stress].of(p.i) + s.particles[stress].of(p.j)) * x);
  return e;
}

/// Σ m v · a of the run's accelerations, W per m of depth.
double kinetic_power(const State<2, double>& s) {
  double power = 0;
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    for (int d = 0; d < 2; ++d)
      power += s.parameters.particle_mass * s.particles[velocity][d][k] * s.particles[acceleration][d][k];
  });
  return power;
}

TEST(Misprints, D_4_7_InternalEnergyNeedsTheMass) {
  // de_i/dt = ½ Σ m_j [(p_i/ρ_i² + p_j/ρ_j² + Π) v·∇W − v·(S_i/ρ_i² + S_j/ρ_j²)·∇W] takes what motion gives, to
  // round-off. Printed without m_j.
  const auto s = stirred();
  const double mass = s.parameters.particle_mass, motion = kinetic_power(s);
  double heat = 0;
  for_each_pair(s, [&](const NaivePair& p) {
    const PairEnergy e = energy_of(s, p);
    const double pressure = e.p_i / (e.rho_i * e.rho_i) + e.p_j / (e.rho_j * e.rho_j) + e.pi_ij;
    heat += mass * 0.5 * p.mF * (pressure * e.vx - e.vSx);
  });
  EXPECT_NEAR(heat / motion, -1, 1e-9);
  EXPECT_GT(std::abs(heat / mass / motion + 1), 0.05) << "printed";
}

TEST(Misprints, Q_4_8_ClosesWithTheFullForceOnly) {
  // Its (p_i + p_j)/(ρ_i ρ_j) belongs to the force −Σ m_j (p_i + p_j)/(ρ_i ρ_j) ∇W, not to the half that is printed.
  const auto s = stirred();
  double heat = 0, full = 0, half = 0;
  for_each_pair(s, [&](const NaivePair& p) {
    const PairEnergy e = energy_of(s, p);
    heat += 0.5 * p.mF * (e.p_i + e.p_j) / (e.rho_i * e.rho_j) * e.vx;
    double v_dot_x = 0;  // the velocity of i alone: the work on i
    for (int d = 0; d < 2; ++d) v_dot_x += s.particles[velocity][d][p.i] * p.x[d];
    full -= p.mF * (e.p_i + e.p_j) / (e.rho_i * e.rho_j) * v_dot_x;
    half -= p.mF * (e.p_i + e.p_j) / 2 / (e.rho_i * e.rho_j) * v_dot_x;
  });
  EXPECT_NEAR(full / heat, -1, 1e-9);
  EXPECT_NEAR(half / heat, -0.5, 1e-9);
}

// ---- gradients ------------------------------------------------------------------------------------------------------

/// Sums over the neighbours of every particle of a field A, x components, for densities that vary by tens of percent.
struct Gradients {
  double of_density = 0, of_product = 0;  // Σ m_b ∇W, Σ m_b A_b ∇W
  double difference = 0, symmetric = 0;   // Σ m_b (A_b − A_a) ∇W, Σ m_b (A_a/ρ_a² + A_b/ρ_b²) ∇W
  double printed_difference = 0;          // Σ m_b/ρ_b (A_b − A_a) ∇W
  double of_quotient = 0;                 // Σ m_b A_b/ρ_b² ∇W
};

struct DenseAndThin {
  State<2, double> s = stirred();
  std::vector<double> A, rho;
  std::vector<Gradients> sums;

  DenseAndThin() : A(s.particles.slots()), rho(A), sums(A.size()) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> of(0.7, 1.3);
    for (std::size_t k = 0; k < A.size(); ++k) A[k] = of(random), rho[k] = 1000 * of(random);
    for_each_pair(s, [&](const NaivePair& p) {
      const double g = p.mF * p.x[0], Aa = A[p.i], Ab = A[p.j], ra = rho[p.i], rb = rho[p.j];
      Gradients& sum = sums[p.i];
      sum.of_density += g;
      sum.of_product += g * Ab;
      sum.difference += g * (Ab - Aa);
      sum.symmetric += g * (Aa / (ra * ra) + Ab / (rb * rb));
      sum.printed_difference += g / rb * (Ab - Aa);
      sum.of_quotient += g * Ab / (rb * rb);
    });
  }
};

/// Is left == right for every particle?
template <class Left, class Right> bool holds(const DenseAndThin& all, Left&& left, Right&& right) {
  bool all_hold = true;
  for_each_particle(all.s.particles, [&](std::size_t k, const auto&) {
    const double l = left(k), r = right(k);
    all_hold = all_hold && std::abs(l - r) <= 1e-9 * (std::abs(l) + std::abs(r));
  });
  return all_hold;
}

TEST(Misprints, D_3_9_DividesByTheOwnDensity) {
  // Of ρ∇A = ∇(ρA) − A∇ρ follows ∇A_a = Σ m_b/ρ_a (A_b − A_a) ∇W; printed m_b/ρ_b.
  const DenseAndThin all;
  const auto identity = [&](std::size_t k) { return all.sums[k].of_product - all.A[k] * all.sums[k].of_density; };
  EXPECT_TRUE(holds(all, identity, [&](std::size_t k) { return all.rho[k] * (all.sums[k].difference / all.rho[k]); }));
  EXPECT_FALSE(holds(all, identity, [&](std::size_t k) { return all.rho[k] * all.sums[k].printed_difference; }));
}

TEST(Misprints, D_3_10_HasAPlus) {
  // ∇A/ρ = ∇(A/ρ) + (A/ρ²) ∇ρ; printed with −.
  const auto A = [](double x) { return std::sin(3 * x); };
  const auto rho = [](double x) { return 2 + x * x; };
  const auto slope = [](auto&& f, double x) { return (f(x + 1e-5) - f(x - 1e-5)) / 2e-5; };
  const double x = 0.7, quotient = slope([&](double y) { return A(y) / rho(y); }, x);
  const double extra = A(x) / (rho(x) * rho(x)) * slope(rho, x);
  EXPECT_NEAR(slope(A, x) / rho(x), quotient + extra, 1e-8);
  EXPECT_GT(std::abs(slope(A, x) / rho(x) - (quotient - extra)), 0.1);
}

TEST(Misprints, D_3_11_IsMultipliedByTheOwnDensity) {
  // ∇A_a = ρ_a Σ m_b (A_b/ρ_b² + A_a/ρ_a²) ∇W from the identity above; printed without ρ_a.
  const DenseAndThin all;
  const auto identity = [&](std::size_t k) {
    return all.rho[k] * (all.sums[k].of_quotient + all.A[k] / (all.rho[k] * all.rho[k]) * all.sums[k].of_density);
  };
  EXPECT_TRUE(holds(all, identity, [&](std::size_t k) { return all.rho[k] * all.sums[k].symmetric; }));
  EXPECT_FALSE(holds(all, identity, [&](std::size_t k) { return all.sums[k].symmetric; }));
}

// ---- constants and figures of [D] -----------------------------------------------------------------------------------

TEST(Misprints, D_3_20_And_3_24_KernelConstants) {
  // ∫W of the shapes without their constants: 1 for the quadratic in 1-D, 16π/21 for Wendland in 3-D, at h = 1.
  EXPECT_NEAR(kernel_constant(KernelKind::quadratic, 1) * 1, 1, 1e-12);
  EXPECT_NEAR(kernel_constant(KernelKind::wendland_c2, 3) * 16 * pi / 21, 1, 1e-12);
  EXPECT_GT(std::abs(7 / (8 * pi) * 16 * pi / 21 - 1), 0.3) << "printed";
}

TEST(Misprints, D_Table_6_3_Percentages) {
  const auto percent = [](double experiment, double computed) { return 100 * (experiment - computed) / experiment; };
  EXPECT_NEAR(percent(22.0, 19.1), 13.18, 0.005);  // as printed
  EXPECT_NEAR(percent(36.0, 36.2), -0.56, 0.005);  // printed 0.05
  EXPECT_NEAR(percent(36.0, 34.9), 3.06, 0.005);   // printed 3.00
}

TEST(Misprints, SPHysicsRepulsionSumsToOne) {
  // P(ξ) = ½ (1 + cos(π ξ/Δb)) of the two boundary particles around a point; the 2πξ of a printed guide does not.
  const auto P = [](double xi, double factor) { return (1 + std::cos(factor * pi * xi)) / 2; };
  for (const double xi : {0.0, 0.2, 0.5, 0.9}) EXPECT_NEAR(P(xi, 1) + P(1 - xi, 1), 1, 1e-12);
  EXPECT_GT(std::abs(P(0.5, 2) + P(0.5, 2) - 1), 0.5);
}

}  // namespace
}  // namespace molten::energy_misprints_test
