// Corrected gradients and shifting: against a naive twin in double, and what they are made to be exact for.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <functional>

#include "core/physics/density_coupling.h"
#include "core/physics/gradient_correction.h"
#include "tests/particle_sets.h"

namespace molten::corrections_test {
namespace {

using namespace particle_sets;

constexpr double spacing = 0.1;

Scene corrected_scene(int dim) {
  Scene scene = plain_scene(dim);
  scene.numerics.gradient_correction = true;
  scene.numerics.shifting = Shifting{3};
  scene.numerics.state_equation = StateEquation::linear;
  return scene;
}

using X = std::array<double, 3>;
using Flow = std::function<X(const X&)>;

/// A free jittered block with a velocity, found corrections.
template <int Dim, class Real> State<Dim, Real> block(const Scene& scene, const Flow& flow, double jitter = 0.2) {
  auto s = state_of<Dim, Real>(scene, cube<Dim>(Dim == 2 ? 16 : 9, spacing, jitter), spacing);
  set_velocity(s, flow);
  find_corrections(s);
  return s;
}

template <int Dim> struct Naive {
  Eigen::Matrix<double, Dim, Dim> moment = Eigen::Matrix<double, Dim, Dim>::Zero();
  Eigen::Matrix<double, Dim, 1> crowding = Eigen::Matrix<double, Dim, 1>::Zero();
  Eigen::Matrix<double, Dim, 1> parting = Eigen::Matrix<double, Dim, 1>::Zero();
};

template <int Dim, class Real> std::vector<Naive<Dim>> naive_sums(const State<Dim, Real>& s) {
  std::vector<Naive<Dim>> all(s.particles.slots());
  for_each_pair(s, [&](const NaivePair& p) {
    const Eigen::Matrix<double, Dim, 1> x = Eigen::Map<const Eigen::Matrix<double, Dim, 1>>(p.x.data());
    all[p.i].moment -= p.mF / 1000 * x * x.transpose();
    all[p.i].crowding += p.mF / 1000 * x;
    all[p.i].parting += p.mF / 1000 * std::max(0.0, 1 - x.squaredNorm() / std::pow(0.65 * spacing, 2)) * x;
  });
  return all;
}

template <class F> class CorrectionsOf : public testing::Test {};
TYPED_TEST_SUITE(CorrectionsOf, Flavours, FlavourNames);

/// Round-off of such sums.
template <class Real> constexpr double digits = sizeof(Real) == 4 ? 2e-5 : 1e-10;

template <int Dim> GradientCorrection<Dim> correction_for(const Naive<Dim>& naive) {
  SymTensor<Dim, double> m;
  for (int a = 0; a < Dim; ++a)
    for (int b = a; b < Dim; ++b) m(a, b) = naive.moment(a, b);
  return GradientCorrection<Dim>(m);
}

TYPED_TEST(CorrectionsOf, InvertTheMomentAndFadeTowardsTheSurface) {
  MOLTEN_FLAVOUR;
  const auto s = block<Dim, Real>(corrected_scene(Dim), [](const X& x) { return x; });
  const auto naive = naive_sums(s);
  int inverted = 0, plain = 0;
  for_each_particle(s.particles, [&](std::size_t k, const auto& x) {
    Eigen::Matrix<double, Dim, Dim> L;
    for (int a = 0; a < Dim; ++a)
      for (int b = 0; b < Dim; ++b) L(a, b) = s.particles[correction].of(k)(a, b);
    const double part = correction_for(naive[k]).corrected;
    const Eigen::Matrix<double, Dim, Dim> one = L.Identity();
    Eigen::Matrix<double, Dim, Dim> inverse = one;
    if (part > 0) inverse = naive[k].moment.inverse();
    EXPECT_LT((L - one - part * (inverse - one)).norm(), 20 * digits<Real>);
    inverted += part == 1;
    if (!well_inside<Dim>(x, (Dim == 2 ? 16 : 9) * spacing, 0.5 * spacing)) plain += part < 1;
    if (well_inside<Dim>(x, (Dim == 2 ? 16 : 9) * spacing, s.parameters.support_radius)) {
      EXPECT_GT(part, 0.7);  // jittered by a fifth of the spacing
    }
  });
  EXPECT_GT(inverted, 0);
  EXPECT_GT(plain, 0);
}

template <int Dim> Eigen::Matrix<double, Dim, 1> way_of(const Naive<Dim>& naive, double inner, double parting = 1) {
  return inner * naive.crowding + parting * (1 - inner) * naive.parting;
}

/// The shift against −C U h way, at most U/2.
template <int Dim, class Real>
void expect_shift(const State<Dim, Real>& s, std::size_t k, double fastest, const Eigen::Matrix<double, Dim, 1>& way) {
  const double factor = -3 * fastest * s.parameters.smoothing_length;
  const double less = std::min(1.0, fastest / 2 / (std::abs(factor) * way.norm() + 1e-300));
  for (int d = 0; d < Dim; ++d)
    EXPECT_NEAR(s.particles[shift_velocity][d][k], less * factor * way[d], 50 * digits<Real>);
}

TYPED_TEST(CorrectionsOf, ShiftTowardsWhereParticlesAreFewButNotAtTheSurface) {
  MOLTEN_FLAVOUR;
  const double fastest = 0.8;  // m/s; sound: 10
  const auto s = block<Dim, Real>(corrected_scene(Dim), [&](const X& x) {
    return X{x[0] > 0.5 ? fastest : 0.0, 0, 0};
  });
  const auto naive = naive_sums(s);
  int moved = 0, still = 0;
  for_each_particle(s.particles, [&](std::size_t k, const auto& x) {
    const double inner = correction_for(naive[k]).inner;
    expect_shift<Dim, Real>(s, k, fastest, way_of(naive[k], inner));
    if (inner == 1) ++moved;
    if (!well_inside<Dim>(x, (Dim == 2 ? 16 : 9) * spacing, 0.5 * spacing) && naive[k].parting.isZero(0)) {
      ++still;
      EXPECT_EQ(s.particles[shift_velocity][0][k], 0);
    }
  });
  EXPECT_GT(moved, 0);
  EXPECT_GT(still, 0);
}

TYPED_TEST(CorrectionsOf, PartCloseNeighboursAtTheSurfaceToo) {
  MOLTEN_FLAVOUR;
  const double fastest = 0.8;  // m/s; sound: 10
  const Flow flow = [&](const X&) { return X{fastest, 0, 0}; };
  const auto s = block<Dim, Real>(corrected_scene(Dim), flow, 0.4);
  Scene uncoupled = corrected_scene(Dim);
  uncoupled.numerics.shifting->coupling = 0;
  const auto without = block<Dim, Real>(uncoupled, flow, 0.4);
  const auto naive = naive_sums(s);
  int parted = 0;
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    const double inner = correction_for(naive[k]).inner;
    expect_shift<Dim, Real>(s, k, fastest, way_of(naive[k], inner));
    expect_shift<Dim, Real>(without, k, fastest, way_of(naive[k], inner, 0));
    parted += inner == 0 && !naive[k].parting.isZero(0);
  });
  EXPECT_GT(parted, 0);
}

