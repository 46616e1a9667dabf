// Checkpoints of a run: one HDF5 file each in checkpoints/, written under a temporary name, checksummed, synced and
// renamed, so that a crash at any moment leaves the older ones whole.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/archive.h"

namespace molten {

/// What identifies the run that a checkpoint belongs to; stored in it and checked on resume.
struct CheckpointHead {
  std::int64_t step = 0;
  double time = 0;         // s
  std::string scene_text;  // as run
  std::string scene_hash;  // of everything that may not change between stop and resume
  std::string version;     // of molten
};

/// Saves what `save` archives to checkpoints/step-<step>.h5 and keeps the newest `keep` files.
void write_checkpoint(const std::filesystem::path& run_folder, const CheckpointHead& head,
                      const std::function<void(Archive&)>& save, int keep);

/// Checkpoint files of a run, newest first (by step).
std::vector<std::filesystem::path> list_checkpoints(const std::filesystem::path& run_folder);

/// Reads the head after checking format version and checksum; throws Error(checkpoint) with the reason.
CheckpointHead read_checkpoint_head(const std::filesystem::path& file);

/// Restores through `load`; throws Error(checkpoint) when an array is missing or has another size or type.
void read_checkpoint(const std::filesystem::path& file, const std::function<void(Archive&)>& load);

}  // namespace molten
