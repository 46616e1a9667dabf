// series.csv of a run: one row whenever due; units in the header, columns for what the run has.
#pragma once

#include <filesystem>
#include <fstream>

#include "core/diagnostics.h"

namespace molten {

class Series {
 public:
  /// Opens the file with its first `keep` rows; a resume makes the others again. `bodies`: how many move.
  Series(const std::filesystem::path& file, std::int64_t keep, const Features& features, std::size_t bodies);
  /// Throws Error(files) when the disk is full.
  void add(const Clock& clock, const Diagnostics& d);

 private:
  std::filesystem::path file_;
  Features features_;
  std::ofstream out_;
};

}  // namespace molten
