// What the program's commands do beside running: check, info, render, compare.
#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/scene.h"
#include "io/picture/render.h"

namespace molten {

/// Prints what `run` would do: particles, memory, time step and its limit, estimated run time, features, mesh defects.
ExitCode check_scene(const Scene& scene);

/// Prints what a run folder, frame, checkpoint or mesh holds.
ExitCode show_info(const std::filesystem::path& file);

struct RenderChoice {
  std::filesystem::path run, output;  // output: folder for the pictures; default RUN/pictures
  std::string frames = "all";         // "all", "last", or numbers as "0,10,20" or "0:100:10"
  PictureOptions picture;
};
ExitCode render_run(const RenderChoice& choice);

/// Compares the last frames that two runs have in common, or two frames: largest and mean differences by id.
ExitCode compare(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace molten
