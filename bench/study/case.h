// A case of the study: a problem whose answer is known, set up from a few numbers, run, and judged.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace molten::study {

/// For what is reported without a number to stay under.
inline constexpr double no_reach = std::numeric_limits<double>::infinity();

/// The parameter that every case has: the time step over the one that the numerics would choose.
inline constexpr const char* step_factor = "step_factor";

/// A number of the case that `--set name=value` changes.
struct Parameter {
  std::string name;
  double value = 0;     // default
  std::string meaning;  // with its unit
};

/// What the person asked for.
struct Request {
  long long size = 0;
  std::string numerics = "molten";           // preset
  std::map<std::string, double> given;       // every parameter of the case, set or default
  std::vector<std::string> scene_overrides;  // key=value of the scene, such as numerics.kernel=cubic_spline

  double operator[](const std::string& parameter) const { return given.at(parameter); }
};

/// One quantity judged; `error` is not a number until it is known.
struct Judgement {
  std::string quantity;
  double error = std::numeric_limits<double>::quiet_NaN();
  double reach = no_reach;  // the number to stay under
};

/// What a run of a case gives.
struct Report {
  int dimensions = 2;
  std::int64_t particles = 0, steps = 0;
  double wall_time = 0;  // s, of the stepping loop
  std::vector<Judgement> judgements;

  /// Names a quantity before the run, so that a run that diverges still has its line.
  void expect(const std::string& quantity, double reach) { judgements.push_back({quantity, {}, reach}), reset_last(); }
  void judge(const std::string& quantity, double error);

 private:
  void reset_last() { judgements.back().error = std::numeric_limits<double>::quiet_NaN(); }
};

struct Case {
  std::string name, what;
  std::string size_meaning;
  long long size = 0;        // default
  long long least_size = 4;  // below it there is nothing to judge
  std::vector<Parameter> parameters;
  void (*run)(const Request&, Report&);
};

/// Every case, in the order of the documentation.
const std::vector<Case>& all_cases();

}  // namespace molten::study
