#include "core/physics/rheology.h"

#include <gtest/gtest.h>

#include <vector>

namespace molten::rheology_test {
namespace {

/// The largest viscosity over all strain rates, in units of the zero-shear one, J + 1.
double overshoot(double jump_number, double n) {
  double largest = 0;
  for (double exponent = -9; exponent < 3; exponent += 1e-3)
    largest = std::max(largest, smd_viscosity(std::pow(10, exponent), jump_number, n));
  return largest / (jump_number + 1);
}

TEST(Rheology, AtRestTheViscosityIsTheJumpNumberAndOne) {
  for (const double J : {0.0, 15.0, 150.0, 1e6}) {
    EXPECT_EQ(smd_viscosity(0, J, 0.5), J + 1);
    for (const double D : {1e-300, 1e-31, 1e-30, 1.1e-30, 1e-24, 1e-16})
      EXPECT_NEAR(smd_viscosity(D, J, 0.5) / (J + 1), 1, 1.1 * std::sqrt(D) + 1e-12) << D;
    // The first terms of the series in D: (J+1)(1 + D^n) (1 − (J+1) D/2)
    const double D = 1e-4 / (J + 1);
    EXPECT_NEAR(smd_viscosity(D, J, 0.5) / (J + 1), (1 + std::sqrt(D)) * (1 - (J + 1) * D / 2), 1e-8);
  }
}

TEST(Rheology, FastShearThins) {
  for (const double J : {15.0, 150.0})
    for (const double n : {0.3, 0.5, 1.0})
      for (const double D : {1e2, 1e6, 1e30})
        EXPECT_NEAR(smd_viscosity(D, J, n) / (std::pow(D, n - 1) + 1 / D), 1, 1e-12) << D;
}

TEST(Rheology, FiniteFromNothingToEverything) {
  for (const double J : {0.0, 15.0, 150.0, 1e12})
    for (const double n : {0.2, 0.5, 1.0, 1.5})
      for (int exponent = -320; exponent <= 30; ++exponent) {
        const double value = smd_viscosity(std::pow(10, exponent), J, n);
        EXPECT_TRUE(std::isfinite(value) && value > 0) << "J " << J << ", n " << n << ", D 1e" << exponent;
      }
}

TEST(Rheology, ExceedsTheViscosityAtRestByTheKnownFigures) {
  EXPECT_NEAR(overshoot(0, 0.5), 1.35, 0.005);
  EXPECT_NEAR(overshoot(15, 0.5), 1.030, 0.0005);
  EXPECT_NEAR(overshoot(150, 0.5), 1.0033, 0.00005);
  EXPECT_NEAR(overshoot(15, 1), 1, 1e-6) << "n = 1 does not";
}

TEST(Rheology, UnitsGiveTheDimensionlessForm) {
  const double tau0 = 60, K = 20, n = 0.5;
  const Smd smd(n, tau0, K, {15, 150});
  const double rate1 = std::pow(tau0 / K, 1 / n), eta0 = 151 * tau0 / rate1;
  EXPECT_NEAR(smd.viscosity(0, 20) / eta0, 1, 1e-12);
  for (const double D : {1e-6, 1e-3, 0.5, 9.0, 200.0, 1e5}) {
    const double in_units = -std::expm1(-eta0 * D / tau0) * (tau0 / D + K * std::pow(D, n - 1));
    EXPECT_NEAR(smd.viscosity(D, 20) / in_units, 1, 1e-12) << D;
    EXPECT_NEAR(smd.viscosity(D, 20) / (tau0 / rate1 * smd_viscosity(D / rate1, 150, n)), 1, 1e-12) << D;
  }
  // [P]'s printed form is that of unit yield stress and consistency.
  const Smd printed(n, 1, 1, {15, 15});
  for (const double D : {1e-3, 1.0, 50.0}) EXPECT_NEAR(printed.viscosity(D, 0), smd_viscosity(D, 15, n), 1e-12);
}

TEST(Rheology, ZeroShearViscosityOfTheScenesFormula) {
  // (J+1) K^(1/n) τ0^(1−1/n), as the scene reference has it.
  for (const double n : {0.3, 0.5, 1.0})
    EXPECT_NEAR(Smd(n, 60, 20, {15, 15}).viscosity(0, 0) / (16 * std::pow(20, 1 / n) * std::pow(60, 1 - 1 / n)), 1,
                1e-12);
}

TEST(Rheology, JumpNumberMeltsLinearlyAndStays) {
  Smd smd(0.5, 1, 1, {15, 150});
  smd.melting_low = 40;
  smd.melting_high = 60;
  EXPECT_EQ(smd.jump_number(40), 150);
  EXPECT_EQ(smd.jump_number(60), 15);
  EXPECT_NEAR(smd.jump_number(50), 82.5, 1e-12);
  EXPECT_NEAR(smd.jump_number(45), 116.25, 1e-12);
  // [P] 6-3 without the clamp would go on, to a negative viscosity.
  EXPECT_EQ(smd.jump_number(-273), 150);
  EXPECT_EQ(smd.jump_number(90), 15);
  EXPECT_EQ(smd.jump_number(1e6), 15);
}

TEST(Rheology, JumpNumberWithoutAMeltingRangeIsTheColdOne) {
  const Smd smd(0.5, 1, 1, {15, 150});
  for (const double T : {-100.0, 0.0, 1e4}) EXPECT_EQ(smd.jump_number(T), 150);
}

TEST(Rheology, FlowCurveRises) {
  for (const double J : {0.0, 15.0, 150.0})
    for (const double n : {0.3, 0.5, 1.0}) {
      double before = 0;
      for (double exponent = -12; exponent < 8; exponent += 0.01) {
        const double D = std::pow(10, exponent), stress = D * smd_viscosity(D, J, n);
        EXPECT_GT(stress, before) << "J " << J << ", n " << n << ", D " << D;
        before = stress;
      }
    }
}

TEST(Rheology, YieldStressIsThePlateau) {
  // At large J the stress climbs to about τ0 before it flows: between 1/(J+1) and 1 unit of strain rate.
  const Smd smd(0.5, 60, 20, {1e4, 1e4});
  const double D = 1e-2 * smd.strain_unit;
  EXPECT_NEAR(smd.viscosity(D, 0) * D, 60 * (1 + std::sqrt(1e-2)), 1e-6);
}

TEST(Rheology, StrainMagnitudeOfSimpleFlows) {
  // D = ∇v + (∇v)ᵀ. Simple shear: |du/dy|. Uniaxial extension at rate e: diag(2, −1, −1) e, so √3 e.
  auto shear = SymTensor<2, double>::filled(0);
  shear(0, 1) = -3;
  EXPECT_NEAR(strain_magnitude(shear), 3, 1e-15);
  auto shear3 = SymTensor<3, double>::filled(0);
  shear3(1, 2) = 3;
  EXPECT_NEAR(strain_magnitude(shear3), 3, 1e-15);
  auto extension = SymTensor<3, double>::filled(0);
  extension(0, 0) = 2;
  extension(1, 1) = extension(2, 2) = -1;
  EXPECT_NEAR(strain_magnitude(extension), std::sqrt(3), 1e-15);
  EXPECT_EQ(strain_magnitude(SymTensor<3, float>::filled(0)), 0);
}

}  // namespace
}  // namespace molten::rheology_test
