// Runs the real program as a person would, and keeps what it said.
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tests/replaced.h"
#include "tests/temp_folder.h"

namespace molten {

struct Outcome {
  int code = -1;   // exit code; -1 when a signal ended it
  int signal = 0;  // that signal
  std::string out, err;
};

/// The program under way. Its output goes to two files in a folder of its own.
class Program {
 public:
  explicit Program(const std::vector<std::string>& arguments, const std::filesystem::path& working = {},
                   const char* file = MOLTEN_PROGRAM) {
    child_ = fork();
    if (child_ == 0) become(file, arguments, working);
  }
  ~Program() {
    if (child_ > 0) kill(SIGKILL), wait();
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void kill(int number) const { ::kill(child_, number); }

  /// True as soon as `there()` is; false when the program ended or 60 s passed before.
  bool waits_for(const std::function<bool()>& there) {
    for (int k = 0; k < 12000; ++k) {
      if (there()) return true;
      if (is_over()) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }

  Outcome wait() {
    if (child_ > 0) waitpid(child_, &status_, 0), child_ = -1;
    Outcome o;
    if (WIFEXITED(status_)) o.code = WEXITSTATUS(status_);
    if (WIFSIGNALED(status_)) o.signal = WTERMSIG(status_);
    o.out = read_bytes(folder_.path() / "out");
    o.err = read_bytes(folder_.path() / "err");
    return o;
  }

 private:
  [[noreturn]] void become(const char* file, const std::vector<std::string>& arguments,
                           const std::filesystem::path& working) {
    const int out = open((folder_.path() / "out").c_str(), O_WRONLY | O_CREAT, 0600);
    const int err = open((folder_.path() / "err").c_str(), O_WRONLY | O_CREAT, 0600);
    const int in = open("/dev/null", O_RDONLY);
    dup2(in, 0), dup2(out, 1), dup2(err, 2);
    // Small runs: one thread unless a test says otherwise, so that a busy machine does not slow them.
    setenv("OMP_NUM_THREADS", "1", 1);
    ::signal(SIGHUP, SIG_DFL);  // whoever runs the tests with nohup
    if (!working.empty() && chdir(working.c_str()) != 0) _exit(126);
    std::vector<char*> argv{const_cast<char*>(file)};
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    execv(file, argv.data());
    _exit(127);
  }

  bool is_over() {
    if (child_ > 0 && waitpid(child_, &status_, WNOHANG) == child_) child_ = -1;
    return child_ < 0;
  }

  TempFolder folder_;
  pid_t child_ = -1;
  int status_ = 0;
};

inline Outcome molten_program(const std::vector<std::string>& arguments, const std::filesystem::path& working = {}) {
  return Program(arguments, working).wait();
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// One line on stderr that says who speaks, nothing on stdout, and the code.
inline void expect_refused(const Outcome& o, int code, const std::vector<std::string>& parts) {
  EXPECT_EQ(o.code, code) << o.err;
  EXPECT_TRUE(o.err.starts_with("molten: ")) << o.err;
  EXPECT_EQ(o.err.find('\n'), o.err.size() - 1) << "one line, not: " << o.err;
  EXPECT_EQ(o.out, "");
  for (const std::string& part : parts) EXPECT_TRUE(contains(o.err, part)) << "no '" << part << "' in: " << o.err;
}

/// A small scene: a block beside a floor.
inline const std::string block_scene = R"([scene]
title = "A block"
dimensions = 2
[fluid]
box = { min = [0.0, 0.02], max = [0.2, 0.3] }
spacing = 0.02
[fluid.rheology]
model = "newtonian"
viscosity = 5.0
[[boundary]]
plane = { point = [0, 0], normal = [0, 1] }
[run]
end_time = 0.04
[output]
frames_per_second = 50
)";

/// A cube of side 1 as OBJ.
inline const std::string cube_obj =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";

inline std::string mesh_scene(const std::string& mesh) {
  return fmt::format("[fluid]\nmesh = \"{}\"\nspacing = 0.2\n[run]\nend_time = 0.001\n", mesh);
}

/// A folder with a blank in its name, a scene in it, and where its run would go.
class ProgramTest : public ::testing::Test {
 protected:
  std::filesystem::path scene(const std::string& text = block_scene, const std::string& name = "my scene.toml") const {
    write_bytes(folder.path() / name, text);
    return folder.path() / name;
  }
  Outcome run(const std::string& text, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"run", scene(text).string(), "-o", out.string()};
    all.insert(all.end(), more.begin(), more.end());
    return molten_program(all);
  }
  /// The scene is refused, by run and by check, and no folder is made.
  void expect_bad(const std::string& text, int code, const std::vector<std::string>& parts,
                  const std::vector<std::string>& more = {}) const {
    expect_refused(run(text, more), code, parts);
    EXPECT_FALSE(std::filesystem::exists(out)) << "a folder was made for a bad scene";
    std::vector<std::string> all{"check", scene(text).string()};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome o = molten_program(all);
    EXPECT_EQ(o.code, code) << o.err;
    for (const std::string& part : parts)
      EXPECT_TRUE(contains(o.err, part)) << "check: no '" << part << "' in: " << o.err;
  }
  std::string file(const std::string& name, const std::string& bytes) const {
    write_bytes(folder.path() / name, bytes);
    return (folder.path() / name).string();
  }

  TempFolder folder;
  std::filesystem::path out = folder.path() / "the run";
};

}  // namespace molten
