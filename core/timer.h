// Wall time by name: one scope a pass.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>

namespace molten {

class Timer {
 public:
  class Scope {
   public:
    Scope(double& total) : total_(total), start_(std::chrono::steady_clock::now()) {}
    ~Scope() { total_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    double& total_;
    std::chrono::steady_clock::time_point start_;
  };

  [[nodiscard]] Scope scope(std::string_view name) {
    auto it = seconds_.find(name);
    if (it == seconds_.end()) it = seconds_.emplace(name, 0.0).first;
    return Scope(it->second);
  }
  const std::map<std::string, double, std::less<>>& seconds() const { return seconds_; }

 private:
  std::map<std::string, double, std::less<>> seconds_;
};

}  // namespace molten
