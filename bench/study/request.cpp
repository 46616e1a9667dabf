#include "bench/study/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"

namespace molten::study {

namespace {

[[noreturn]] void refuse(const std::string& line) { throw Error(ExitCode::usage, line); }

double number(const std::string& key, const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    refuse(fmt::format("{}: \"{}\" is no finite number; give one such as {}=0.5", key, text, key));
  return value;
}

/// "a, b, c" of things with a name.
template <class T> std::string names_of(const std::vector<T>& things) {
  std::string names;
  for (const T& thing : things) names += (names.empty() ? "" : ", ") + thing.name;
  return names;
}

bool is_scene_key(const std::string& key) { return key.starts_with("numerics.") || key.starts_with("boundary."); }

void apply(const Case& chosen, Request& request, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0)
    refuse(fmt::format("--set {}: wants key=value, such as --set numerics.kernel=cubic_spline", setting));
  const std::string key = setting.substr(0, equals), value = setting.substr(equals + 1);
  if (is_scene_key(key)) {
    request.scene_overrides.push_back(setting);
  } else if (request.given.contains(key)) {
    request.given[key] = number(key, value);
    if (key == "dimensions" && request.given[key] != 2 && request.given[key] != 3)
      refuse(fmt::format("--set {}: a case runs in 2 or 3 dimensions", setting));
    if ((key == "end_time" || key == step_factor) && request.given[key] <= 0)
      refuse(fmt::format("--set {}: must be above 0", setting));
  } else {
    refuse(
        fmt::format("--set {}: {} has no such parameter; it has {}{}{}; keys of the scene go with their table, such as "
                    "numerics.kernel",
                    key, chosen.name, names_of(chosen.parameters), chosen.parameters.empty() ? "" : ", ", step_factor));
  }
}

/// Quoted where a comma or a quote would break the line.
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

/// The preset and the keys that override it: "molten kernel=cubic_spline".
std::string numerics_name(const Request& request) {
  std::string name = request.numerics;
  for (const std::string& o : request.scene_overrides)
    name += " " + (o.starts_with("numerics.") ? o.substr(sizeof("numerics.") - 1) : o);
  return name;
}

std::string csv_number(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return fmt::format("{:.6g}", value);
}

}  // namespace

void Report::judge(const std::string& quantity, double error) {
  const auto of_name = [&](const Judgement& j) { return j.quantity == quantity; };
  const auto it = std::find_if(judgements.begin(), judgements.end(), of_name);
  if (it == judgements.end()) throw std::logic_error("the case did not expect " + quantity);
  it->error = error;
}

const Case& find_case(const std::string& name) {
  for (const Case& c : all_cases())
    if (c.name == name) return c;
  refuse(fmt::format("--case {}: no such case; there are {}", name, names_of(all_cases())));
}

Request make_request(const Case& chosen, const std::string& size, const std::string& numerics,
                     const std::vector<std::string>& settings) {
  Request request;
  request.size = chosen.size;
  if (!size.empty()) {
    const double asked = number("--size", size);
    if (asked != std::floor(asked) || asked < static_cast<double>(chosen.least_size) || asked > 1e9)
      refuse(fmt::format("--size {}: {} wants a whole number from {} to 1e9: {}", size, chosen.name, chosen.least_size,
                         chosen.size_meaning));
    request.size = static_cast<long long>(asked);
  }
  if (!numerics.empty()) request.numerics = numerics;
  request.given[step_factor] = 1;
  for (const Parameter& p : chosen.parameters) request.given[p.name] = p.value;
  for (const std::string& setting : settings) apply(chosen, request, setting);
  return request;
}

std::string csv_header() { return "case,numerics,dimensions,particles,size,steps,wall_time_s,quantity,error,reach\n"; }

std::string csv_lines(const Case& chosen, const Request& request, const Report& report) {
  std::string lines;
  for (const Judgement& j : report.judgements)
    lines += fmt::format("{},{},{},{},{},{},{:.4g},{},{},{}\n", chosen.name, csv_text(numerics_name(request)),
                         report.dimensions, report.particles, request.size, report.steps, report.wall_time, j.quantity,
                         csv_number(j.error), csv_number(j.reach));
  return lines;
}

bool run_case(const Case& chosen, const Request& request, Report& report) {
  try {
    chosen.run(request, report);
    return true;
  } catch (const Error& e) {
    if (e.code() != ExitCode::diverged) throw;
    fmt::print(stderr, "study: {}: diverged at step {}: {}\n", chosen.name, report.steps, e.what());
    for (Judgement& j : report.judgements) j.error = std::numeric_limits<double>::quiet_NaN();
    return false;
  }
}

std::string cases_page() {
  std::string page = "| case | what | `--size` (default) | `--set` (default) |\n|---|---|---|---|\n";
  for (const Case& c : all_cases()) {
    std::string parameters;
    for (const Parameter& p : c.parameters)
      parameters += fmt::format("{}`{}` ({:g}): {}", parameters.empty() ? "" : "; ", p.name, p.value, p.meaning);
    page += fmt::format("| {} | {} | {} ({}) | {} |\n", c.name, c.what, c.size_meaning, c.size, parameters);
  }
  return page;
}

}  // namespace molten::study
