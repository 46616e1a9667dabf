// Stands in for a full disk: while it lives, no file can be written beyond a size, and writes fail in the same places.
#pragma once

#include <signal.h>
#include <sys/resource.h>

namespace molten {

class SmallFilesOnly {
 public:
  explicit SmallFilesOnly(rlim_t bytes) : old_action_(signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit small{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallFilesOnly() {
    setrlimit(RLIMIT_FSIZE, &old_);
    signal(SIGXFSZ, old_action_);
  }
  SmallFilesOnly(const SmallFilesOnly&) = delete;
  SmallFilesOnly& operator=(const SmallFilesOnly&) = delete;

 private:
  void (*old_action_)(int);
  rlimit old_{};
};

}  // namespace molten
