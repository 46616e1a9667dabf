#include "io/geometry/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

namespace molten {
namespace {

constexpr int spare_seconds = 5;
constexpr char done = 'd', failed = 'f';

/// Bytes of address space in use; 0 when unknown.
std::size_t address_space() {
  std::size_t pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%zu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void lower_limit(int resource, rlim_t value) {
  rlimit limit{};
  getrlimit(static_cast<__rlimit_resource>(resource), &limit);
  limit.rlim_cur = std::min(limit.rlim_max, value);
  setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

void confine(const ChildLimits& limits, std::size_t in_use) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL})
    std::signal(number, SIG_DFL);
  lower_limit(RLIMIT_CORE, 0);
  lower_limit(RLIMIT_CPU, static_cast<rlim_t>(limits.seconds));
  if (in_use > 0) lower_limit(RLIMIT_AS, in_use + limits.memory);
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int standard : {0, 1, 2}) dup2(nowhere, standard);
}

bool write_all(int pipe, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = write(pipe, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    data += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

[[noreturn]] void be_child(const std::function<std::string()>& work, int pipe) {
  char kind = done;
  std::string answer;
  try {
    answer = work();
  } catch (const std::bad_alloc&) {
    kind = failed;
    answer = "it needs too much memory";
  } catch (const std::exception& error) {
    kind = failed;
    answer = error.what();
  } catch (...) {
    kind = failed;
    answer = "unknown failure";
  }
  const bool sent = write_all(pipe, &kind, 1) && write_all(pipe, answer.data(), answer.size());
  _exit(sent ? 0 : 1);  // no destructors: they belong to the parent
}

/// Reads until the child closes the pipe. False: too long or too much.
bool read_all(int pipe, const ChildLimits& limits, const std::function<void()>& waiting, std::string& bytes,
              std::string& failure) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::seconds(limits.seconds + spare_seconds);
  char buffer[65536];
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd ready{pipe, POLLIN, 0};
    const auto slice = static_cast<int>(std::min<long long>(left, 1000));
    const int polled = left > 0 ? poll(&ready, 1, slice) : 0;
    if (polled < 0 && errno == EINTR) continue;
    if (polled == 0 && left > slice) {
      if (waiting) waiting();
      continue;
    }
    if (polled == 0) {
      failure = "it took more than " + std::to_string(limits.seconds) + " s";
      return false;
    }
    const ssize_t count = read(pipe, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return true;
    bytes.append(buffer, static_cast<std::size_t>(count));
    if (bytes.size() > limits.answer) {
      failure = "it is too large";
      return false;
    }
  }
}

std::string why(int status, const ChildLimits& limits) {
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
    return "it took more than " + std::to_string(limits.seconds) + " s or too much memory";
  if (WIFSIGNALED(status)) return "it made the reader crash (signal " + std::to_string(WTERMSIG(status)) + ")";
  return "the reader stopped without an answer";
}

}  // namespace

ChildAnswer run_in_child(const std::function<std::string()>& work, const ChildLimits& limits,
                         const std::function<void()>& waiting) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return {"", std::string("no pipe: ") + std::strerror(errno)};
  const std::size_t in_use = address_space();
  const pid_t child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    return {"", std::string("no child process: ") + std::strerror(errno)};
  }
  if (child == 0) {
    close(ends[0]);
    confine(limits, in_use);
    be_child(work, ends[1]);
  }
  close(ends[1]);
  ChildAnswer answer;
  if (!read_all(ends[0], limits, waiting, answer.bytes, answer.failure)) kill(child, SIGKILL);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!answer.failure.empty()) return {"", answer.failure};
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || answer.bytes.empty()) return {"", why(status, limits)};
  if (answer.bytes[0] != done) return {"", answer.bytes.size() > 1 ? answer.bytes.substr(1) : "unknown failure"};
  answer.bytes.erase(0, 1);
  return answer;
}

}  // namespace molten
