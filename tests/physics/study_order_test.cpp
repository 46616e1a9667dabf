// Orders of convergence that the study's cases show with corrected operators, and errors at one size.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/study/request.h"

namespace molten::study {
namespace {

/// The error of the first quantity that the case judges.
double error_of(const std::string& name, int size, const std::string& numerics,
                const std::vector<std::string>& settings = {}) {
  const Case& chosen = find_case(name);
  Report report;
  EXPECT_TRUE(run_case(chosen, make_request(chosen, std::to_string(size), numerics, settings), report));
  return report.judgements.at(0).error;
}

/// Errors at a size and at twice it.
struct Pair {
  double coarse, fine;
  double order() const { return std::log2(coarse / fine); }
};
Pair errors_of(const std::string& name, int size, const std::string& numerics,
               const std::vector<std::string>& settings = {}) {
  const Pair p{error_of(name, size, numerics, settings), error_of(name, 2 * size, numerics, settings)};
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

TEST(StudyOrder, PoiseuilleConvergesFasterThanInFirstOrder) {
  EXPECT_GT(errors_of("poiseuille", 12, "internal", {"walls=0"}).order(), 1.5);
}

TEST(SlowStudyOrder, HotSpotInASolidIsOfSecondOrderWithCorrection) {
  EXPECT_GT(errors_of("hot-spot", 25, "molten", {"numerics.gradient_correction=true", "dimensions=3"}).order(), 1.8);
}

TEST(SlowStudyOrder, PoiseuilleIsWithinItsReach) {
  EXPECT_LT(error_of("poiseuille", 64, "internal", {"walls=0"}), 0.005);
}

}  // namespace
}  // namespace molten::study
