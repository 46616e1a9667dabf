#include "core/vents.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/particle_pass.h"
#include "core/step.h"

namespace molten {

namespace {

/// The table's value at a time: linear between entries, constant before and after.
template <class Value> double value_at(const std::vector<Vent::Entry>& table, double time, Value&& value) {
  const auto after =
      std::find_if(table.begin(), table.end(), [&](const Vent::Entry& entry) { return entry.time > time; });
  if (after == table.begin()) return value(table.front());
  if (after == table.end()) return value(table.back());
  const Vent::Entry &a = *(after - 1), &b = *after;
  const double u = (time - a.time) / (b.time - a.time);
  return (1 - u) * value(a) + u * value(b);
}

}  // namespace

template <int Dim> double VentPatch<Dim>::volume(double from, double to) const {
  const auto rate = [&](double time) { return value_at(table, time, [](const auto& e) { return e.rate; }); };
  double sum = 0, begin = from;
  for (const Vent::Entry& entry : table) {  // trapezia between the table's times are exact
    if (entry.time <= begin || entry.time >= to) continue;
    sum += (entry.time - begin) * (rate(begin) + rate(entry.time)) / 2;
    begin = entry.time;
  }
  return sum + (to - begin) * (rate(begin) + rate(to)) / 2;
}

template <int Dim> double VentPatch<Dim>::temperature(double time) const {
  return value_at(table, time, [](const auto& e) { return e.temperature; });
}

template <int Dim>
Vents<Dim>::Vents(std::vector<VentPatch<Dim>> patches, double spacing, double support)
    : patches_(std::move(patches)),
      spacing_(spacing),
      layers_(static_cast<int>(std::ceil(support / spacing)) + 1),
      room_(patches_.size(), 0.0) {}

/// A layer's particles fill their cells: what flows is the speed times as many cells.
template <int Dim> double Vents<Dim>::length(std::size_t k, double from, double to) const {
  const double area = static_cast<double>(patches_[k].offsets.size()) * std::pow(spacing_, Dim - 1);
  return patches_[k].volume(from, to) / area;
}

template <int Dim> void Vents<Dim>::advance(double time, double dt) {
  for (std::size_t k = 0; k < count(); ++k) room_[k] += length(k, time, time + dt);
}

template <int Dim> Point<Dim> Vents<Dim>::waiting(std::size_t k, int layer) const {
  return patches_[k].centre - (layer + 0.5) * spacing_ * patches_[k].normal;
}

template <int Dim> bool Vents<Dim>::next_layer(std::size_t k, Point<Dim>& from) {
  if (room_[k] < spacing_) return false;
  room_[k] -= spacing_;
  from = waiting(k, layers_ - 1) + room_[k] * patches_[k].normal;
  return true;
}

template <int Dim> double Vents<Dim>::fastest() const {
  double speed = 0;
  for (const VentPatch<Dim>& patch : patches_)
    for (const Vent::Entry& entry : patch.table)
      speed = std::max(speed, entry.rate / (static_cast<double>(patch.offsets.size()) * std::pow(spacing_, Dim - 1)));
  return speed;
}

template <int Dim> std::int64_t Vents<Dim>::take_ids(std::size_t count) {
  const std::int64_t first = next_id_;
  next_id_ += static_cast<std::int64_t>(count);
  return first;
}

template <int Dim> void Vents<Dim>::archive(Archive& a) {
  if (count() == 0) return;
  a.array("vents/room", NumberType::f64, room_.data(), room_.size());
  a.value("vents/next_id", next_id_);
}

std::array<Point<3>, 2> axes_across(const Point<3>& normal) {
  const Point<3> a = normal.cross(std::abs(normal.x()) < 0.9 ? Point<3>::UnitX() : Point<3>::UnitY()).normalized();
  return {a, normal.cross(a)};
}

template <> std::vector<Point<2>> disc_offsets(const Point<2>& normal, double radius, double spacing) {
  const Point<2> along(normal.y(), -normal.x());
  const int cells = std::max(1, static_cast<int>(std::lround(2 * radius / spacing)));
  std::vector<Point<2>> offsets;
  for (int i = 0; i < cells; ++i) offsets.push_back((i + 0.5 - 0.5 * cells) * spacing * along);
  return offsets;
}

template <> std::vector<Point<3>> disc_offsets(const Point<3>& normal, double radius, double spacing) {
  const auto [a, b] = axes_across(normal);
  const int reach = static_cast<int>(std::ceil(radius / spacing));
  std::vector<Point<3>> offsets;
  for (int j = -reach; j <= reach; ++j)
    for (int i = -reach; i <= reach; ++i)
      if (std::hypot(i, j) * spacing <= radius) offsets.push_back(i * spacing * a + j * spacing * b);
  return offsets;
}

// ---- the step's part ------------------------------------------------------------------------------------------------

namespace {

/// What waits in a vent takes the pressure of the fluid before it, as if that were at rest: δ = a + g·x/c² (the density
/// of open boundaries; Tafuni et al. 2018). Returns a; nothing as long as nothing
/// has come out.
template <int Dim, class Real> std::optional<double> pressure_before(const State<Dim, Real>& s, std::size_t vent) {
  struct Mean {
    double sum = 0, count = 0;
  };
  const VentPatch<Dim>& patch = s.vents.patch(vent);
  double wide = 0;
  for (const Point<Dim>& offset : patch.offsets) wide = std::max(wide, offset.norm() + s.parameters.spacing / 2);
  const double c2 = s.parameters.eos.sound_speed * s.parameters.eos.sound_speed;
  const auto x = s.particles[position];
  const auto inlets = s.particles[inlet][0];
  const auto delta = s.particles[compression][0];
  const Mean mean = reduce_slots(
      s.particles.slots(), Mean{},
      [&](std::size_t slot, Mean& m) {
        if (inlets[slot] >= 0 || s.particles.is_padding(slot)) return;
        Point<Dim> at;
        double head = 0;  // m²/s²
        for (int d = 0; d < Dim; ++d)
          at[d] = x[d][slot] - patch.centre[d], head += s.parameters.gravity[d] * x[d][slot];
        const double height = at.dot(patch.normal);
        if (height < 0 || height > s.parameters.support_radius || (at - height * patch.normal).norm() > wide) return;
        m.sum += delta[slot] - head / c2;
        ++m.count;
      },
      [](Mean& a, const Mean& b) { a.sum += b.sum, a.count += b.count; });
  if (mean.count == 0) return std::nullopt;
  return mean.sum / mean.count;
}

template <int Dim, class Real> void set_pressure(State<Dim, Real>& s, std::size_t vent) {
  Particles<Dim, Real>& p = s.particles;
  const std::optional<double> a = pressure_before(s, vent);
  if (!a) return;
  const double c2 = s.parameters.eos.sound_speed * s.parameters.eos.sound_speed;
  for_each_slot(p.slots(), [&](std::size_t slot) {
    if (p[inlet][0][slot] != static_cast<std::int64_t>(vent)) return;
    double delta = *a;
    for (int d = 0; d < Dim; ++d) delta += s.parameters.gravity[d] * p[position][d][slot] / c2;
    p[compression][0][slot] = static_cast<Real>(delta);
    if (p.has(half_compression)) p[half_compression][0][slot] = static_cast<Real>(delta);
  });
}

template <int Dim, class Real> void insert_layer(State<Dim, Real>& s, std::size_t vent, const Point<Dim>& middle) {
  const VentPatch<Dim>& patch = s.vents.patch(vent);
  Particles<Dim, Real>& p = s.particles;
  const std::size_t count = patch.offsets.size(), first = p.append(count);
  const std::int64_t first_id = s.vents.take_ids(count);
  const double time = s.clock.time;
  constexpr double instant = 1e-9;  // s; short enough for the speed at `time`
  const Point<Dim> v = s.vents.way(vent, time, instant) / instant;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t slot = first + k;
    p[id][0][slot] = first_id + static_cast<std::int64_t>(k);
    p[inlet][0][slot] = static_cast<std::int64_t>(vent);
    for (int d = 0; d < Dim; ++d) {
      p[position][d][slot] = middle[d] + patch.offsets[k][d];
      p[velocity][d][slot] = static_cast<Real>(v[d]);
      if (p.has(half_velocity)) p[half_velocity][d][slot] = static_cast<Real>(v[d]);
    }
    if (p.has(temperature)) p[temperature][0][slot] = patch.temperature(time);
    if (p.has(conductivity)) p[conductivity][0][slot] = 1;
  }
}

}  // namespace

template <int Dim, class Real> void open_vents(State<Dim, Real>& s) {
  std::fill_n(s.particles[inlet][0], s.particles.slots(), std::int64_t{-1});
  s.vents.start_ids(static_cast<std::int64_t>(s.particles.count()));
  for (std::size_t k = 0; k < s.vents.count(); ++k)
    for (int layer = 0; layer < s.vents.layers(); ++layer) insert_layer(s, k, s.vents.waiting(k, layer));
}

template <int Dim, class Real> void emit(State<Dim, Real>& s) {
  Point<Dim> middle;
  for (std::size_t k = 0; k < s.vents.count(); ++k)
    while (s.vents.next_layer(k, middle)) {
      insert_layer(s, k, middle);
      set_pressure(s, k);
      s.neighbours.expire();
    }
}

template struct VentPatch<2>;
template struct VentPatch<3>;
template class Vents<2>;
template class Vents<3>;

#define MOLTEN_INSTANTIATE(Dim, Real)          \
  template void open_vents(State<Dim, Real>&); \
  template void emit(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
