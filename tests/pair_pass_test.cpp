#include "core/pair_pass.h"

#include <gtest/gtest.h>

#include "core/physics/artificial_viscosity.h"
#include "core/physics/continuity.h"
#include "core/physics/heat_conduction.h"
#include "core/physics/laminar_viscosity.h"
#include "core/physics/viscous_stress.h"
#include "core/physics/xsph.h"
#include "tests/particle_sets.h"

namespace molten::pair_pass_test {
namespace {

using namespace particle_sets;

constexpr double alpha = 0.3, viscosity_of_all = 2, diffusivity_of_all = 0.01;

/// All that the passes sum for one particle, with how large each sum's terms are together: what round-off is relative
/// to.
struct Sums {
  static constexpr int size = 14;  // 3 acceleration, 3 XSPH, 6 strain rate, compression rate, temperature rate
  std::array<double, size> value{}, scale{};
  void add(int k, double v) { value[k] += v, scale[k] += std::abs(v); }
};
constexpr int xsph_at = 3, strain_at = 6, compression_at = 12, temperature_at = 13;

/// A scene with every term on, disordered, moving, in the middle of a periodic box or free.
template <int Dim> Scene full_scene(KernelKind kernel, bool periodic, double size) {
  Scene scene = plain_scene(Dim);
  if (periodic) make_periodic(scene, size);
  scene.numerics.kernel = kernel;
  scene.numerics.smoothing_ratio = 2.6 / kernel_reach(kernel);
  scene.numerics.artificial_viscosity = alpha;
  scene.numerics.xsph = Xsph{};
  scene.fluid.heat = Heat{diffusivity_of_all, std::nullopt, 20, 20};
  scene.fluid.rheology.model = Rheology::Model::smd;
  return scene;
}

template <int Dim, class Real> State<Dim, Real> full_state(KernelKind kernel, bool periodic, int cells) {
  const double spacing = 0.1;
  const Scene scene = full_scene<Dim>(kernel, periodic, cells * spacing);
  State<Dim, Real> s = state_of<Dim, Real>(scene, cube<Dim>(cells, spacing, 0.3), spacing);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> of(-1, 1);
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    for (int d = 0; d < Dim; ++d) s.particles[velocity][d][k] = Real(of(random));
    for (int c = 0; c < Dim * (Dim + 1) / 2; ++c) s.particles[stress][c][k] = Real(1e-3 * of(random));
    s.particles[compression][0][k] = Real(0.05 * of(random));
    s.particles[viscosity][0][k] = Real(50 + 40 * of(random));
    s.particles[temperature][0][k] = 20 + 10 * of(random);
  });
  prepare(s);
  return s;
}

/// The textbook formulas, in double and from the true positions: a naive twin of all terms.
template <int Dim, class Real> class Twin {
 public:
  explicit Twin(const State<Dim, Real>& s) : s_(s), p_(s.particles), q_(s.parameters) {}

  Sums of(std::size_t i) const {
    Sums sums;
    for (std::size_t j = 0; j < p_.slots(); ++j) {
      if (p_.is_padding(j) || j == i) continue;
      std::array<double, Dim> x;
      double r2 = 0;
      for (int d = 0; d < Dim; ++d) {
        x[d] = p_[position][d][i] - p_[position][d][j];
        const double period = q_.domain.periodic.period[d];
        if (period > 0) x[d] -= period * std::round(x[d] / period);
        r2 += x[d] * x[d];
      }
      if (r2 < q_.support_radius * q_.support_radius) add_pair(sums, i, j, x, std::sqrt(r2));
    }
    return sums;
  }

 private:
  double density(std::size_t k) const { return q_.eos.rest_density * (1 + double(p_[compression][0][k])); }

  void add_pair(Sums& sums, std::size_t i, std::size_t j, const std::array<double, Dim>& x, double r) const {
    const auto kernel = with_kernel<double>(q_.kernel, Dim, q_.smoothing_length, q_.particle_mass,
                                            [&](const auto& k) { return k(Lanes<double, 1>(r)); });
    const double mW = kernel.w.v, mF = kernel.slope.v, rho_i = density(i), rho_j = density(j), h = q_.smoothing_length;
    std::array<double, Dim> v;
    double vx = 0;
    for (int d = 0; d < Dim; ++d) {
      v[d] = double(p_[velocity][d][i]) - p_[velocity][d][j];
      vx += v[d] * x[d];
    }
    const double mu = h * vx / (r * r + 0.01 * h * h);
    const double pi_ij = vx < 0 ? -alpha * q_.eos.sound_speed * mu / ((rho_i + rho_j) / 2) : 0;
    const double pressure = double(p_[pressure_term][0][i]) + p_[pressure_term][0][j];
    const auto S = [&](int a, int b) {
      const int k = SymTensor<Dim, double>::index(a, b);
      return double(p_[stress][k][i]) + p_[stress][k][j];
    };
    const double rest = damped_approach(i, j, x, vx), eta_i = p_[viscosity][0][i], eta_j = p_[viscosity][0][j];
    const double damping =
        2 * Dim / q_.kernel_second_moment * 2 * eta_i * eta_j / (eta_i + eta_j) * rest / (rho_i * rho_j);
    for (int a = 0; a < Dim; ++a) {
      sums.add(a, damping * mF * x[a]);
      sums.add(a, -(pressure + pi_ij) * mF * x[a]);
      sums.add(a, 2 * viscosity_of_all / (rho_i * rho_j) * mF * v[a]);
      sums.add(xsph_at + a, -2 / (rho_i + rho_j) * v[a] * mW);
      for (int b = 0; b < Dim; ++b) sums.add(a, S(a, b) * mF * x[b]);
      for (int b = a; b < Dim; ++b)
        sums.add(strain_at + SymTensor<Dim, double>::index(a, b),
                 -q_.eos.rest_density / rho_j * mF * (v[a] * x[b] + v[b] * x[a]));
    }
    sums.add(compression_at, mF * vx);
    const double dT = double(p_[local_temperature][0][i]) - p_[local_temperature][0][j];
    sums.add(temperature_at, 4 * diffusivity_of_all / (rho_i + rho_j) * dT * mF);
  }

  /// v·x − ¼ x·(D_i + D_j)·x, with D = ρ²/η of the kept stress.
  double damped_approach(std::size_t i, std::size_t j, const std::array<double, Dim>& x, double vx) const {
    double rest = vx;
    for (const std::size_t k : {i, j})
      for (int a = 0; a < Dim; ++a)
        for (int b = 0; b < Dim; ++b)
          rest -= 0.25 * density(k) * density(k) / p_[viscosity][0][k] *
                  p_[stress][SymTensor<Dim, double>::index(a, b)][k] * x[a] * x[b];
    return rest;
  }

  const State<Dim, Real>& s_;
  const Particles<Dim, Real>& p_;
  const Parameters<Dim>& q_;
};

