// The progress line of a run: rewritten in place on a terminal, plain lines every few seconds elsewhere.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

#include "core/diagnostics.h"

namespace molten {

class Progress {
 public:
  Progress(double start_time, double end_time, double initial_energy);

  /// True when a line is due, so that its figures are worked out only then.
  bool is_due() const;
  void show(const Clock& clock, const Diagnostics& now);
  void finish();  // ends a rewritten line

 private:
  using Time = std::chrono::steady_clock::time_point;
  double start_time_, end_time_, initial_energy_;
  bool terminal_;
  Time begun_, last_;
  std::int64_t last_step_ = -1;
  bool shown_ = false;
};

/// Names the stages of long work, with the seconds that have passed: nothing while the work is short.
class Stages {
 public:
  ~Stages() { finish(); }
  /// `at`: what begins now, such as "reading a.ply".
  void begin(const std::string& at);
  /// To be called now and then during a stage.
  void tick();
  /// Ends a rewritten line, so that something else can be printed.
  void finish();

 private:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr double short_work = 2;  // s
  std::string at_;
  Time begun_ = std::chrono::steady_clock::now(), last_ = begun_;
  bool terminal_ = isatty(STDERR_FILENO), shown_ = false;

  void show();
};

/// "2 h 05 min", "3 min 20 s", "12 s"
std::string in_words(double seconds);

}  // namespace molten
