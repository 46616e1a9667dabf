// FNV-1a: the hash that names contents (files, starts of runs). Not for tables, and no seal against damage.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace molten {

class Hash {
 public:
  template <class T> void add(const T* data, std::size_t count) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(data);
    for (std::size_t k = 0; k < count * sizeof(T); ++k) value_ = (value_ ^ bytes[k]) * 1099511628211ull;
  }
  template <class T> void add(const T& number) { add(&number, 1); }
  std::string text() const { return fmt::format("{:016x}", value_); }

 private:
  std::uint64_t value_ = 14695981039346656037ull;
};

}  // namespace molten
