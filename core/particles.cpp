#include "core/particles.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <string>

#include "core/particle_pass.h"

namespace molten {

void Buffer::resize(std::size_t bytes, std::size_t kept) {
  if (bytes <= capacity_) return;
  constexpr std::size_t page = std::size_t{1} << 21;
  const std::size_t alignment = bytes >= page ? page : 64, granule = bytes >= page ? page / 32 : 64;
  const std::size_t rounded = (bytes + granule - 1) / granule * granule;
  std::unique_ptr<void, Free> old = std::move(data_);
  const std::size_t of_old = std::min(kept, std::exchange(capacity_, 0));
  if (kept == 0) old.reset();
  void* memory = nullptr;
  if (posix_memalign(&memory, alignment, rounded) != 0) throw std::bad_alloc();
  data_.reset(memory);
  if (alignment == page) madvise(data_.get(), rounded, MADV_HUGEPAGE);
  for_each_piece((rounded + page - 1) / page, [&](std::size_t k) {
    std::memset(static_cast<char*>(data_.get()) + k * page, 0, std::min(page, rounded - k * page));
  });
  if (of_old > 0) std::memcpy(data_.get(), old.get(), of_old);
  capacity_ = rounded;
}

void Buffer::extend(std::size_t from, std::size_t to) {
  if (to > capacity_) resize(std::max(to, capacity_ + capacity_ / 2), from);
  std::memset(static_cast<char*>(data()) + from, 0, to - from);
}

template <int Dim, class Real> Particles<Dim, Real>::Particles(FieldSet active) : active_(active) {
  active_ |= field_set(FieldList<Id, LocalPosition>{});
}

template <int Dim, class Real>
void Particles<Dim, Real>::resize(std::size_t slots, std::size_t count, std::size_t kept) {
  slots_ = slots;
  count_ = count;
  for_each_field([&]<class F>(F) {
    if (!active_.test(field_index<F>)) return;
    for (int k = 0; k < components<F, Dim>; ++k)
      columns_[first_component<F>() + k].resize(slots * sizeof(stored_t<F, Real>), kept * sizeof(stored_t<F, Real>));
  });
}

template <int Dim, class Real> std::size_t Particles<Dim, Real>::append(std::size_t count) {
  const std::size_t first = slots_, slots = first + (count + cluster_size - 1) / cluster_size * cluster_size;
  for_each_field([&]<class F>(F) {
    if (!active_.test(field_index<F>)) return;
    using T = stored_t<F, Real>;
    for (int k = 0; k < components<F, Dim>; ++k)
      columns_[first_component<F>() + k].extend(first * sizeof(T), slots * sizeof(T));
  });
  slots_ = slots;
  count_ += count;
  for (std::size_t s = first + count; s < slots; ++s) (*this)[id][0][s] = padding_id;
  return first;
}

template <int Dim, class Real> std::size_t Particles<Dim, Real>::bytes() const {
  std::size_t sum = scratch_.capacity();
  for (const Buffer& b : columns_) sum += b.capacity();
  return sum;
}

template <int Dim, class Real>
void Particles<Dim, Real>::permute(std::span<const std::int32_t> order, std::size_t count, std::size_t first) {
  const std::size_t slots = first + order.size();
  for_each_field([&]<class F>(F) {
    if (!active_.test(field_index<F>) || F::lifetime == Lifetime::step) return;
    using T = stored_t<F, Real>;
    constexpr T filling = F::storage == Storage::id ? T(padding_id) : T(0);
    // A column changes places with one of its size whose contents are not needed; or, where slots stay, the rest goes
    // there and back.
    Buffer& spare = F::storage == Storage::real ? columns_[first_component<LocalPosition>()] : scratch_;
    spare.resize(slots * sizeof(T), first * sizeof(T));
    for (int k = 0; k < components<F, Dim>; ++k) {
      Buffer& column = columns_[first_component<F>() + k];
      const T* from = static_cast<const T*>(column.data());
      T* to = static_cast<T*>(spare.data()) + first;
      for_each_slot(order.size(), [&](std::size_t s) { to[s] = order[s] < 0 ? filling : from[order[s]]; });
      if (first == 0) {
        column.swap(spare);
        spare.resize(slots * sizeof(T));
      } else {
        column.resize(slots * sizeof(T), first * sizeof(T));
        T* back = static_cast<T*>(column.data()) + first;
        for_each_slot(order.size(), [&](std::size_t s) { back[s] = to[s]; });
      }
    }
  });
  resize(slots, count, first);
}

template <int Dim, class Real> void Particles<Dim, Real>::archive(Archive& a) {
  auto slots = static_cast<std::int64_t>(slots_), count = static_cast<std::int64_t>(count_);
  a.value("particles/slots", slots);
  a.value("particles/count", count);
  if (a.loading()) resize(static_cast<std::size_t>(slots), static_cast<std::size_t>(count));
  for_each_field([&]<class F>(F) {
    if (!active_.test(field_index<F>)) return;
    for (int k = 0; k < components<F, Dim>; ++k) {
      const std::string name = "particles/" + std::string(F::name) + (components<F, Dim> > 1 ? std::to_string(k) : "");
      a.array(name, number_type<stored_t<F, Real>>(), columns_[first_component<F>() + k].data(), slots_);
    }
  });
}

template class Particles<2, float>;
template class Particles<2, double>;
template class Particles<3, float>;
template class Particles<3, double>;

}  // namespace molten
