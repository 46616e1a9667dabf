// The study: its metrics against known answers, its exact solutions, and every case at a tiny size.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "bench/study/cavity_flow.h"
#include "bench/study/channel_profile.h"
#include "bench/study/dam_break.h"
#include "bench/study/ellipse.h"
#include "bench/study/particles.h"
#include "bench/study/request.h"
#include "bench/study/wave_fit.h"
#include "bench/study/wave_theory.h"

namespace molten::study::study_test {
namespace {

// ---- metrics --------------------------------------------------------------------------------------------------------

Series ramp(double from, double to, double slope) {
  Series s;
  for (int k = 0; k <= 100; ++k) s.add(from + (to - from) * k / 100, 1 + slope * (from + (to - from) * k / 100));
  return s;
}

TEST(StudySeries, InterpolatesAndFindsWhenALevelIsReached) {
  const Series s{{0, 1, 3}, {1, 2, 6}};
  EXPECT_DOUBLE_EQ(s(0.5), 1.5);
  EXPECT_DOUBLE_EQ(s(2), 4);
  EXPECT_DOUBLE_EQ(s(-1), 1);
  EXPECT_DOUBLE_EQ(s(9), 6);
  EXPECT_DOUBLE_EQ(s.first_reaches(5), 2.5);
  EXPECT_DOUBLE_EQ(s.first_reaches(0), 0);
  EXPECT_TRUE(std::isinf(s.first_reaches(7)));
  EXPECT_EQ(s.between(0.5, 3).at, (std::vector<double>{1, 3}));
  EXPECT_DOUBLE_EQ(s.scaled(2, 10)(1), 15);
}

TEST(StudySeries, AStepInOneMomentIsReachedInIt) {
  const Series s{{0, 1, 1, 2}, {0, 0, 5, 5}};
  EXPECT_DOUBLE_EQ(s.first_reaches(3), 1);
  EXPECT_DOUBLE_EQ(s(1), 5);
}

TEST(StudySeries, TenPercentTooFarIsTenPercent) {
  const Series exact = ramp(0, 2, 3);
  EXPECT_NEAR(relative_rms(exact.scaled(1, 1.1), exact), 0.1, 1e-12);
  EXPECT_NEAR(mean_deviation(exact.scaled(1, 0.9), exact), 0.1, 1e-12);
}

TEST(StudySeries, FindsTheShiftOfAnExperimentThatLagsOrLeads) {
  const Series run = ramp(-1, 3, 3);
  for (const double lag : {0.13, -0.08}) {
    Series late;
    for (double t = 0; t < 2; t += 0.1) late.add(t, run(t - lag));
    const double shift = best_shift(0.5, [&](double s) { return relative_rms(run, late, s); });
    EXPECT_NEAR(shift, lag, 1e-3);
    EXPECT_LT(relative_rms(run, late, shift), 1e-3);
    EXPECT_GT(relative_rms(run, late), 0.02);
  }
}

TEST(StudyFieldError, IsRelative) {
  FieldError e;
  e.add(3, 2), e.add(-5, -6);
  EXPECT_DOUBLE_EQ(e.l1(), 2. / 8);
  EXPECT_DOUBLE_EQ(e.l2(), std::sqrt(2. / 40));
}

Cloud block_cloud(int dimensions, const Triple& upper, double spacing) {
  Cloud c;
  c.spacing = spacing;
  c.smoothing_length = 1.3 * spacing;
  c.position = lattice(dimensions, {}, upper, spacing).position;
  c.id.resize(c.position.size());
  c.velocity.assign(c.position.size(), Triple{1, 2, 2});
  c.pressure.assign(c.position.size(), 7);
  c.density.assign(c.position.size(), 1000);
  c.mass = 1000 * std::pow(spacing, dimensions);
  return c;
}

double distance(const Triple& a, const Triple& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

TEST(StudyProbes, PressureIsThatOfTheFluidAndNoneWhereThereIsNone) {
  for (const int dimensions : {2, 3}) {
    Cloud c = block_cloud(dimensions, {1, 1, 1}, 0.1);
    EXPECT_NEAR(pressure_at(c, dimensions, {0.5, 0.5, 0.5}), 7, 1e-12);
    EXPECT_NEAR(pressure_at(c, dimensions, {1, 0.5, 0.5}), 7, 1e-12) << "on the face";
    EXPECT_EQ(pressure_at(c, dimensions, {1.25, 0.5, 0.5}), 0) << "a spray's weight";
    for (std::size_t k = 0; k < c.count(); ++k) c.pressure[k] = 3 * c.position[k][1];
    EXPECT_NEAR(pressure_at(c, dimensions, {0.5, 0.5, 0.5}), 1.5, 1e-12) << "linear, by symmetry";
  }
}

TEST(StudyProbes, SensorFeelsTheForceOnItsWall) {
  for (const int dimensions : {2, 3}) {
    const double spacing = 0.02, h = 1.3 * spacing;
    Cloud c = block_cloud(dimensions, {0.2, 0.2, 0.2}, spacing);
    const Triple upper{0.2, 1, 1}, corner{0.2, 0.01, 0.1}, wall{0.2, 0.1, 0.1};
    EXPECT_NEAR(WallSensor(wall, {}, upper).pressure(c, dimensions), 7, 0.07) << "far from the floor";
    EXPECT_NEAR(WallSensor(corner, {}, upper).pressure(c, dimensions), 7, 0.21) << "beside the floor";
    // A drop: what is dry around it feels nothing. 2 V p W is the force of a wall with support over its area.
    std::fill(c.pressure.begin(), c.pressure.end(), 0);
    const auto is_nearer = [&](std::size_t a, std::size_t b) {
      return distance(c.position[a], wall) < distance(c.position[b], wall);
    };
    std::vector<std::size_t> order(c.count());
    std::iota(order.begin(), order.end(), 0);
    const std::size_t drop = *std::min_element(order.begin(), order.end(), is_nearer);
    c.pressure[drop] = 7;
    Triple there = c.position[drop];
    if (dimensions == 2) there[2] = wall[2];
    const double q = distance(there, wall) / h;
    const double alpha = dimensions == 2 ? 7 / (4 * M_PI * h * h) : 21 / (16 * M_PI * h * h * h);
    const double force = 2 * std::pow(spacing, dimensions) * 7 * alpha * std::pow(1 - q / 2, 4) * (2 * q + 1);
    EXPECT_NEAR(WallSensor(wall, {}, upper).pressure(c, dimensions), force, 0.01 * force);
    EXPECT_LT(force, 3);
  }
}

TEST(StudyProbes, DepthEnergyFront) {
  EXPECT_NEAR(depth_at(block_cloud(2, {1, 0.6, 0}, 0.1), 2, {0.5, 0, 0}, {0.2, 0, 0}), 0.6, 1e-12);
  EXPECT_NEAR(depth_at(block_cloud(3, {1, 1, 0.3}, 0.1), 3, {0.5, 0.5, 0}, {0.2, 0.1, 0}), 0.3, 1e-12);
  EXPECT_NEAR(depth_at(block_cloud(2, {1, 0.6, 0}, 0.1), 2, {0.45, 0, 0}, {0.105, 0, 0}), 0.6, 1e-12)
      << "a part of a row";
  EXPECT_NEAR(depth_at(block_cloud(3, {1, 1, 0.3}, 0.1), 3, {0.45, 0.53, 0}, {0.105, 0.01, 0}), 0.3, 1e-12);
  const Cloud c = block_cloud(2, {1, 1, 0}, 0.1);
  EXPECT_NEAR(kinetic_energy(c), 1000 * 9 / 2., 1e-9);
  EXPECT_NEAR(front_of(c), 1, 1e-12);
}

TEST(StudyProbes, ADropAheadIsNoFront) {
  Cloud c = block_cloud(2, {1, 1, 0}, 0.1);
  c.position[0] = {5, 0, 0};
  EXPECT_NEAR(front_of(c), 1, 1e-12);
  EXPECT_NEAR(front_of(c, 1), 5.05, 1e-12);
  EXPECT_NEAR(front_of(c, 12), 0.9, 1e-12) << "a column further back";
}

TEST(StudyProbes, CountsTheClumped) {
  Cloud c = block_cloud(2, {1, 1, 0}, 0.1);
  EXPECT_EQ(clumped_part(c, 2), 0);
  c.position[17] = c.position[83];
  c.position[17][1] += 0.04;
  EXPECT_DOUBLE_EQ(clumped_part(c, 2), 0.02);
}

// ---- exact solutions ------------------------------------------------------------------------------------------------

TEST(StudyExact, EllipseKeepsItsEnergyAndIsMonaghans) {
  for (const double t : {0.2, 0.76, 1.5}) {
    const Ellipse e = ellipse_at(t, -1);
    EXPECT_NEAR(e.a * e.b, 1, 1e-12);
    EXPECT_NEAR(e.stretch * e.stretch * (e.a * e.a + e.b * e.b), 2, 1e-9) << t;
  }
  EXPECT_NEAR(ellipse_at(0.76, -1).b, 1.95, 0.01);  // Monaghan 1994, t = 0.0076 s of a rim at 100 m/s
}

TEST(StudyExact, ChannelsAreTheReferences) {
  const auto smd = [](double jump) {
    return ChannelProfile([=](double strain) { return smd_stress(strain, jump, 0.5); }, 2).mean();
  };
  EXPECT_NEAR(smd(15), 0.1641063, 1e-6);
  EXPECT_NEAR(smd(150), 0.1472812, 1e-6);
  EXPECT_NEAR(ChannelProfile([](double strain) { return strain; }, 1).at(0), 0.5, 1e-6);
}

TEST(StudyExact, PoiseuilleStartsAtRestAndEndsOnItsParabola) {
  const double gap = 1e-3, nu = 1e-6, force = 1e-4;
  EXPECT_NEAR(poiseuille_velocity(gap / 3, 0, gap, nu, force), 0, 1e-10);
  EXPECT_NEAR(poiseuille_velocity(gap / 2, 10, gap, nu, force), 1.25e-5, 1e-12);
  EXPECT_NEAR(poiseuille_velocity(2.5e-4, 0.0225, gap, nu, force), 2.02393927e-06, 1e-13);
}

TEST(StudyExact, CouetteStartsAtRestAndEndsOnItsLine) {
  const double gap = 1e-3, nu = 1e-6, speed = 1.25e-5;
  EXPECT_NEAR(couette_velocity(gap / 2, 1e-3, gap, nu, speed), 0, 1e-12);
  EXPECT_NEAR(couette_velocity(gap / 4, 10, gap, nu, speed), speed / 4, 1e-15);
  EXPECT_NEAR(couette_velocity(2.5e-5, 0.1125, gap, nu, speed), 1.14109517e-07, 1e-14);
}

TEST(StudyExact, BinghamHasItsPlug) {
  const ChannelProfile ideal([](double strain) { return std::min(1e12 * strain, 1 + strain); }, 2);
  EXPECT_NEAR(ideal.at(0), 0.25, 1e-6);
  EXPECT_NEAR(ideal.at(0.49), 0.25, 1e-6);
  EXPECT_NEAR(ideal.at(0.75), 0.1875, 1e-6);  // ((T − 1)² − (Ty − 1)²)/(2T), T = 2
}

TEST(StudyExact, CavityHasTheReferencesCentre) {
  const CentreLines lines = cavity_flow(100, 24);
  EXPECT_NEAR(lines.u(0.5), -0.20912, 5e-4);
  EXPECT_NEAR(lines.v(0.5), 0.05753, 5e-4);
  EXPECT_EQ(lines.u(1), 1);
}

TEST(StudyExact, CavityOfAThousandIsReachedThroughSlowerOnes) {
  const CentreLines lines = cavity_flow(1000, 32);
  EXPECT_NEAR(*std::min_element(lines.u.value.begin(), lines.u.value.end()), -0.3886, 0.02);  // Botella & Peyret 1998
}

TEST(StudyProbes, ValueAtIsExactForQuadraticFields) {
  for (const int dimensions : {2, 3}) {
    const Cloud c = block_cloud(dimensions, {1, 1, 1}, 0.1);
    const auto of = [](double x, double y) { return 1 + 2 * x - 3 * y * y + x * y; };
    const auto field = [&](std::size_t k) { return of(c.position[k][0], c.position[k][1]); };
    EXPECT_NEAR(value_at(c, dimensions, {0.43, 0.51, 0.5}, field), of(0.43, 0.51), 1e-10);
  }
}

TEST(StudyProbes, ValueAtIsExactForLinearFields) {
  for (const int dimensions : {2, 3}) {
    const Cloud c = block_cloud(dimensions, {1, 1, 1}, 0.1);
    const auto linear = [&](std::size_t k) { return 1 + 2 * c.position[k][0] - 3 * c.position[k][1]; };
    EXPECT_NEAR(value_at(c, dimensions, {0.43, 0.51, 0.5}, linear), 1 + 2 * 0.43 - 3 * 0.51, 1e-10);
    EXPECT_NEAR(value_at(c, dimensions, {0.43, 1, 0.5}, linear), 1 + 2 * 0.43 - 3, 1e-10) << "on the face";
    EXPECT_EQ(value_at(c, dimensions, {5, 5, 5}, linear), 0);
  }
}

TEST(StudyExact, WaveFitFindsFrequencyAndDecay) {
  Series energy;
  for (int k = 0; k < 200; ++k) {
    const double t = 0.035 * k;
    energy.add(t, 0.3 * (1 + std::cos(2 * 1.75 * t + 0.05)) * std::exp(-0.17 * t));
  }
  const WaveFit fit = fit_wave(energy, 1.769, 0.158);
  EXPECT_NEAR(fit.frequency, 1.75, 1e-9);
  EXPECT_NEAR(fit.decay, 0.17, 1e-9);
}

/// What the amplitudes of potential flow A sinh ky and of a shear wave B sinh my, m² = k² + σ/ν, both ∝ e^{σt}, make of
/// the two stresses at the surface of a viscous wave of depth 1; zero for its modes.
std::complex<double> mode_residual(std::complex<double> sigma, double k, double viscosity) {
  const std::complex<double> m = std::sqrt(k * k + sigma / viscosity);
  const std::complex<double> flow = std::sinh(k), shear = std::sinh(m);
  const std::complex<double> tangential_flow = 2 * k * k * flow, tangential_shear = (m * m + k * k) * shear;
  const std::complex<double> normal_flow = sigma * std::cosh(k) / k + flow / sigma + 2 * viscosity * k * std::cosh(k);
  const std::complex<double> normal_shear = shear / sigma + 2 * viscosity * m * std::cosh(m);
  return (tangential_flow * normal_shear - tangential_shear * normal_flow) / (tangential_shear * std::cosh(k));
}

TEST(StudyExact, ViscousWaveIsTheModeOfItsDispersionRelation) {
  const double k = M_PI;
  for (const double viscosity : {1e-3, 4e-3, 2e-2}) {
    std::complex<double> before(-2 * viscosity * k * k, 1.769), sigma = before * 1.01;
    for (int round = 0; round < 20 && std::abs(sigma - before) > 1e-12; ++round) {  // secants
      const auto a = mode_residual(before, k, viscosity), b = mode_residual(sigma, k, viscosity);
      before = std::exchange(sigma, sigma - b * (sigma - before) / (b - a));
    }
    const WaveFit fit = fit_wave(ViscousWave{k, viscosity}.kinetic_energy(7.1, 0.035), 1.769, 4 * viscosity * k * k);
    EXPECT_NEAR(fit.frequency, sigma.imag(), 1e-3 * sigma.imag()) << viscosity;
    EXPECT_NEAR(fit.decay, -2 * sigma.real(), -0.02 * sigma.real()) << viscosity;
  }
}

// ---- the cases ------------------------------------------------------------------------------------------------------

class StudyCase : public ::testing::TestWithParam<std::string> {};

TEST_P(StudyCase, RunsAtATinySizeAndJudgesWhatItExpects) {
  const Case& chosen = find_case(GetParam());
  const std::string size = std::to_string(std::max(chosen.least_size, 8LL));
  Request request = make_request(chosen, size, "", {});
  if (request.given.contains("end_time")) request.given["end_time"] /= 5;
  Report report;
  ASSERT_TRUE(run_case(chosen, request, report));
  EXPECT_GT(report.steps, 0);
  EXPECT_GT(report.particles, 0);
  for (const Judgement& j : report.judgements) {
    EXPECT_FALSE(std::isnan(j.error)) << j.quantity;
    EXPECT_GT(j.reach, 0) << j.quantity;
  }
}

std::vector<std::string> case_names() {
  std::vector<std::string> names;
  for (const Case& c : all_cases()) names.push_back(c.name);
  return names;
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
}

INSTANTIATE_TEST_SUITE_P(Every, StudyCase, ::testing::ValuesIn(case_names()), test_name);

TEST(StudyCases, RepeatTheirBits) {
  const Case& chosen = find_case("taylor-green");
  const Request request = make_request(chosen, "12", "", {"end_time=0.2"});
  Report first, second;
  ASSERT_TRUE(run_case(chosen, request, first));
  ASSERT_TRUE(run_case(chosen, request, second));
  EXPECT_EQ(first.judgements[0].error, second.judgements[0].error);
}

// A setting of a case changes the problem.
TEST(StudyCases, SettingsReachTheProblem) {
  const Case& chosen = find_case("hot-spot");
  Report flat, solid;
  ASSERT_TRUE(run_case(chosen, make_request(chosen, "16", "", {}), flat));
  ASSERT_TRUE(run_case(chosen, make_request(chosen, "16", "", {"dimensions=3"}), solid));
  EXPECT_EQ(flat.dimensions, 2);
  EXPECT_EQ(solid.dimensions, 3);
  EXPECT_EQ(solid.particles, 16 * 16 * 16);
}

}  // namespace
}  // namespace molten::study::study_test
