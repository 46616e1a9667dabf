// series.csv of a run: one row whenever due; units in the header, columns for what the run has.
#pragma once

#include <filesystem>
#include <fstream>

#include "core/diagnostics.h"

namespace molten {

class Series {
 public:
  /// What a resume keeps of the file: its first rows, none of a later step. It makes the others again.
  struct Kept {
    std::int64_t rows = 0, step = 0;
  };

  /// Opens the file; `bodies`: how many move.
  Series(const std::filesystem::path& file, const Kept& kept, const Features& features, std::size_t bodies);
  /// Throws Error(files) when the disk is full.
  void add(const Clock& clock, const Diagnostics& d);
  std::int64_t rows() const { return rows_; }

 private:
  std::filesystem::path file_;
  Features features_;
  std::int64_t rows_ = 0;
  std::ofstream out_;
};

}  // namespace molten