TYPED_TEST(CorrectionsOf, MakeTheDivergenceOfLinearFlowsExactButAtTheSurface) {
  // On a disordered block; without the correction it is off by percents inside.
  MOLTEN_FLAVOUR;
  Scene scene = corrected_scene(Dim);
  scene.numerics.shifting.reset();
  auto s = block<Dim, Real>(scene, [](const X& x) { return X{2 * x[0] - x[1], x[0] + 3 * x[1], x[1]}; });
  find_rates(s);
  const auto naive = naive_sums(s);
  int whole = 0;
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    if (correction_for(naive[k]).corrected < 1) return;
    EXPECT_NEAR(s.particles[compression_rate][0][k], -5, 300 * digits<Real>);
    ++whole;
  });
  EXPECT_GT(whole, static_cast<int>(s.particles.count()) / 4);
}

/// A block for shifting with coupling 2 at a speed of 1, and the concentration of its particles.
template <int Dim, class Real> struct Coupled {
  static constexpr int cells = Dim == 2 ? 40 : 16;
  State<Dim, Real> state;
  std::vector<double> sums, concentrations;  // Σ V W; C

  static Scene scene() {
    Scene scene = corrected_scene(Dim);
    scene.numerics.shifting->coupling = 2;
    scene.numerics.smoothing_ratio = 1.7;
    return scene;
  }
  explicit Coupled(double jitter) : state(state_of<Dim, Real>(scene(), cube<Dim>(cells, spacing, jitter), spacing)) {
    set_velocity(state, [](const X&) { return X{1, 0, 0}; });
    find_corrections(state);
    sums.assign(state.particles.slots(), kernel_at(state.parameters, 0).mW / 1000);
    std::vector<double> traces(state.particles.slots(), 0.0);
    for_each_pair(state, [&](const NaivePair& p) {
      sums[p.i] += p.mW / 1000;
      traces[p.i] -= p.mF / 1000 * p.r * p.r;
    });
    for (std::size_t k = 0; k < sums.size(); ++k) concentrations.push_back(concentration_of<Dim>(sums[k], traces[k]));
  }
  /// Deep in the block.
  double mean(const std::vector<double>& of) const {
    double sum = 0, count = 0;
    for_each_particle(state.particles, [&](std::size_t k, const auto& x) {
      if (well_inside<Dim>(x, cells * spacing, 4 * spacing)) sum += of[k], ++count;
    });
    EXPECT_GT(count, 100);
    return sum / count;
  }
};

