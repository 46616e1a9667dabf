#include "core/physics/flow_curve.h"

#include <gtest/gtest.h>

namespace molten::flow_curve_test {
namespace {

using Model = Rheology::Model;

Rheology rheology(Model model) {
  Rheology r;
  r.model = model;
  r.viscosity = 8;
  r.flow_index = 0.4;
  r.yield_stress = 60;
  r.consistency = 20;
  r.regularisation = 50;
  r.fast_viscosity = 0.5;
  r.relaxation_time = 3;
  return r;
}

TEST(FlowCurve, StressesOfTheModels) {
  for (const double D : {1e-3, 0.1, 1.0, 40.0}) {
    const auto stress = [&](Model model) { return D * viscosity_of(rheology(model), D, 0); };
    const double yielded = 60 * (1 - std::exp(-50 * D));
    EXPECT_NEAR(stress(Model::newtonian) / (8 * D), 1, 1e-12);
    EXPECT_NEAR(stress(Model::power_law) / (20 * std::pow(D, 0.4)), 1, 1e-12);
    EXPECT_NEAR(stress(Model::bingham) / (8 * D + yielded), 1, 1e-12);
    EXPECT_NEAR(stress(Model::herschel_bulkley) / (20 * std::pow(D, 0.4) + yielded), 1, 1e-12);
    EXPECT_NEAR(stress(Model::cross) / (D * (0.5 + 7.5 / (1 + std::pow(3 * D, 0.6)))), 1, 1e-12);
    EXPECT_NEAR(stress(Model::carreau) / (D * (0.5 + 7.5 * std::pow(1 + 9 * D * D, -0.3))), 1, 1e-12);
  }
}

TEST(FlowCurve, AtRest) {
  EXPECT_NEAR(viscosity_of(rheology(Model::bingham), 0, 0), 8 + 60 * 50, 1e-9);
  EXPECT_EQ(viscosity_of(rheology(Model::cross), 0, 0), 8);
  EXPECT_EQ(viscosity_of(rheology(Model::carreau), 0, 0), 8);
  for (const Model model : {Model::power_law, Model::herschel_bulkley}) {
    Rheology r = rheology(model);
    r.largest_viscosity = 1e4;
    EXPECT_EQ(viscosity_of(r, 0, 0), 1e4) << "cut";
    EXPECT_LT(viscosity_of(r, 1, 0), 1e3) << "not cut";
  }
}

TEST(FlowCurve, BinghamIsHerschelBulkleyOfIndexOne) {
  Rheology hb = rheology(Model::herschel_bulkley);
  hb.flow_index = 1, hb.consistency = 8;
  for (const double D : {0.0, 1e-4, 0.3, 10.0})
    EXPECT_NEAR(viscosity_of(hb, D, 0), viscosity_of(rheology(Model::bingham), D, 0), 1e-9);
}

TEST(FlowCurve, Temperatures) {
  Rheology r = rheology(Model::newtonian);
  r.thermal = ThermalViscosity{ThermalViscosity::Kind::arrhenius, 3e4, 1400, 0, 0, 0};
  EXPECT_NEAR(viscosity_of(r, 1, 1400), 8, 1e-12);
  EXPECT_NEAR(viscosity_of(r, 1, 1300) / (8 * std::exp(3e4 * (1 / 1300. - 1 / 1400.))), 1, 1e-12);
  r.viscosity = 1;
  r.largest_viscosity = 1e9;
  r.thermal = ThermalViscosity{ThermalViscosity::Kind::vft, 0, 1, -4.55, 5800, 570};  // basalt, K
  EXPECT_NEAR(std::log10(viscosity_of(r, 1, 1473)), -4.55 + 5800 / 903., 1e-12);
  EXPECT_EQ(viscosity_of(r, 1, 700), 1e9) << "cold: cut";
  EXPECT_EQ(viscosity_of(r, 1, 300), 1e9) << "below C";
}

}  // namespace
}  // namespace molten::flow_curve_test
