// Frames of a run: VTKHDF 1.0 UnstructuredGrid, one .hdf file a frame (frames/000000.hdf …) and frames.hdf.series in
// the run's folder, as ParaView 5.11 opens them.
#pragma once

#include <filesystem>
#include <vector>

#include "core/snapshot.h"

namespace molten {

struct FrameEntry {
  std::filesystem::path file;
  double time = 0;  // s
};

/// Writes frames/NNNNNN.hdf under `run_folder` (temporary name, then rename) and rewrites frames.hdf.series.
void write_frame(const std::filesystem::path& run_folder, int number, const Snapshot& snapshot);

/// The frames of a run by number; throws Error(files) when the folder holds none.
std::vector<FrameEntry> list_frames(const std::filesystem::path& run_folder);

/// Reads one frame back, all fields.
Snapshot read_frame(const std::filesystem::path& file);

/// Drops frames with a number of `first` or more (resume makes them again); returns how many are left.
std::int64_t drop_frames_from(const std::filesystem::path& run_folder, int first);

}  // namespace molten
