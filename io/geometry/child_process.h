// Runs a piece of work in a short-lived copy of this process, so that a crash, an endless loop or a hunger for memory
// in a library costs one clear line and not the run.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace molten {

struct ChildLimits {
  std::size_t memory = 0;  // bytes beyond what this process has now
  int seconds = 0;         // of processor time; wall time gets a few more
  std::size_t answer = 0;  // bytes
};

struct ChildAnswer {
  std::string bytes;    // what the work returned
  std::string failure;  // why there is no answer, such as "it took more than 60 s"; empty when there is
};

/// The work may throw: the failure is then its what(). It must not use threads, nor locks that other threads may hold.
/// `waiting` is called about once a second meanwhile.
ChildAnswer run_in_child(const std::function<std::string()>& work, const ChildLimits& limits,
                         const std::function<void()>& waiting = {});

}  // namespace molten