/// The same sums by the fused pass on N lanes.
template <int N, int Dim, class Real> std::vector<Sums> fused(const State<Dim, Real>& s, bool on = true) {
  const Parameters<Dim>& q = s.parameters;
  const double rho0 = q.eos.rest_density;
  std::vector<Sums> all(s.particles.slots());
  const PlainFinish finish{[&](std::size_t slot, const auto& sums) {
    Sums& out = all[slot];
    for (int d = 0; d < Dim; ++d) {
      out.value[d] = sums[acceleration][d];
      out.value[xsph_at + d] = sums[xsph_velocity][d];
    }
    for (int c = 0; c < Dim * (Dim + 1) / 2; ++c) out.value[strain_at + c] = sums[strain_rate][c];
    out.value[compression_at] = sums[compression_rate];
    out.value[temperature_at] = sums[temperature_rate];
  }};
  with_kernel<Real>(q.kernel, Dim, q.smoothing_length, q.particle_mass, [&](const auto& kernel) {
    pair_pass<N>(s.neighbours, s.particles, kernel, finish, Continuity{}, PressureForce{}, StrainRateTerm{},
                 ArtificialViscosity<Real>(on ? alpha : 0, q.eos.sound_speed, q.smoothing_length, rho0),
                 LaminarViscosity<Real>(on ? viscosity_of_all : 0, rho0),
                 StressForce<Dim, Real>(on, 1000, q.kernel_second_moment),
                 HeatConduction<Real>(on ? diffusivity_of_all : 0, rho0), XsphTerm<Real>(on, rho0));
  });
  return all;
}

/// Largest error of any sum, relative to the sum of its terms' sizes.
template <int Dim, class Real> double worst_error(const State<Dim, Real>& s, const std::vector<Sums>& sums) {
  const Twin<Dim, Real> twin(s);
  double worst = 0;
  for_each_particle(s.particles, [&](std::size_t i, const auto&) {
    const Sums expected = twin.of(i);
    for (int k = 0; k < Sums::size; ++k) {
      const double error = std::abs(sums[i].value[k] - expected.value[k]);
      if (error > 0) worst = std::max(worst, error / expected.scale[k]);
    }
  });
  return worst;
}

template <class F> class PairPassOf : public testing::Test {};
TYPED_TEST_SUITE(PairPassOf, Flavours, FlavourNames);

/// Round-off of sums of some 100 terms, and positions good to 1e-6 spacings (in double 1e-12) in kernels whose slope
/// changes by tens of percent over a spacing. Spiky and quadratic have a slope at r = 0, where 1/r magnifies more: they
/// reach 1e-5 and 9e-12, the others 3e-6 and 3e-12.
template <class Real> double tolerance() { return std::is_same_v<Real, float> ? 2e-5 : 3e-11; }

