// Orders of convergence that the study's cases show with corrected operators, and errors at one size.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/study/request.h"

namespace molten::study::study_order_test {
namespace {

/// The error of a quantity; by default of the first that the case judges.
double error_of(const std::string& name, int size, const std::string& numerics,
                const std::vector<std::string>& settings = {}, const std::string& quantity = "") {
  const Case& chosen = find_case(name);
  Report report;
  EXPECT_TRUE(run_case(chosen, make_request(chosen, std::to_string(size), numerics, settings), report));
  for (const auto& judgement : report.judgements)
    if (quantity.empty() || judgement.quantity == quantity) return judgement.error;
  ADD_FAILURE() << quantity;
  return NAN;
}

/// Errors at a size and at twice it.
struct Pair {
  double coarse, fine;
  double order() const { return std::log2(coarse / fine); }
};
Pair errors_of(const std::string& name, int size, const std::string& numerics,
               const std::vector<std::string>& settings = {}, const std::string& quantity = "") {
  const Pair p{error_of(name, size, numerics, settings, quantity),
               error_of(name, 2 * size, numerics, settings, quantity)};
  ::testing::Test::RecordProperty(name, std::to_string(p.coarse) + " " + std::to_string(p.fine));
  return p;
}

TEST(StudyOrder, ConductionIsOfSecondOrderWithCorrection) {
  for (const char* name : {"hot-spot", "two-slabs"}) {
    const Pair p = errors_of(name, 25, "molten", {"numerics.gradient_correction=true"});
    EXPECT_GT(p.order(), 1.8) << name;
    EXPECT_LT(p.fine, 0.005) << name;
  }
}

TEST(StudyOrder, SlabsThatConductDifferentlyAreOfSecondOrder) {
  for (const auto& [ratio, size] : {std::pair{"1000", 10}, std::pair{"10", 25}}) {
    const Pair p = errors_of("two-slabs", size, "molten", {std::string("conductivity_ratio=") + ratio});
    EXPECT_GT(p.order(), 1.8) << ratio;
    EXPECT_LT(p.fine, 0.005) << ratio;
  }
}

TEST(StudyOrder, HotSpotInDisorderIsOfSecondOrderWithConsistentLaplacians) {
  const std::vector<std::string> disorder = {"numerics.gradient_correction=true", "perturbation=0.2"};
  std::vector<std::string> consistent = disorder;
  consistent.push_back("numerics.laplacian=\"consistent\"");
  const Pair p = errors_of("hot-spot", 25, "molten", consistent);
  EXPECT_GT(p.order(), 1.8);
  EXPECT_LT(p.fine, 0.005);
  EXPECT_GT(error_of("hot-spot", 50, "molten", disorder), 2 * p.fine);
}

TEST(StudyOrder, PoiseuilleConvergesFasterThanInFirstOrder) {
  EXPECT_GT(errors_of("poiseuille", 12, "internal", {"walls=0"}).order(), 1.5);
}

TEST(StudyOrder, StartUpBetweenWallsConvergesInFirstOrder) {
  for (const char* name : {"couette", "poiseuille"}) {
    const Pair p = errors_of(name, 16, "internal");
    EXPECT_GT(p.order(), 0.9) << name;
    EXPECT_LT(p.fine, 0.005) << name;
  }
}

TEST(StudyOrder, YieldingChannelConvergesFasterThanInFirstOrder) {
  const Pair p = errors_of("smd-channel", 8, "internal", {"walls=1"});
  EXPECT_GT(p.order(), 1.5);
  EXPECT_LT(p.fine, 0.015);
  EXPECT_LT(error_of("smd-channel", 16, "internal"), 0.01);  // periodic
}

TEST(SlowStudyOrder, CouplingKeepsACavitysWallsTight) {
  const double leaking = error_of("cavity", 25, "internal", {"numerics.shifting={coupling=0}"});
  EXPECT_LT(error_of("cavity", 25, "internal"), 0.75 * leaking);
}

TEST(StudyOrder, StandingWaveDecaysAsItShould) {
  const Pair p = errors_of("standing-wave", 16, "internal", {}, "decay_rate");
  EXPECT_GT(p.order(), 1);
  EXPECT_LT(p.fine, 0.1);
  EXPECT_LT(error_of("standing-wave", 32, "internal"), 0.01);
}

TEST(StudyOrder, FreeBodiesKeepTheirEnergyAndDoNotClump) {
  for (const auto& [name, size] : {std::pair{"elliptic-drop", 20}, std::pair{"rotating-patch", 50}}) {
    EXPECT_LT(error_of(name, size, "molten", {}, "kinetic_energy"), 0.01) << name;
    EXPECT_EQ(error_of(name, size, "molten", {}, "clumped_part"), 0) << name;
  }
}

TEST(SlowStudyOrder, HotSpotInASolidIsOfSecondOrderWithCorrection) {
  EXPECT_GT(errors_of("hot-spot", 25, "molten", {"numerics.gradient_correction=true", "dimensions=3"}).order(), 1.8);
}

TEST(SlowStudyOrder, PoiseuilleIsWithinItsReach) {
  EXPECT_LT(error_of("poiseuille", 64, "internal", {"walls=0"}), 0.005);
}

TEST(SlowStudyOrder, YieldingChannelsAreWithinTheirReach) {
  for (const char* walls : {"walls=0", "walls=1"})
    for (const char* quantity : {"profile_rms", "mean_velocity"})
      EXPECT_LT(error_of("smd-channel", 32, "internal", {walls}, quantity), 0.01) << walls << quantity;
}

TEST(SlowStudyOrder, YieldingChannelsWithAKneeAreWithinTheirReach) {
  EXPECT_LT(error_of("smd-channel", 32, "internal", {"walls=1", "jump_number=150", "numerics.precision=double"}), 0.01);
  EXPECT_LT(error_of("bingham-channel", 16, "internal", {"walls=1"}), 0.01);
}

TEST(SlowStudyOrder, CavityIsWithinItsReach) {
  const Pair p = errors_of("cavity", 50, "internal");
  EXPECT_LT(p.coarse, 0.003);
  EXPECT_LT(p.fine, 0.0025);
  EXPECT_LT(error_of("cavity", 50, "internal", {}, "v_rms"), 0.003);
}

}  // namespace
}  // namespace molten::study::study_order_test
