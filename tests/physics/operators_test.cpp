// The discrete operators on lattices, away from the borders: linear fields, quadratic fields and their known factors.
#include <gtest/gtest.h>

#include <functional>

#include "core/physics/viscous_stress.h"
#include "tests/particle_sets.h"

namespace molten::operators_test {
namespace {

using namespace particle_sets;

constexpr double spacing = 0.1;

/// A free lattice cube wide enough to have particles two supports from every border.
template <int Dim> struct Block {
  Scene scene = plain_scene(Dim);
  int cells = Dim == 2 ? 24 : 16;
  double size = cells * spacing;

  template <class Real> State<Dim, Real> state() const {
    return state_of<Dim, Real>(scene, cube<Dim>(cells, spacing), spacing);
  }
};

/// Calls f(slot, x) for the particles two supports or more inside, and requires that there are some.
template <int Dim, class Real, class F> void for_each_inner(const State<Dim, Real>& s, double size, F&& f) {
  int count = 0;
  for_each_particle(s.particles, [&](std::size_t k, const auto& x) {
    if (!well_inside<Dim>(x, size, 2.01 * s.parameters.support_radius)) return;
    ++count;
    f(k, x);
  });
  EXPECT_GT(count, 0);
}

/// −Σ V W'/r of(x, r) over a lattice, x from the particle in its middle.
template <int Dim, class F> double lattice_sum(const Parameters<Dim>& p, F&& of) {
  const auto points = cube<Dim>(15, p.spacing);
  const auto& middle = points[points.size() / 2];
  double sum = 0;
  for (const auto& point : points) {
    const std::array<double, 3> x{point[0] - middle[0], point[1] - middle[1], point[2] - middle[2]};
    const double r = std::hypot(x[0], x[1], x[2]);
    if (r == 0 || r >= p.support_radius) continue;
    sum -= kernel_at(p, r).mF * std::pow(p.spacing, Dim) / p.particle_mass * of(x, r);
  }
  return sum;
}

/// What a lattice makes of the gradient of a linear field: −(1/d) Σ V W' r, near 1.
template <int Dim> double gradient_factor(const Parameters<Dim>& p) {
  return lattice_sum(p, [](const auto&, double r) { return r * r / Dim; });
}

/// What a lattice makes of the mean of x² y²/r⁴ over directions, 1/(d(d+2)): −(d+2) Σ V W' x² y²/r³, near 1.
template <int Dim> double mixed_factor(const Parameters<Dim>& p) {
  return lattice_sum(p, [](const auto& x, double r) { return (Dim + 2) * x[0] * x[0] * x[1] * x[1] / (r * r); });
}

/// What a lattice makes of −(d/m₂) ∫ W' x² y²/r dV, near 1.
template <int Dim> double spread_factor(const Parameters<Dim>& p) {
  return lattice_sum(p,
                     [&](const auto& x, double) { return Dim / p.kernel_second_moment * x[0] * x[0] * x[1] * x[1]; });
}

template <class F> class OperatorsOf : public testing::Test {};
TYPED_TEST_SUITE(OperatorsOf, Flavours, FlavourNames);

/// Round-off of such sums.
template <class Real> constexpr double digits = sizeof(Real) == 4 ? 1e-5 : 1e-10;

TYPED_TEST(OperatorsOf, KnownFactors) {
  MOLTEN_FLAVOUR;
  Block<Dim> block;
  EXPECT_NEAR(gradient_factor(block.template state<Real>().parameters), Dim == 2 ? 0.974 : 0.979, 5e-4);
  block.scene.numerics.smoothing_ratio = 2;
  EXPECT_NEAR(gradient_factor(block.template state<Real>().parameters), 0.999, 1e-3);
}

TYPED_TEST(OperatorsOf, ContinuityOfLinearFlows) {
  // dρ/dt = −ρ ∇·v: expansion thins, rotation and shear do not.
  MOLTEN_FLAVOUR;
  const Block<Dim> block;
  auto s = block.template state<Real>();
  const double factor = gradient_factor(s.parameters);
  const auto expect_rate = [&](double divergence, auto&& flow) {
    set_velocity(s, flow);
    find_rates(s);
    for_each_inner(s, block.size, [&](std::size_t k, const auto&) {
      EXPECT_NEAR(s.particles[compression_rate][0][k], -divergence * factor, 20 * digits<Real>);
    });
  };
  using X = std::array<double, 3>;
  expect_rate(Dim, [](const X& x) { return x; });
  expect_rate(3, [](const X& x) { return X{3 * x[0], 0, 0}; });
  expect_rate(0, [](const X& x) { return X{x[1], -x[0], 0}; });
  expect_rate(0, [](const X& x) { return X{2 * x[1], 0, x[1]}; });
  expect_rate(0, [](const X&) { return X{5, -3, 2}; });
}

/// With the SMD terms on: find_viscosity gives viscosity and stress, D is stress ρ² over viscosity.
template <int Dim> Block<Dim> smd_block() {
  Block<Dim> block;
  block.scene.fluid.rheology.model = Rheology::Model::smd;
  block.scene.fluid.rheology.jump_number = {15, 15};
  return block;
}

template <int Dim, class Real> SymTensor<Dim, double> strain_of(const State<Dim, Real>& s, std::size_t k) {
  const double density = s.parameters.eos.rest_density;
  SymTensor<Dim, double> D;
  for (int c = 0; c < D.size; ++c) D[c] = s.particles[stress][c][k] * density * density / s.particles[viscosity][0][k];
  return D;
}

TYPED_TEST(OperatorsOf, StrainRateOfShearAndRotation) {
  MOLTEN_FLAVOUR;
  const Block<Dim> block = smd_block<Dim>();
  auto s = block.template state<Real>();
  const double factor = gradient_factor(s.parameters);
  const auto expect_magnitude = [&](double expected, auto&& flow) {
    set_velocity(s, flow);
    find_viscosity(s);
    for_each_inner(s, block.size, [&](std::size_t k, const auto&) {
      EXPECT_NEAR(strain_magnitude(strain_of(s, k)), expected * factor, 10 * digits<Real>);
    });
  };
  using X = std::array<double, 3>;
  expect_magnitude(3, [](const X& x) { return X{3 * x[1], 0, 0}; });
  expect_magnitude(3, [](const X& x) { return X{0, -3 * x[0], 0}; });
  expect_magnitude(0, [](const X& x) { return X{x[1], -x[0], 0}; });
  expect_magnitude(std::sqrt(2 * Dim), [](const X& x) { return x; });
  if (Dim == 3) expect_magnitude(2, [](const X& x) { return X{0, 2 * x[2], 0}; });
}

TYPED_TEST(OperatorsOf, StrainRateComponents) {
  MOLTEN_FLAVOUR;
  const Block<Dim> block = smd_block<Dim>();
  auto s = block.template state<Real>();
  const double factor = gradient_factor(s.parameters);
  const double G[3][3] = {{1, -2, 0.5}, {3, 0.7, -1.1}, {-0.4, 2.2, -1.5}};  // ∂v_a/∂x_b
  set_velocity(s, [&](const std::array<double, 3>& x) {
    std::array<double, 3> v{};
    for (int a = 0; a < Dim; ++a)
      for (int b = 0; b < Dim; ++b) v[a] += G[a][b] * x[b];
    return v;
  });
  find_viscosity(s);
  for_each_inner(s, block.size, [&](std::size_t k, const auto&) {
    const auto D = strain_of(s, k);
    for (int a = 0; a < Dim; ++a)
      for (int b = 0; b < Dim; ++b) EXPECT_NEAR(D(a, b), factor * (G[a][b] + G[b][a]), 20 * digits<Real>);
  });
}

TYPED_TEST(OperatorsOf, ForceOfALinearPressure) {
  // −∇p/ρ, times the lattice's factor. (The linear equation of state at a small slope: density nearly even.)
  MOLTEN_FLAVOUR;
  Block<Dim> block;
  block.scene.numerics.state_equation = StateEquation::linear;
  auto s = block.template state<Real>();
  const double stiffness = 1000 * 100, slope = 10;  // ρ0 c², Pa; Pa/m
  for_each_particle(s.particles, [&](std::size_t k, const auto& x) {
    s.particles[compression][0][k] = Real(slope * (x[0] - block.size / 2) / stiffness);
  });
  prepare(s);
  find_rates(s);
  const double factor = gradient_factor(s.parameters);
  for_each_inner(s, block.size, [&](std::size_t k, const auto&) {
    EXPECT_NEAR(s.particles[acceleration][0][k], -factor * slope / 1000, 1e-3 * slope / 1000);
    for (int d = 1; d < Dim; ++d) EXPECT_NEAR(s.particles[acceleration][d][k], 0, 1e-3 * slope / 1000);
  });
}

TYPED_TEST(OperatorsOf, GravityIsAdded) {
  MOLTEN_FLAVOUR;
  Block<Dim> block;
  block.scene.gravity = {1, -2, 3};
  auto s = block.template state<Real>();
  find_rates(s);
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    for (int d = 0; d < Dim; ++d) EXPECT_EQ(s.particles[acceleration][d][k], Real(block.scene.gravity[d]));
  });
}

