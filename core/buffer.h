// Memory for the columns of particles.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

namespace molten {

/// Memory on cache-line boundaries, zero at first; in huge pages unless it is small.
class Buffer {
 public:
  Buffer() = default;
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }

  /// When it has to grow, all but the first `kept` bytes are lost.
  void resize(std::size_t bytes, std::size_t kept = 0);
  void extend(std::size_t from, std::size_t to);  // bytes; keeps the first `from`, the rest becomes zero
  void* data() const { return data_.get(); }
  std::size_t capacity() const { return capacity_; }
  void swap(Buffer& other) noexcept { std::swap(data_, other.data_), std::swap(capacity_, other.capacity_); }

 private:
  std::shared_ptr<void> data_;
  std::size_t capacity_ = 0;
};

}  // namespace molten
