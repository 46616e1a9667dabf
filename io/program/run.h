// Running a scene from start to end, and going on from a checkpoint.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/scene.h"

namespace molten {

struct RunOptions {
  std::filesystem::path folder;  // of the run
  int threads = 0;               // 0: as OpenMP has it
  bool overwrite = false;        // delete a run that the folder already holds
};

/// Runs to the end (done) or to a signal (interrupted). Throws Error.
ExitCode run_scene(const Scene& scene, const RunOptions& options);

struct ResumeOptions {
  std::filesystem::path folder;
  std::vector<std::string> overrides;  // of the scene as run; only run.* and output.* without force
  int threads = 0;
  bool force = false;  // go on although the scene changed
};

/// Goes on from the newest usable checkpoint.
ExitCode resume_run(const ResumeOptions& options);

}  // namespace molten