/// dT/dt of a field over k ∇²T of it, at an inner particle.
template <int Dim, class Real>
double laplacian_factor(double smoothing_ratio, const std::function<double(const std::array<double, 3>&)>& T,
                        double laplacian) {
  Block<Dim> block;
  block.scene.numerics.smoothing_ratio = smoothing_ratio;
  block.scene.fluid.heat = Heat{2.0, std::nullopt, 0, 0};
  auto s = block.template state<Real>();
  for_each_particle(s.particles, [&](std::size_t k, const auto& x) { s.particles[temperature][0][k] = T(x); });
  prepare(s);
  find_rates(s);
  double factor = 0;
  for_each_particle(s.particles, [&](std::size_t k, const auto& x) {
    if (well_inside<Dim>(x, block.size, s.parameters.support_radius + 0.01 * spacing))
      factor = s.particles[temperature_rate][0][k] / (2.0 * laplacian);
  });
  return factor;
}

TYPED_TEST(OperatorsOf, LaplacianOfQuadraticTemperatures) {
  MOLTEN_FLAVOUR;
  using X = std::array<double, 3>;
  const auto round = [](const X& x) { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2]; };
  const auto flat = [](const X& x) { return 300 + 5 * x[1] * x[1] - 7 * x[0]; };
  const double known = Dim == 2 ? 0.974 : 0.979;
  EXPECT_NEAR((laplacian_factor<Dim, Real>(1.3, round, 2 * Dim)), known, 5e-4);
  EXPECT_NEAR((laplacian_factor<Dim, Real>(1.3, flat, 10)), known, 5e-4);
  EXPECT_NEAR((laplacian_factor<Dim, Real>(2, round, 2 * Dim)), 0.999, 1e-3);
}

