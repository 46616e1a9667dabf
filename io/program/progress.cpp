#include "io/program/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "io/program/say.h"

namespace molten {

namespace {
constexpr double terminal_interval = 0.3, plain_interval = 5;  // s

double since(std::chrono::steady_clock::time_point t) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - t).count();
}
}  // namespace

std::string in_words(double seconds) {
  constexpr double year = 31557600;
  if (!(seconds < 2 * year)) return seconds < 1e6 * year ? fmt::format("{:.0f} years", seconds / year) : "an age";
  const auto s = static_cast<long long>(std::ceil(std::max(0.0, seconds)));
  if (s >= 3600) return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
  if (s >= 60) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} s", s);
}

Progress::Progress(double start_time, double end_time, double initial_energy)
    : start_time_(start_time),
      end_time_(end_time),
      initial_energy_(initial_energy),
      terminal_(isatty(STDERR_FILENO)),
      begun_(std::chrono::steady_clock::now()),
      last_(begun_) {}

bool Progress::is_due() const { return since(last_) > (terminal_ ? terminal_interval : plain_interval); }

void Progress::show(const Clock& clock, const Diagnostics& now) {
  const double energy = now.kinetic_energy + now.potential_energy;
  const double lap = since(last_), done = clock.time - start_time_, all = end_time_ - start_time_;
  const double rate = last_step_ < 0 ? 0 : static_cast<double>((clock.step - last_step_) * now.particles) / lap;
  const double left = done > 0 ? since(begun_) * (all - done) / done : 0;
  const double drift = initial_energy_ != 0 ? 100 * (energy - initial_energy_) / std::abs(initial_energy_) : 0;
  std::string line = fmt::format(
      "{:5.1f} %  t {:.4g} of {:.4g} s  step {}  dt {:.3g} s ({})  {} particles{}  energy {:+.2f} %",
      end_time_ > 0 ? std::min(100.0, 100 * clock.time / end_time_) : 100, clock.time, end_time_, clock.step, clock.dt,
      name_of(clock.limit), now.particles,
      now.asleep > 0 ? fmt::format(" ({} moving, {} asleep)", now.particles - now.asleep, now.asleep) : "", drift);
  if (rate > 0) line += fmt::format("  {:.2f} M particle-steps/s", rate / 1e6);
  if (done > 0) line += fmt::format("  {} left", in_words(left));
  say("{}{}{}", terminal_ ? "\r\x1b[K" : "", line, terminal_ ? "" : "\n");
  shown_ = true;
  last_ = std::chrono::steady_clock::now();
  last_step_ = clock.step;
}

void Progress::finish() {
  if (terminal_ && shown_) say("\n");
}

void Stages::begin(const std::string& at) {
  at_ = at;
  if (since(begun_) > short_work) show();
}

void Stages::tick() {
  if (since(begun_) > short_work && since(last_) > (terminal_ ? terminal_interval : plain_interval)) show();
}

void Stages::show() {
  say("{}{} ({:.0f} s){}", terminal_ ? "\r\x1b[K" : "", at_, since(begun_), terminal_ ? "" : "\n");
  shown_ = true;
  last_ = std::chrono::steady_clock::now();
}

void Stages::finish() {
  if (terminal_ && shown_) say("\r\x1b[K");
  shown_ = false;
}

}  // namespace molten
