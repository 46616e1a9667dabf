// Wall time by name: one scope a pass. What a scope holds within it counts for the inner one alone.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace molten {

class Timer {
 public:
  class Scope {
   public:
    Scope(Timer& timer, double& total) : timer_(timer), total_(total), outer_(std::exchange(timer.running_, this)) {
      if (outer_) outer_->stop(start_);
    }
    ~Scope() {
      const auto now = std::chrono::steady_clock::now();
      stop(now);
      timer_.running_ = outer_;
      if (outer_) outer_->start_ = now;
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    void stop(std::chrono::steady_clock::time_point now) {
      total_ += std::chrono::duration<double>(now - start_).count();
    }

    Timer& timer_;
    double& total_;
    Scope* outer_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  };

  [[nodiscard]] Scope scope(std::string_view name) {
    auto it = seconds_.find(name);
    if (it == seconds_.end()) it = seconds_.emplace(name, 0.0).first;
    return Scope(*this, it->second);
  }
  const std::map<std::string, double, std::less<>>& seconds() const { return seconds_; }

 private:
  std::map<std::string, double, std::less<>> seconds_;
  Scope* running_ = nullptr;
};

}  // namespace molten
