// One process at a time in a run's folder.
#pragma once

#include <filesystem>

namespace molten {

/// Holds a run's folder until it is destroyed or the process ends, however it ends; leaves nothing in the folder.
class RunLock {
 public:
  /// Throws Error(files) if another process holds it. Where the file system knows no locks, none is held.
  explicit RunLock(const std::filesystem::path& folder);
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace molten