TYPED_TEST(CorrectionsOf, CoupleTheDensityToThatOfThePlaces) {
  MOLTEN_FLAVOUR;
  const Coupled<Dim, Real> block(0.2), regular(0);
  const double lattice = regular.mean(regular.concentrations);
  const auto naive = naive_sums(block.state);
  int coupled = 0;
  for_each_particle(block.state.particles, [&](std::size_t k, const auto&) {
    SymTensor<Dim, double> m;
    for (int a = 0; a < Dim; ++a)
      for (int b = a; b < Dim; ++b) m(a, b) = naive[k].moment(a, b);
    const double share = coupling_share(GradientCorrection<Dim>(m).inner);
    const double rate = 2 / block.state.parameters.smoothing_length * share;
    EXPECT_NEAR(block.state.particles[coupling_rate][0][k], rate * (block.concentrations[k] / lattice - 1),
                200 * digits<Real>);
    coupled += share == 1;
  });
  EXPECT_GT(coupled, static_cast<int>(block.state.particles.count()) / 4);
}

TYPED_TEST(CorrectionsOf, DisorderChangesTheConcentrationLessThanTheSumOfKernels) {
  // Displacements by up to 0.2 spacings raise Σ V W by 0.6 % and more.
  MOLTEN_FLAVOUR;
  const Coupled<Dim, Real> lattice(0), jittered(0.2);
  const double sums = jittered.mean(jittered.sums) - lattice.mean(lattice.sums);
  EXPECT_GT(sums, 0.004);
  const double left = jittered.mean(jittered.concentrations) - lattice.mean(lattice.concentrations);
  EXPECT_NEAR(left, 0, (Dim == 2 ? 0.33 : 0.7) * sums);
}

TYPED_TEST(CorrectionsOf, CarryLinearFieldsAlongWithTheShift) {
  // A shifted particle keeps seeing the linear fields where it is: dv/dt = δv·∇v, dδ/dt = δv·∇δ − ∇·v.
  MOLTEN_FLAVOUR;
  Scene scene = corrected_scene(Dim);
  scene.numerics.sound_speed = 1e-6;  // no pressure to speak of
  scene.numerics.shifting->coupling = 0;
  auto s = block<Dim, Real>(scene, [](const X& x) { return X{2 * x[1], -x[0], 0}; });
  for_each_particle(s.particles, [&](std::size_t k, const auto& x) {
    s.particles[compression][0][k] = Real(0.1 * x[0] - 0.2 * x[1]);
  });
  prepare(s);
  find_rates(s);
  const auto naive = naive_sums(s);
  int inner = 0;
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    const auto shift = s.particles[shift_velocity].of(k);
    if (shift[0] == 0 || correction_for(naive[k]).corrected < 1) return;
    ++inner;
    EXPECT_NEAR(s.particles[acceleration][0][k], 2 * shift[1], 100 * digits<Real>);
    EXPECT_NEAR(s.particles[acceleration][1][k], -shift[0], 100 * digits<Real>);
    EXPECT_NEAR(s.particles[compression_rate][0][k], 0.1 * shift[0] - 0.2 * shift[1], 100 * digits<Real>);
  });
  EXPECT_GT(inner, 50);
}

/// Planes through the origin across every axis; the fluid is where all coordinates are positive.
template <int Dim> std::vector<Wall<Dim>> corner() {
  std::vector<Wall<Dim>> walls(Dim);
  for (int d = 0; d < Dim; ++d) {
    walls[d].is_plane = true;
    walls[d].plane_normal[d] = 1;
    walls[d].response = {0, 1};
  }
  return walls;
}

/// A block on a lattice that fills a corner between free-slip walls with support, with a velocity.
template <int Dim, class Real> State<Dim, Real> block_in_a_corner(double smoothing_ratio, const Flow& flow) {
  Scene scene = corrected_scene(Dim);
  scene.numerics.wall_support = true;
  scene.numerics.smoothing_ratio = smoothing_ratio;
  Start start = start_of(scene, cube<Dim>(Dim == 2 ? 16 : 9, spacing), spacing);
  for (std::size_t k = 0; k < start.position.size(); ++k) start.velocity[k] = flow(start.position[k]);
  auto s = state_of<Dim, Real>(scene, start, corner<Dim>());
  find_corrections(s);
  return s;
}

/// Whether nothing but walls is within the support.
template <int Dim, class Real> bool has_no_free_side(const State<Dim, Real>& s, const X& x) {
  const double edge = (Dim == 2 ? 16 : 9) * spacing - s.parameters.support_radius;
  return *std::max_element(x.begin(), x.begin() + Dim) < edge;
}

