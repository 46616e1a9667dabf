// A file that appears whole or not at all: written under a temporary name beside its place, synced, then renamed.
#pragma once

#include <filesystem>
#include <string_view>

namespace molten {

/// While it lives, `temporary()` is the name to write to; `commit()` moves it into place, and without that the
/// temporary is removed again. Errors are Error(files).
class AtomicFile {
 public:
  /// Makes the missing folders above `place`.
  explicit AtomicFile(std::filesystem::path place);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  void commit();

 private:
  std::filesystem::path place_, temporary_;
};

void write_text_atomically(const std::filesystem::path& place, std::string_view text);

/// Removes what a crash left of AtomicFiles in `folder`.
void remove_temporaries(const std::filesystem::path& folder);

}  // namespace molten
