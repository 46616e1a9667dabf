// The study's command line: its CSV, what it refuses, and a run that diverges.
#include "tests/program.h"

namespace molten::study_program_test {
namespace {

Outcome study_program(const std::vector<std::string>& arguments) { return Program(arguments, {}, MOLTEN_STUDY).wait(); }

void expect_one_line(const Outcome& o, int code, const std::string& part) {
  EXPECT_EQ(o.code, code) << o.err;
  EXPECT_EQ(o.out, "");
  EXPECT_TRUE(o.err.starts_with("study: ")) << o.err;
  EXPECT_EQ(o.err.find('\n'), o.err.size() - 1) << o.err;
  EXPECT_TRUE(contains(o.err, part)) << o.err;
}

std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows(1);
  std::string cell;
  for (const char c : csv) {
    if (c != ',' && c != '\n') cell += c;
    if (c == ',' || c == '\n') rows.back().push_back(cell), cell.clear();
    if (c == '\n') rows.emplace_back();
  }
  rows.pop_back();
  return rows;
}

TEST(StudyProgram, PrintsCsvWithItsHeaderFirst) {
  const Outcome o = study_program({"--case", "hot-spot", "--size=16", "--set", "numerics.precision=double"});
  EXPECT_EQ(o.code, 0) << o.err;
  const auto rows = rows_of(o.out);
  ASSERT_EQ(rows.size(), 2u) << o.out;
  EXPECT_EQ(rows[0], (std::vector<std::string>{"case", "numerics", "dimensions", "particles", "size", "steps",
                                               "wall_time_s", "quantity", "error", "reach"}));
  ASSERT_EQ(rows[1].size(), rows[0].size());
  EXPECT_EQ(rows[1][0], "hot-spot");
  EXPECT_EQ(rows[1][1], "molten precision=double");
  EXPECT_EQ(rows[1][2], "2");
  EXPECT_EQ(rows[1][3], "256");
  EXPECT_EQ(rows[1][4], "16");
  EXPECT_GT(std::stod(rows[1][8]), 0);
  EXPECT_DOUBLE_EQ(std::stod(rows[1][9]), 0.005);
}

TEST(StudyProgram, TheDocumentationTablesEveryCase) {
  const Outcome o = study_program({"--list"});
  EXPECT_EQ(o.code, 0);
  const std::string page = read_bytes(std::filesystem::path(MOLTEN_SOURCE_DIR) / "docs/study.md");
  const std::string table = o.out.substr(0, o.out.find_last_not_of('\n') + 1);
  EXPECT_TRUE(contains(page, table)) << "put the output of study --list into docs/study.md";
}

TEST(StudyProgram, RefusesInOneLine) {
  expect_one_line(study_program({}), 2, "--case");
  expect_one_line(study_program({"--case", "taylor-gren"}), 2, "taylor-green");
  expect_one_line(study_program({"--case", "taylor-green", "--size", "many"}), 2, "--size");
  expect_one_line(study_program({"--case", "taylor-green", "--size", "2"}), 2, "whole number from");
  expect_one_line(study_program({"--case", "taylor-green", "--size"}), 2, "value");
  expect_one_line(study_program({"--case", "taylor-green", "--set", "reinolds=3"}), 2, "reynolds");
  expect_one_line(study_program({"--case", "taylor-green", "--set", "reynolds=fast"}), 2, "number");
  expect_one_line(study_program({"--case", "taylor-green", "--set", "reynolds"}), 2, "key=value");
  expect_one_line(study_program({"--case", "taylor-green", "--numerics", "worst"}), 2, "numerics.preset");
  expect_one_line(study_program({"--case", "taylor-green", "--set", "numerics.kernl=lucy"}), 2, "kernl");
  expect_one_line(study_program({"--cast", "taylor-green"}), 2, "--cast");
}

TEST(StudyProgram, ARunThatDivergesIsNotANumberAndExitsWithFour) {
  const Outcome o = study_program({"--case", "elliptic-drop", "--size", "8", "--set", "numerics.fixed_dt=0.1"});
  EXPECT_EQ(o.code, 4) << o.err;
  EXPECT_TRUE(contains(o.err, "diverged")) << o.err;
  const auto rows = rows_of(o.out);
  ASSERT_EQ(rows.size(), 5u) << o.out;
  for (std::size_t k = 1; k < rows.size(); ++k) EXPECT_EQ(rows[k][8], "nan");
}

}  // namespace
}  // namespace molten::study_program_test
