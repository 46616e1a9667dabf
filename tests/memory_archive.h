// A checkpoint in memory.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "core/state.h"

namespace molten {

/// Keeps what is archived in memory.
class MemoryArchive : public Archive {
 public:
  bool loading() const override { return loads; }
  void value(std::string_view name, double& v) override { array(name, NumberType::f64, &v, 1); }
  void value(std::string_view name, std::int64_t& v) override { array(name, NumberType::i64, &v, 1); }
  void array(std::string_view name, NumberType type, void* data, std::size_t count) override {
    static const std::map<NumberType, std::size_t> sizes{
        {NumberType::f32, 4}, {NumberType::i32, 4}, {NumberType::u32, 4}, {NumberType::i8, 1}, {NumberType::u8, 1}};
    const std::size_t bytes = count * (sizes.contains(type) ? sizes.at(type) : 8);
    auto& kept = arrays[std::string(name)];
    if (!loads) {
      kept.resize(bytes), counts[std::string(name)] = count;
      if (bytes > 0) std::memcpy(kept.data(), data, bytes);
    } else if (bytes > 0) {
      ASSERT_EQ(kept.size(), bytes) << name;
      std::memcpy(data, kept.data(), bytes);
    }
  }
  std::size_t stored_count(std::string_view name) const override { return counts.at(std::string(name)); }

  bool loads = false;
  std::map<std::string, std::vector<unsigned char>> arrays;
  std::map<std::string, std::size_t> counts;
};

template <int Dim, class Real> MemoryArchive archived(State<Dim, Real>& s) {
  MemoryArchive a;
  s.archive(a);
  return a;
}

/// The same for a state to take it up from.
template <int Dim, class Real> MemoryArchive saved(State<Dim, Real>& s) {
  MemoryArchive a = archived(s);
  a.loads = true;
  return a;
}

}  // namespace molten
