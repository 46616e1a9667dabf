// The study against experiments: series made up here, whose scores follow by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "bench/study/dam_break.h"
#include "bench/study/reference.h"
#include "bench/study/request.h"
#include "core/error.h"
#include "tests/temp_folder.h"

namespace molten::study::study_reference_test {
namespace {

/// MOLTEN_REFERENCE as this test wants it.
class ReferenceFolder {
 public:
  explicit ReferenceFolder(const char* folder) {
    if (const char* before = std::getenv("MOLTEN_REFERENCE")) before_ = before;
    folder ? setenv("MOLTEN_REFERENCE", folder, 1) : unsetenv("MOLTEN_REFERENCE");
  }
  ~ReferenceFolder() {
    before_.empty() ? unsetenv("MOLTEN_REFERENCE") : setenv("MOLTEN_REFERENCE", before_.c_str(), 1);
  }

 private:
  std::string before_;
};

TEST(StudyReference, ReadsTwoColumnsByNameAndSkipsWhatIsNotThere) {
  const TempFolder folder;
  write_bytes(folder.path() / "a.csv", "# a comment\nT,other,Z\n0,9,1\n# more\n1,9,2.5\r\n");
  write_bytes(folder.path() / "short.csv", "T,Z\n0\n");
  const ReferenceFolder set(folder.path().c_str());
  const auto s = reference("a.csv", "T", "Z");
  ASSERT_TRUE(s);
  EXPECT_EQ(s->at, (std::vector<double>{0, 1}));
  EXPECT_EQ(s->value, (std::vector<double>{1, 2.5}));
  EXPECT_FALSE(reference("none.csv", "T", "Z"));
  EXPECT_THROW(reference("a.csv", "T", "Q"), Error);
  EXPECT_THROW(reference("short.csv", "T", "Z"), Error);
  const ReferenceFolder unset(nullptr);
  EXPECT_FALSE(reference("a.csv", "T", "Z"));
}

// ---- scores of series -----------------------------------------------------------------------------------------------

std::map<std::string, double> errors_of(const Report& report) {
  std::map<std::string, double> errors;
  for (const Judgement& j : report.judgements) errors[j.quantity] = j.error;
  return errors;
}

TEST(StudyScores, AnExperimentThatLagsIsJudgedRawAndShifted) {
  // The run is at 1 + 2 t; the experiment is where the run was 0.1 s before, so 0.2 behind.
  Series run, experiment;
  for (double t = -1; t < 3.005; t += 0.01) run.add(t, 1 + 2 * t);
  double squares = 0;
  for (int k = 0; k <= 20; ++k) {
    const double t = 0.1 * k, there = 0.8 + 2 * t;
    experiment.add(t, there);
    squares += std::pow(0.2 / there, 2);
  }
  Report report;
  expect_series(report, "front", 1, 1);
  judge_series(report, "front", run, experiment);
  auto errors = errors_of(report);
  EXPECT_NEAR(errors["front_raw"], std::sqrt(squares / 21), 1e-12);
  EXPECT_LT(errors["front_shifted"], 1e-3);
  EXPECT_NEAR(errors["front_time_shift"], 0.1 / 2, 1e-3) << "over the experiment's 2 s";
}

// ---- whole cases ----------------------------------------------------------------------------------------------------
// At its start every column is where the scene puts it, so a series of that moment alone has a known score.

struct MadeUp {
  const char *name, *file, *text;
  std::vector<std::string> settings;
  std::map<std::string, double> errors;
};

std::map<std::string, double> judged(const MadeUp& made_up) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.path() / "dambreak");
  write_bytes(folder.path() / "dambreak" / made_up.file, made_up.text);
  const ReferenceFolder set(folder.path().c_str());
  const Case& chosen = find_case(made_up.name);
  const std::string size = std::to_string(std::max(chosen.least_size, 8LL));
  Report report;
  EXPECT_TRUE(run_case(chosen, make_request(chosen, size, "", made_up.settings), report));
  return errors_of(report);
}

TEST(StudyExperiments, ScoresOfTheFirstMomentAreThoseByHand) {
  const std::vector<MadeUp> all = {
      // The front in widths over time in roots of widths: 1 at the start, whatever the width.
      {"koshizuka",
       "koshizuka_oka1996_exp_front_dualsphysics.csv",
       "t_s,x_tip_m\n0,1.25\n0.001,1.25\n",
       {"width=2", "perturbation=0"},
       {{"front_raw", 0.2}, {"front_shifted", 0.2}}},
      {"martin-moyce",
       "martin_moyce1952_table2_front_n2_2_a2.25in.csv",
       "T,Z\n0,0.8\n0.001,0.8\n",
       {"end_time=0.1", "perturbation=0"},
       {{"front_raw", 0.25}, {"front_shifted", 0.25}}},
      // The height in heights of the column, not in widths.
      {"martin-moyce",
       "martin_moyce1952_table6_height_n2_2_a2.25in.csv",
       "tau,H\n0,0.8\n0.001,0.8\n",
       {"end_time=0.1", "perturbation=0"},
       {{"height_raw", 0.25}}},
      // 1 + (x − 0.6 m)/H; only what comes after T = 0.1 and before the wall counts.
      {"lobovsky-front",
       "lobovsky2014_fig12_front_H600mm.csv",
       "T,Z\n0,0.1\n0.11,1.25\n0.12,1.25\n1,3\n1.1,3\n",
       {"gate=0", "perturbation=0"},
       {{"front_raw", 0.2}}},
      // Gauge H4 stands 0.582 m from the wall behind the water, 0.55 m deep; H2 is dry; no pressure has come yet.
      {"kleefsman",
       "spheric_test2_kleefsman_full_exp_data.csv",
       "t_s,H2,H4,P1,P2\n0,0.11,0.44,0,0\n0.001,0.11,0.44,500,100\n",
       {"end_time=0.005"},
       {{"h2_mean", 0.2},
        {"h2_shifted", 0.2},
        {"h4_mean", 0.2},
        {"p1_peak", 1},
        {"p2_peak", 1},
        {"p1_arrival", INFINITY}}}};
  for (const MadeUp& made_up : all) {
    auto found = judged(made_up);
    for (const auto& [quantity, error] : made_up.errors) {
      ASSERT_TRUE(found.contains(quantity)) << made_up.name << ' ' << quantity;
      if (std::isinf(error))
        EXPECT_EQ(found[quantity], error) << made_up.name << ' ' << quantity;
      else
        EXPECT_NEAR(found[quantity], error, 0.01) << made_up.name << ' ' << quantity;
    }
  }
}

}  // namespace
}  // namespace molten::study::study_reference_test