TYPED_TEST(PairPassOf, AllTermsEqualTheNaiveTwin) {
  constexpr int Dim = TypeParam::dim;
  using Real = typename TypeParam::Real;
  for (const bool periodic : {false, true})
    for (int kind = 0; kind < 7; ++kind) {
      const auto s = full_state<Dim, Real>(KernelKind(kind), periodic, Dim == 2 ? 18 : 8);
      SCOPED_TRACE(testing::Message() << "kernel " << kind << ", periodic " << periodic);
      EXPECT_LT((worst_error<Dim, Real>(s, fused<native_lanes<Real>>(s))), tolerance<Real>());
      EXPECT_LT((worst_error<Dim, Real>(s, fused<1>(s))), tolerance<Real>());
    }
}

TYPED_TEST(PairPassOf, OffTermsAddNothing) {
  constexpr int Dim = TypeParam::dim;
  using Real = typename TypeParam::Real;
  auto s = full_state<Dim, Real>(KernelKind::wendland_c2, false, 7);
  for_each_particle(s.particles, [&](std::size_t k, const auto&) { s.particles[pressure_term][0][k] = 0; });
  const auto sums = fused<native_lanes<Real>>(s, false);
  for (const Sums& one : sums) {
    for (int d = 0; d < Dim; ++d) EXPECT_EQ(one.value[d], 0);
    for (int d = 0; d < Dim; ++d) EXPECT_EQ(one.value[xsph_at + d], 0);
    EXPECT_EQ(one.value[temperature_at], 0);
  }
}

TYPED_TEST(PairPassOf, PaddingAndLonelyParticlesSumNothing) {
  constexpr int Dim = TypeParam::dim;
  using Real = typename TypeParam::Real;
  Points far = cube<Dim>(3, 1.0);
  auto s = state_of<Dim, Real>(full_scene<Dim>(KernelKind::spiky, false, 0), far, 0.1);
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    for (int d = 0; d < Dim; ++d) s.particles[velocity][d][k] = Real(k + d);
    s.particles[pressure_term][0][k] = 1;
  });
  ASSERT_LT(s.particles.count(), s.particles.slots());
  for (const Sums& one : fused<native_lanes<Real>>(s))
    for (int k = 0; k < Sums::size; ++k) EXPECT_EQ(one.value[k], 0);
}

TYPED_TEST(PairPassOf, WhatIsExchangedIsConserved) {
  // Equal masses, so Σ a, Σ XSPH and Σ dT/dt vanish: each pair's two halves are equal and opposite.
  constexpr int Dim = TypeParam::dim;
  using Real = typename TypeParam::Real;
  for (const bool periodic : {false, true}) {
    const auto s = full_state<Dim, Real>(KernelKind::wendland_c2, periodic, Dim == 2 ? 30 : 10);
    Sums total;
    for (const Sums& one : fused<native_lanes<Real>>(s))
      for (int k = 0; k < Sums::size; ++k) total.add(k, one.value[k]);
    const double epsilon = std::is_same_v<Real, float> ? 2e-6 : 1e-13;
    for (int d = 0; d < Dim; ++d) EXPECT_LT(std::abs(total.value[d]), epsilon * total.scale[d]);
    for (int d = 0; d < Dim; ++d) EXPECT_LT(std::abs(total.value[xsph_at + d]), epsilon * total.scale[xsph_at + d]);
    EXPECT_LT(std::abs(total.value[temperature_at]), epsilon * total.scale[temperature_at]);
  }
}

// A term that reads what a term of the same pass sums does not compile: pair_pass() requires Fusable<Terms...>.
struct ReadsAcceleration {
  using Reads = FieldList<Velocity, Acceleration>;
  using Sums = FieldList<KernelSum>;
};
struct SumsStress {
  using Reads = FieldList<Velocity>;
  using Sums = FieldList<Stress>;
};

TEST(PairPass, OnlyIndependentTermsFuse) {
  static_assert(Fusable<Continuity, PressureForce, ArtificialViscosity<float>, LaminarViscosity<float>,
                        StressForce<3, float>, HeatConduction<float>, XsphTerm<float>>);
  static_assert(Fusable<StrainRateTerm>);
  static_assert(Fusable<ReadsAcceleration>);
  static_assert(!Fusable<PressureForce, ReadsAcceleration>);
  static_assert(!Fusable<ReadsAcceleration, Continuity, PressureForce>);
  static_assert(!Fusable<StressForce<3, float>, SumsStress>);
  static_assert(!disjoint<FieldList<Velocity, Compression>, FieldList<Compression>>);
  static_assert(disjoint<FieldList<>, FieldList<Compression>>);
}

}  // namespace
}  // namespace molten::pair_pass_test