TYPED_TEST(CorrectionsOf, ShiftNoFasterThanForAFlowOfATenthOfTheSpeedOfSound) {
  MOLTEN_FLAVOUR;
  const Scene scene = corrected_scene(Dim);
  const double sound = block<Dim, Real>(scene, [](const X&) { return X{}; }).parameters.eos.sound_speed;
  const auto shifts = [&](double mach) {
    const auto s = block<Dim, Real>(scene, [&](const X&) { return X{mach * sound, 0, 0}; });
    std::vector<double> all;
    for_each_particle(s.particles, [&](std::size_t k, const auto&) {
      for (int d = 0; d < Dim; ++d) all.push_back(s.particles[shift_velocity][d][k]);
    });
    return all;
  };
  const auto tenth = shifts(0.1), twentieth = shifts(0.05);
  EXPECT_EQ(shifts(2), tenth);
  EXPECT_GT(*std::max_element(tenth.begin(), tenth.end()), 1e-3 * sound);
  for (std::size_t k = 0; k < tenth.size(); ++k) EXPECT_NEAR(twentieth[k], tenth[k] / 2, 1e-6 * sound);
}

/// Largest |L − 1|, and the fastest shift over the largest speed, before walls.
struct AtWalls {
  double correction = 0, shift = 0;
  int close = 0;  // particles next to a wall
};
template <int Dim, class Real> AtWalls at_walls(double smoothing_ratio) {
  const auto s = block_in_a_corner<Dim, Real>(smoothing_ratio, [](const X&) { return X{1, 0, 0}; });
  AtWalls most;
  for_each_particle(s.particles, [&](std::size_t k, const auto& x) {
    if (!has_no_free_side(s, x)) return;
    const auto L = s.particles[correction].of(k);
    for (int a = 0; a < Dim; ++a) {
      for (int b = a; b < Dim; ++b) most.correction = std::max(most.correction, std::abs(double(L(a, b)) - (a == b)));
      most.shift = std::max(most.shift, std::abs(double(s.particles[shift_velocity][a][k])));
    }
    if (*std::min_element(x.begin(), x.begin() + Dim) < spacing) ++most.close;
  });
  return most;
}

TYPED_TEST(CorrectionsOf, ConvergeBeforeWallsToWhatTheyAreDeepInTheFluid) {
  // A sum over the fluid and an integral over the solid make up the whole support, in the limit of many neighbours: no
  // correction, no shift into the walls. The moment, by the rule of midpoints, in second order in spacing/h, (1.7/3)² =
  // 0.32; its slope, the shift, at least in first.
  MOLTEN_FLAVOUR;
  const AtWalls few = at_walls<Dim, Real>(1.7), many = at_walls<Dim, Real>(3);
  EXPECT_GT(few.close, 8);
  EXPECT_GT(many.close, 2);
  EXPECT_LT(many.correction, 0.33 * few.correction + digits<Real>);
  EXPECT_LT(many.shift, 1.7 / 3 * few.shift);
  EXPECT_LT(many.correction, 0.01);
}

/// Largest and summed rate of a temperature over the block.
template <int Dim, class Real> std::array<double, 2> heat_rates(const State<Dim, Real>& s) {
  double sum = 0, sizes = 0;
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    sum += s.particles[temperature_rate][0][k];
    sizes += std::abs(s.particles[temperature_rate][0][k]);
  });
  return {sum, sizes};
}

TYPED_TEST(CorrectionsOf, MakeLaplaciansWholeAndKeepHeat) {
  MOLTEN_FLAVOUR;
  Scene scene = corrected_scene(Dim);
  scene.numerics.shifting.reset();
  scene.fluid.heat = Heat{2.0, std::nullopt, 0, 0};
  for (const double jitter : {0.0, 0.2}) {
    auto s = state_of<Dim, Real>(scene, cube<Dim>(Dim == 2 ? 24 : 14, spacing, jitter), spacing);
    for_each_particle(s.particles, [&](std::size_t k, const auto& x) { s.particles[temperature][0][k] = x[0] * x[0]; });
    prepare(s);
    find_corrections(s);
    find_rates(s);
    const auto [sum, sizes] = heat_rates(s);
    EXPECT_LT(std::abs(sum), sizes * (std::is_same_v<Real, float> ? 1e-6 : 1e-14));
    if (jitter > 0) continue;
    int inner = 0;
    for_each_particle(s.particles, [&](std::size_t k, const auto& x) {
      if (!well_inside<Dim>(x, (Dim == 2 ? 24 : 14) * spacing, s.parameters.support_radius + 2.5 * spacing)) return;
      EXPECT_NEAR(s.particles[temperature_rate][0][k], 4, 2000 * digits<Real>);  // without: 0.974 and 0.979 of it
      ++inner;
    });
    EXPECT_GT(inner, 0);
  }
}

}  // namespace
}  // namespace molten::corrections_test
