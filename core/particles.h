// The particles: a structure of arrays with only the columns that the run's features name. Slots come in clusters of
// `cluster_size`; a slot whose id is -1 is padding.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <span>
#include <utility>

#include "core/archive.h"
#include "core/buffer.h"
#include "core/fields.h"

namespace molten {

inline constexpr int cluster_size = 4;
inline constexpr std::int64_t padding_id = -1;

using FieldSet = std::bitset<AllFields::size>;

template <class... F> FieldSet field_set(FieldList<F...>) {
  FieldSet s;
  (s.set(field_index<F>), ...);
  return s;
}

/// One array a component. column[k][slot] is component k; column.of(slot) the whole value.
template <class F, int Dim, class T> struct Column {
  static constexpr int size = components<F, Dim>;
  std::array<T*, size> c;

  T* operator[](int k) const { return c[k]; }
  value_t<F, Dim, T> of(std::size_t slot) const {
    value_t<F, Dim, T> v;
    for (int k = 0; k < size; ++k) component(v, k) = c[k][slot];
    return v;
  }
  void set(std::size_t slot, value_t<F, Dim, T> v) const {
    for (int k = 0; k < size; ++k) c[k][slot] = component(v, k);
  }
};

template <int Dim, class Real> class Particles {
 public:
  explicit Particles(FieldSet active);

  /// Room for `slots` slots (a multiple of cluster_size); contents are lost but for the first `kept` slots. `count` of
  /// them are particles.
  void resize(std::size_t slots, std::size_t count, std::size_t kept = 0);

  /// Adds so many particles at the end, all their fields zero, and padding up to a whole cluster; returns the slot of
  /// the first. Columns grow by half, so that few calls allocate. The neighbours must be listed anew.
  std::size_t append(std::size_t count);

  /// So many particles have become padding.
  void forget(std::size_t count) { count_ -= count; }

  std::size_t slots() const { return slots_; }
  std::size_t count() const { return count_; }
  std::size_t bytes() const;  // allocated, scratch included
  bool has(FieldSet f) const { return (active_ & f) == f; }
  FieldSet active() const { return active_; }

  template <class F> bool has(F) const { return active_.test(field_index<F>); }

  /// The column of a field; its pointers are null if the run does not have it.
  template <class F> Column<F, Dim, stored_t<F, Real>> operator[](F) const {
    Column<F, Dim, stored_t<F, Real>> column;
    for (int k = 0; k < column.size; ++k)
      column.c[k] = static_cast<stored_t<F, Real>*>(columns_[first_component<F>() + k].data());
    return column;
  }

  bool is_padding(std::size_t slot) const { return (*this)[id][0][slot] == padding_id; }

  /// New slot first + s takes old slot order[s]; -1 makes it padding (id -1, all else zero). There, fields that live
  /// for a step are lost. Slots before `first` stay as they are.
  void permute(std::span<const std::int32_t> order, std::size_t count, std::size_t first = 0);

  /// Memory that lasts until the next permute, for whoever sorts: `bytes` of it, at best no more than 8 a slot.
  void* scratch(std::size_t bytes) {
    scratch_.resize(bytes);
    return scratch_.data();
  }

  void archive(Archive& a);

 private:
  template <class F> static constexpr int first_component() { return first_component_at(field_index<F>); }
  static constexpr int max_components = Dim * (Dim + 1) / 2;
  static constexpr int first_component_at(int field) { return field * max_components; }

  FieldSet active_;
  std::size_t slots_ = 0, count_ = 0;
  std::array<Buffer, AllFields::size * max_components> columns_;
  Buffer scratch_;
};

/// Calls f(Field{}) for every field.
template <class F> void for_each_field(F&& f) {
  [&]<class... Fs>(FieldList<Fs...>) { (f(Fs{}), ...); }(AllFields{});
}

}  // namespace molten
