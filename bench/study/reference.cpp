#include "bench/study/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/error.h"

namespace molten::study {

namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

std::size_t column(const std::vector<std::string>& names, const std::string& name, const std::string& file) {
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) throw Error(ExitCode::files, fmt::format("{}: has no column {}; check the file", file, name));
  return it - names.begin();
}

/// The next line that is no comment.
bool next_line(std::istream& in, std::string& line) {
  while (std::getline(in, line)) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (!line.empty() && line[0] != '#') return true;
  }
  return false;
}

}  // namespace

std::optional<Series> reference(const std::string& file, const std::string& abscissa, const std::string& ordinate) {
  const char* folder = std::getenv("MOLTEN_REFERENCE");
  if (!folder || !*folder) {
    fmt::print(stderr, "study: {} is not judged: MOLTEN_REFERENCE names no folder of references\n", file);
    return std::nullopt;
  }
  const std::string path = (std::filesystem::path(folder) / file).string();
  std::ifstream in(path);
  std::string line;
  if (!in || !next_line(in, line)) {
    fmt::print(stderr, "study: {} is not judged: cannot be read\n", path);
    return std::nullopt;
  }
  const std::vector<std::string> names = cells_of(line);
  const std::size_t a = column(names, abscissa, path), b = column(names, ordinate, path);
  Series series;
  while (next_line(in, line)) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() <= std::max(a, b)) throw Error(ExitCode::files, path + ": a line is too short: " + line);
    series.add(std::atof(cells[a].c_str()), std::atof(cells[b].c_str()));
  }
  return series;
}

}  // namespace molten::study