TYPED_TEST(OperatorsOf, LaminarViscosityOfQuadraticFlow) {
  // u = y²: η ∇²u / ρ = 2 η/ρ, with the Laplacian's factor.
  MOLTEN_FLAVOUR;
  Block<Dim> block;
  block.scene.fluid.rheology.viscosity = 50;
  auto s = block.template state<Real>();
  set_velocity(s, [](const auto& x) { return std::array<double, 3>{x[1] * x[1], 0, 0}; });
  find_rates(s);
  const double expected = 2 * 50.0 / 1000 * (Dim == 2 ? 0.974 : 0.979);
  for_each_inner(s, block.size, [&](std::size_t k, const auto&) {
    EXPECT_NEAR(s.particles[acceleration][0][k], expected, 1e-3 * expected);
    for (int d = 1; d < Dim; ++d) EXPECT_NEAR(s.particles[acceleration][d][k], 0, 1e-3 * expected);
  });
}

TYPED_TEST(OperatorsOf, MonaghanViscosityOfQuadraticFlow) {
  // The same, with the factor of what a lattice makes of x² y²/r⁴.
  MOLTEN_FLAVOUR;
  Block<Dim> block;
  block.scene.fluid.rheology.viscosity = 50;
  block.scene.numerics.viscosity_form = ViscosityForm::monaghan;
  auto s = block.template state<Real>();
  set_velocity(s, [](const auto& x) { return std::array<double, 3>{x[1] * x[1], 0, 0}; });
  find_rates(s);
  const double expected = 2 * 50.0 / 1000 * mixed_factor(s.parameters);
  for_each_inner(s, block.size, [&](std::size_t k, const auto&) {
    EXPECT_NEAR(s.particles[acceleration][0][k], expected, 1e-3 * expected);
    for (int d = 1; d < Dim; ++d) EXPECT_NEAR(s.particles[acceleration][d][k], 0, 1e-3 * expected);
  });
}

