// series.csv of a run: one row whenever due; units in the header.
#pragma once

#include <filesystem>
#include <fstream>

#include "core/diagnostics.h"

namespace molten {

class Series {
 public:
  /// Opens the file; `keep_until_step` >= 0 drops rows of later steps first (resume makes them again).
  Series(const std::filesystem::path& file, std::int64_t keep_until_step);
  /// Throws Error(files) when the disk is full.
  void add(const Clock& clock, const Diagnostics& d);

 private:
  std::filesystem::path file_;
  std::ofstream out_;
};

}  // namespace molten
