// How state goes to and from a checkpoint: every part of the state has one `archive(Archive&)` member that names its
// numbers; the same code saves and restores. The file format lives behind this interface (io/checkpoint).
#pragma once

#include <cstdint>
#include <string_view>
#include <type_traits>
#include <vector>

namespace molten {

enum class NumberType { f32, f64, i8, u8, i32, u32, i64, u64 };

template <class T> constexpr NumberType number_type() {
  if constexpr (std::is_same_v<T, float>)
    return NumberType::f32;
  else if constexpr (std::is_same_v<T, double>)
    return NumberType::f64;
  else if constexpr (std::is_same_v<T, std::int8_t>)
    return NumberType::i8;
  else if constexpr (std::is_same_v<T, std::uint8_t>)
    return NumberType::u8;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return NumberType::i32;
  else if constexpr (std::is_same_v<T, std::uint32_t>)
    return NumberType::u32;
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return NumberType::i64;
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    return NumberType::u64;
}

class Archive {
 public:
  virtual ~Archive() = default;
  virtual bool loading() const = 0;

  /// One number. `name` is a path such as "clock/time".
  virtual void value(std::string_view name, double& v) = 0;
  virtual void value(std::string_view name, std::int64_t& v) = 0;

  /// `count` numbers at `data`; when loading, the file must hold exactly `count` of them and of this type.
  virtual void array(std::string_view name, NumberType type, void* data, std::size_t count) = 0;

  /// How many numbers the array of this name has in the file (loading only).
  virtual std::size_t stored_count(std::string_view name) const = 0;

  template <class T> void vector(std::string_view name, std::vector<T>& v) {
    if (loading()) v.resize(stored_count(name));
    array(name, number_type<T>(), v.data(), v.size());
  }
};

}  // namespace molten
