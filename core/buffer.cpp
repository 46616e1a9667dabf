#include "core/buffer.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

#include "core/pieces.h"

namespace molten {
namespace {

constexpr std::size_t huge_page = std::size_t{1} << 21;
constexpr std::size_t slab = 8 * huge_page;  // bytes; of columns that are smaller than a page

constexpr std::size_t round_up(std::size_t bytes, std::size_t granule) {
  return (bytes + granule - 1) / granule * granule;
}

/// Huge pages fresh from the system: memory that the heap hands out again stays in small pages, whatever it is advised,
/// and passes over many columns then wait for the addresses of pages.
class Pages {
 public:
  explicit Pages(std::size_t bytes) : bytes_(bytes) {
    void* const all = mmap(nullptr, bytes + huge_page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (all == MAP_FAILED) throw std::bad_alloc();
    const std::size_t before = -reinterpret_cast<std::uintptr_t>(all) % huge_page;
    begin_ = static_cast<char*>(all) + before;
    if (before > 0) munmap(all, before);
    munmap(begin_ + bytes, huge_page - before);
    madvise(begin_, bytes, MADV_HUGEPAGE);
  }
  ~Pages() { munmap(begin_, bytes_); }
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;

  /// The next bytes that nobody has; null: there are no more so many.
  void* take(std::size_t bytes) {
    const std::size_t from = std::exchange(taken_, std::min(bytes_, taken_ + bytes));
    return from + bytes <= bytes_ ? begin_ + from : nullptr;
  }

 private:
  char* begin_ = nullptr;
  std::size_t bytes_, taken_ = 0;
};

std::shared_ptr<void> part_of(const std::shared_ptr<Pages>& pages, std::size_t bytes) {
  void* const begin = pages ? pages->take(bytes) : nullptr;
  return begin ? std::shared_ptr<void>(pages, begin) : nullptr;
}

/// The columns of one run come one after the other and go together, so a slab's parts are not used again.
std::shared_ptr<void> allocate(std::size_t bytes) {
  if (bytes >= huge_page) return part_of(std::make_shared<Pages>(bytes), bytes);
  if (bytes < huge_page / 32) {
    void* const begin = std::aligned_alloc(64, bytes);
    if (!begin) throw std::bad_alloc();
    return {begin, [](void* p) { std::free(p); }};
  }
  thread_local std::weak_ptr<Pages> current;
  if (std::shared_ptr<void> part = part_of(current.lock(), bytes)) return part;
  const auto next = std::make_shared<Pages>(slab);
  current = next;
  return part_of(next, bytes);
}

/// Whole huge pages, but where the last would be mostly empty.
std::size_t rounded_up(std::size_t bytes) {
  if (bytes < huge_page) return round_up(bytes, 64);
  const std::size_t whole = round_up(bytes, huge_page);
  return whole - bytes <= bytes / 8 ? whole : round_up(bytes, huge_page / 32);
}

}  // namespace

void Buffer::resize(std::size_t bytes, std::size_t kept) {
  if (bytes <= capacity_) return;
  const std::size_t rounded = rounded_up(bytes);
  std::shared_ptr<void> old = std::move(data_);
  const std::size_t of_old = std::min(kept, std::exchange(capacity_, 0));
  if (kept == 0) old.reset();
  data_ = allocate(rounded);
  for_each_piece((rounded + huge_page - 1) / huge_page, [&](std::size_t k) {
    std::memset(static_cast<char*>(data_.get()) + k * huge_page, 0, std::min(huge_page, rounded - k * huge_page));
  });
  if (of_old > 0) std::memcpy(data_.get(), old.get(), of_old);
  capacity_ = rounded;
}

void Buffer::extend(std::size_t from, std::size_t to) {
  if (to > capacity_) resize(std::max(to, capacity_ + capacity_ / 2), from);
  std::memset(static_cast<char*>(data()) + from, 0, to - from);
}

}  // namespace molten
