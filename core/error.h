// The one exception that molten throws on purpose: a line for the person and the program's exit code.
#pragma once

#include <stdexcept>
#include <string>

namespace molten {

enum class ExitCode : int {
  done = 0,
  usage = 2,         // usage, scene, or a run that won't fit in memory
  geometry = 3,      // missing or bad mesh or grid, overlap at the start
  diverged = 4,      // the state turned non-finite
  files = 5,         // input/output, disk, existing or unwritable output folder
  checkpoint = 6,    // unusable checkpoint
  interrupted = 75,  // stopped cleanly, resumable
};

/// `what()` is one line: the place (file, line or key), what is wrong, and what to do.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& line) : std::runtime_error(line), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace molten