TYPED_TEST(OperatorsOf, MonaghanViscosityDoesNotFeelRotation) {
  // Nor a free surface of what rotates, which Morris' form does.
  MOLTEN_FLAVOUR;
  const auto fastest = [](ViscosityForm form) {
    Block<Dim> block;
    block.scene.fluid.rheology.viscosity = 50;
    block.scene.numerics.viscosity_form = form;
    auto s = state_of<Dim, Real>(block.scene, cube<Dim>(8, spacing, 0.2), spacing);
    set_velocity(s, [](const auto& x) { return std::array<double, 3>{-x[1], x[0], 0}; });
    find_rates(s);
    double a = 0;
    for_each_particle(s.particles, [&](std::size_t k, const auto&) {
      a = std::max(a, std::abs(double(s.particles[acceleration][0][k])));
    });
    return a;
  };
  EXPECT_GT(fastest(ViscosityForm::morris), 0.1);
  EXPECT_LT(fastest(ViscosityForm::monaghan), 10 * digits<Real>);
}

TYPED_TEST(OperatorsOf, StressFormOfQuadraticFlow) {
  // The same with constant viscosity as ∇·S: two gradients, so the gradient's factor f squared. The damping works on
  // what the strain rates miss of the pairs' approach, v_ij·x − ¼ x·(D_i + D_j)·x = (1 − f) x y (2 y_i − y), of which
  // the part even in x acts: (1 − f) 2η/ρ times the spread factor, most of what the stress lacks.
  MOLTEN_FLAVOUR;
  const Block<Dim> block = smd_block<Dim>();
  auto s = block.template state<Real>();
  set_velocity(s, [](const auto& x) { return std::array<double, 3>{x[1] * x[1], 0, 0}; });
  find_viscosity(s);
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    for (auto* component : s.particles[stress].c) component[k] *= Real(50) / s.particles[viscosity][0][k];
    s.particles[viscosity][0][k] = 50;
  });
  find_rates(s);
  const double factor = gradient_factor(s.parameters);
  const double exact = 2 * 50.0 / 1000, bare = exact * factor * factor;
  const double expected = bare + (1 - factor) * spread_factor(s.parameters) * exact;
  for_each_inner(s, block.size, [&](std::size_t k, const auto&) {
    EXPECT_NEAR(s.particles[acceleration][0][k], expected, 200 * digits<Real> * expected);
    EXPECT_GT(s.particles[acceleration][0][k], bare);
    for (int d = 1; d < Dim; ++d) EXPECT_NEAR(s.particles[acceleration][d][k], 0, 1e-3 * expected);
  });
}

TYPED_TEST(OperatorsOf, StressAndViscosityAreTheRheologys) {
  MOLTEN_FLAVOUR;
  Block<Dim> block = smd_block<Dim>();
  block.scene.fluid.rheology.yield_stress = 60;
  block.scene.fluid.rheology.consistency = 20;
  auto s = block.template state<Real>();
  set_velocity(s, [](const auto& x) { return std::array<double, 3>{3 * x[1], 0, 0}; });
  find_viscosity(s);
  const double D = 3 * gradient_factor(s.parameters), eta = s.parameters.smd.viscosity(D, 0);
  for_each_inner(s, block.size, [&](std::size_t k, const auto&) {
    EXPECT_NEAR(s.particles[viscosity][0][k] / eta, 1, 2 * digits<Real>);
    EXPECT_NEAR((s.particles[stress][SymTensor<Dim, Real>::index(0, 1)][k] * 1e6 / (eta * D)), 1, 2 * digits<Real>);
  });
}

/// A block whose fluid takes the pairwise form of its stress.
template <int Dim> Block<Dim> pairwise_block(bool smd) {
  Block<Dim> block = smd_block<Dim>();
  if (!smd) block.scene.fluid.rheology.model = Rheology::Model::power_law, block.scene.fluid.rheology.flow_index = 1;
  block.scene.fluid.rheology.consistency = smd ? 1 : 50;
  block.scene.fluid.rheology.yield_stress = 1;
  block.scene.numerics.gradient_correction = true;
  block.scene.numerics.stress_form = StressForm::pairwise;
  return block;
}

