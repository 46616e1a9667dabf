// An archive that keeps what it is given in memory.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "core/state.h"

namespace molten {

/// An archive in memory: saves first, then loads what it has.
class MemoryArchive : public Archive {
 public:
  bool loading() const override { return loading_; }
  void rewind() { loading_ = true; }

  void value(std::string_view name, double& v) override { exchange(name, NumberType::f64, &v, 1, sizeof v); }
  void value(std::string_view name, std::int64_t& v) override { exchange(name, NumberType::i64, &v, 1, sizeof v); }
  void array(std::string_view name, NumberType type, void* data, std::size_t count) override {
    exchange(name, type, data, count, size_of(type));
  }
  std::size_t stored_count(std::string_view name) const override { return entries_.at(std::string(name)).count; }

  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& [name, entry] : entries_) all.push_back(name);
    return all;
  }

  /// Holds the same bits under the same names.
  bool operator==(const MemoryArchive& other) const { return entries_ == other.entries_; }

 private:
  struct Entry {
    NumberType type;
    std::size_t count;
    std::vector<unsigned char> bytes;
    bool operator==(const Entry&) const = default;
  };

  static std::size_t size_of(NumberType type) {
    switch (type) {
      case NumberType::i8:
      case NumberType::u8:
        return 1;
      case NumberType::f32:
      case NumberType::i32:
      case NumberType::u32:
        return 4;
      default:
        return 8;
    }
  }

  void exchange(std::string_view name, NumberType type, void* data, std::size_t count, std::size_t size) {
    if (!loading_) {
      const auto* bytes = static_cast<const unsigned char*>(data);
      const bool is_new = entries_.emplace(name, Entry{type, count, {bytes, bytes + count * size}}).second;
      EXPECT_TRUE(is_new) << name << " is stored twice";
      return;
    }
    const Entry& entry = entries_.at(std::string(name));
    ASSERT_EQ(entry.type, type) << name;
    ASSERT_EQ(entry.count, count) << name;
    if (count > 0) std::memcpy(data, entry.bytes.data(), entry.bytes.size());
  }

  bool loading_ = false;
  std::map<std::string, Entry> entries_;
};

template <int Dim, class Real> MemoryArchive archived(State<Dim, Real>& s) {
  MemoryArchive a;
  s.archive(a);
  return a;
}

/// The same for a state to take it up from.
template <int Dim, class Real> MemoryArchive saved(State<Dim, Real>& s) {
  MemoryArchive a = archived(s);
  a.rewind();
  return a;
}

}  // namespace molten
