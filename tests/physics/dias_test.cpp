// Dias 2017: its own fronts, at its numbers of particles, within 2 %, and when its column of figure 6.1 reaches the
// wall.
#include <gtest/gtest.h>

#include <map>

#include "bench/study/request.h"

namespace molten::study::dias_test {
namespace {

std::map<std::string, double> errors_of(const std::string& name, std::int64_t particles,
                                        const std::vector<std::string>& settings) {
  const Case& chosen = find_case(name);
  Report report;
  EXPECT_TRUE(run_case(chosen, make_request(chosen, "", "dias", settings), report));
  EXPECT_EQ(report.particles, particles);
  std::map<std::string, double> errors;
  for (const Judgement& j : report.judgements) errors[j.quantity] = j.error;
  return errors;
}

TEST(SlowDias, FrontsOfColumnBAreItsOwn) {
  for (const char* alpha : {"alpha=0.2", "alpha=0.3"}) {
    auto errors = errors_of("dias-b", 5854, {alpha});
    EXPECT_LT(errors.at("from_dias_0.1s"), 0.02) << alpha;
    EXPECT_LT(errors.at("from_dias_0.2s"), 0.02) << alpha;
  }
}

TEST(SlowDias, WaterWithoutArtificialViscosityReachesTheWallAsThere) {
  EXPECT_LT(errors_of("dias-tank", 5123, {"alpha=0"}).at("wall_arrival"), 0.02);
}

}  // namespace
}  // namespace molten::study::dias_test