TYPED_TEST(OperatorsOf, PairwiseStressOfConstantViscosityIsMorrisForm) {
  MOLTEN_FLAVOUR;
  const Block<Dim> block = pairwise_block<Dim>(false);
  auto s = block.template state<Real>();
  set_velocity(s, [](const auto& x) { return std::array<double, 3>{x[1] * x[1], 0, 0}; });
  find_all_rates(s);
  const double expected = 2 * 50.0 / 1000;  // the factor of the lattice is divided out
  for_each_inner(s, block.size, [&](std::size_t k, const auto&) {
    EXPECT_NEAR(s.particles[viscosity][0][k], 50, 50 * digits<Real>);
    EXPECT_NEAR(s.particles[acceleration][0][k], expected, 100 * digits<Real> * expected);
    for (int d = 1; d < Dim; ++d) EXPECT_NEAR(s.particles[acceleration][d][k], 0, 100 * digits<Real> * expected);
  });
}

TYPED_TEST(OperatorsOf, PairwiseStressOfShearThinningFlow) {
  // u' = D(y) = 0.3 + y²: the force is d/dy (η D) = η_t D', η_t the slope of the flow curve, which is less than η.
  MOLTEN_FLAVOUR;
  const Block<Dim> block = pairwise_block<Dim>(true);
  auto s = block.template state<Real>();
  const auto shear = [](double y) { return 0.3 + y * y; };
  set_velocity(s, [](const auto& x) { return std::array<double, 3>{0.3 * x[1] + x[1] * x[1] * x[1] / 3, 0, 0}; });
  find_all_rates(s);
  const auto stress_at = [&](double D) { return s.parameters.smd.viscosity(D, 0) * D; };
  for_each_inner(s, block.size, [&](std::size_t k, const auto& x) {
    const double step = 1e-4, y = x[1];
    const double exact = (stress_at(shear(y + step)) - stress_at(shear(y - step))) / (2 * step) / 1000;
    EXPECT_NEAR(s.particles[acceleration][0][k] / exact, 1, 0.002) << y;
    for (int d = 1; d < Dim; ++d) EXPECT_NEAR(s.particles[acceleration][d][k], 0, 1e-3 * exact);
  });
}

TYPED_TEST(OperatorsOf, PairwiseStressDoesNotFeelRotation) {
  // Whatever the viscosities of the particles are.
  MOLTEN_FLAVOUR;
  const Block<Dim> block = pairwise_block<Dim>(true);
  auto s = block.template state<Real>();
  set_velocity(s, [](const auto& x) { return std::array<double, 3>{-x[1], x[0], 0}; });
  find_corrections(s);
  find_viscosity(s);
  for_each_particle(s.particles, [&](std::size_t k, const auto& x) {
    s.particles[viscosity][0][k] = static_cast<Real>(50 + 40 * std::sin(30 * x[0] + 20 * x[1]));
  });
  find_rates(s);
  for_each_inner(s, block.size, [&](std::size_t k, const auto&) {
    for (int d = 0; d < Dim; ++d) EXPECT_NEAR(s.particles[acceleration][d][k], 0, 100 * digits<Real>);
  });
}

TYPED_TEST(OperatorsOf, XsphPullsTowardsTheMean) {
  // Σ (m/ρ̄)(v_j − v_i) W of a quadratic flow: positive at its minimum; of an even flow nothing.
  MOLTEN_FLAVOUR;
  Block<Dim> block;
  block.scene.numerics.xsph = Xsph{};
  auto s = block.template state<Real>();
  set_velocity(s, [](const auto&) { return std::array<double, 3>{4, 1, 2}; });
  find_rates(s);
  for_each_particle(s.particles, [&](std::size_t k, const auto&) { EXPECT_EQ(s.particles[xsph_velocity][0][k], 0); });
  set_velocity(s, [](const auto& x) { return std::array<double, 3>{x[1] * x[1], 0, 0}; });
  find_rates(s);
  for_each_inner(s, block.size, [&](std::size_t k, const auto&) { EXPECT_GT(s.particles[xsph_velocity][0][k], 0); });
}

}  // namespace
}  // namespace molten::operators_test
