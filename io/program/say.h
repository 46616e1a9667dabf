// Words for the user. What cannot be told on standard error is no reason to stop a run; what standard output does not
// take is an error.
#pragma once

#include <fmt/format.h>

#include <string>

namespace molten {

/// Standard streams that are closed lead nowhere from now on: else the next file to be opened would take their place.
void open_standard_streams();

/// On standard error, if it takes it.
void put_on_error(const std::string& text);
template <class... T> void say(fmt::format_string<T...> format, T&&... values) {
  put_on_error(fmt::format(format, std::forward<T>(values)...));
}

/// Throws Error(files) if standard output has not taken all.
void finish_output();

}  // namespace molten
