#include "core/timer.h"

#include <gtest/gtest.h>

#include <thread>

namespace molten::timer_test {
namespace {

using namespace std::chrono;

void pause() { std::this_thread::sleep_for(milliseconds(20)); }

TEST(Timer, AScopeWithinAnotherCountsOnce) {
  Timer timer;
  const auto start = steady_clock::now();
  {
    const auto outer = timer.scope("outer");
    pause();
    for (int k = 0; k < 3; ++k) {
      const auto inner = timer.scope("inner");
      const auto innermost = timer.scope("innermost");
      pause();
    }
    pause();
  }
  const double all = duration<double>(steady_clock::now() - start).count();
  const auto& seconds = timer.seconds();
  EXPECT_GE(seconds.at("outer"), 0.04);
  EXPECT_GE(seconds.at("innermost"), 0.06);
  EXPECT_LT(seconds.at("inner"), seconds.at("innermost")) << "it does nothing of its own";
  EXPECT_LE(seconds.at("outer") + seconds.at("inner") + seconds.at("innermost"), all);
}

TEST(Timer, ScopesAfterOneAnotherAddUp) {
  Timer timer;
  for (int k = 0; k < 2; ++k) {
    const auto scope = timer.scope("pass");
    pause();
  }
  EXPECT_GE(timer.seconds().at("pass"), 0.04);
}

}  // namespace
}  // namespace molten::timer_test
