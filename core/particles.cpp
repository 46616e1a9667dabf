#include "core/particles.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "core/particle_pass.h"

namespace molten {

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
