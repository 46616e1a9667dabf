#include "io/hdf5/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.h"

namespace molten {
namespace {

namespace fs = std::filesystem;
constexpr const char* temporary_suffix = ".tmp";

[[noreturn]] void fail(const fs::path& file, const std::string& action, int error) {
  throw Error(ExitCode::files, file.string() + ": cannot " + action + ": " + std::strerror(error) +
                                   (error == ENOSPC ? "; free some space on that disk" : ""));
}

// A rename survives a power cut only when the file's bytes and then the folder's entry are on the disk.
void sync(const fs::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags);
  if (descriptor < 0) fail(path, "open", errno);
  const int status = ::fsync(descriptor);
  const int error = errno;
  ::close(descriptor);
  // Some file systems can't sync a folder and say EINVAL; there is nothing better to do on them.
  if (status != 0 && error != EINVAL) fail(path, "write", error);
}

}  // namespace

AtomicFile::AtomicFile(fs::path place) : place_(std::move(place)), temporary_(place_.string() + temporary_suffix) {
  if (!place_.has_parent_path()) return;
  std::error_code error;
  fs::create_directories(place_.parent_path(), error);
  if (error) fail(place_.parent_path(), "make this folder", error.value());
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  sync(temporary_, O_RDONLY);
  if (::rename(temporary_.c_str(), place_.c_str()) != 0) fail(place_, "put into place", errno);
  temporary_.clear();
  sync(place_.has_parent_path() ? place_.parent_path() : fs::path("."), O_RDONLY | O_DIRECTORY);
}

void write_text_atomically(const fs::path& place, std::string_view text) {
  AtomicFile file(place);
  std::ofstream out(file.temporary(), std::ios::binary);
  if (!out) fail(place, "write", errno);
  errno = 0;
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) fail(place, "write", errno ? errno : EIO);
  file.commit();
}

void remove_temporaries(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->path().extension() == temporary_suffix) fs::remove(entry->path(), ignored);
  }
}

}  // namespace molten
