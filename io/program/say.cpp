#include "io/program/say.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

#include "core/error.h"

namespace molten {

void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1) (void)!open("/dev/null", O_RDWR);  // takes the lowest number that is free
}

void put_on_error(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void finish_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout))
    throw Error(ExitCode::files, "standard output: cannot write; check the disk");
}

}  // namespace molten
