#include "core/diagnostics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <span>

#include "core/error.h"
#include "core/particle_pass.h"

namespace molten {

template <int Dim> std::vector<SnapshotBody> snapshots_of(const Bodies<Dim>& bodies) {
  std::vector<SnapshotBody> shots(bodies.count());
  for (std::size_t k = 0; k < shots.size(); ++k) {
    const Pose<Dim>& pose = bodies.motion(k).start;
    for (int a = 0; a < Dim; ++a) {
      shots[k].centre[a] = pose.centre[a];
      for (int b = 0; b < Dim; ++b) shots[k].turn[3 * a + b] = pose.turn(a, b);
    }
  }
  return shots;
}

template std::vector<SnapshotBody> snapshots_of(const Bodies<2>&);
template std::vector<SnapshotBody> snapshots_of(const Bodies<3>&);

template <int Dim, class Real> Diagnostics diagnose(const State<Dim, Real>& s) {
  const Particles<Dim, Real>& p = s.particles;
  const auto x = p[position];
  const auto v = p[velocity];
  const double m = s.parameters.particle_mass;
  const Real* share = s.clock.step > 0 ? p[energy_share][0] : nullptr;  // of the last step
  const Real* held_by = p[held][0];                                     // null without boundary particles
  Diagnostics zero;
  if (share) zero.mean_energy_share = zero.largest_energy_share = 0;
  zero.lower.fill(std::numeric_limits<double>::max());
  zero.upper.fill(std::numeric_limits<double>::lowest());
  Diagnostics total = reduce_slots(
      p.slots(), zero,
      [&](std::size_t slot, Diagnostics& d) {
        if (p.is_padding(slot) || (held_by && held_by[slot] > 0)) return;
        double v2 = 0;
        for (int k = 0; k < Dim; ++k) {
          v2 += double(v[k][slot]) * v[k][slot];
          d.potential_energy -= m * s.parameters.gravity[k] * x[k][slot];
          d.momentum[k] += m * v[k][slot];
          d.lower[k] = std::min(d.lower[k], x[k][slot]);
          d.upper[k] = std::max(d.upper[k], x[k][slot]);
        }
        ++d.particles;
        d.kinetic_energy += m * v2 / 2;
        d.max_speed = std::max(d.max_speed, std::sqrt(v2));
        d.max_compression = std::max(d.max_compression, std::abs(double(p[compression][0][slot])));
        if (share) {
          d.least_energy_share = std::min(d.least_energy_share, double(share[slot]));
          d.mean_energy_share += share[slot];
          d.largest_energy_share = std::max(d.largest_energy_share, double(share[slot]));
        }
        if (s.features.internal_energy) d.internal_energy += m * p[internal_energy][0][slot];
        if (s.features.heat) d.heat += m * p[temperature][0][slot];
      },
      [&](Diagnostics& a, const Diagnostics& b) {
        a.particles += b.particles;
        a.kinetic_energy += b.kinetic_energy;
        a.potential_energy += b.potential_energy;
        a.internal_energy += b.internal_energy;
        a.least_energy_share = std::min(a.least_energy_share, b.least_energy_share);
        if (share) a.mean_energy_share += b.mean_energy_share;
        a.largest_energy_share = std::max(a.largest_energy_share, b.largest_energy_share);
        a.heat += b.heat;
        for (int k = 0; k < Dim; ++k) {
          a.momentum[k] += b.momentum[k];
          a.lower[k] = std::min(a.lower[k], b.lower[k]);
          a.upper[k] = std::max(a.upper[k], b.upper[k]);
        }
        a.max_speed = std::max(a.max_speed, b.max_speed);
        a.max_compression = std::max(a.max_compression, b.max_compression);
      });
  if (share) total.mean_energy_share /= static_cast<double>(std::max<std::int64_t>(total.particles, 1));
  total.asleep = s.sleep.asleep;
  total.energy_taken_by_sleep = s.sleep.taken_energy;
  for (int k = 0; k < 3; ++k)
    if (k >= Dim || total.particles == 0) total.lower[k] = total.upper[k] = 0;
  for (const SnapshotBody& body : snapshots_of(s.bodies)) total.bodies.push_back(body.centre);
  return total;
}

std::vector<std::string> available_fields(const Features& f) {
  std::vector<std::string> names{"velocity", "density", "pressure"};
  if (f.heat) names.push_back("temperature");
  if (f.stress) names.push_back("viscosity");
  if (f.internal_energy) names.push_back("internal_energy");
  return names;
}

void require_fields(const Scene& scene, const Features& features) {
  const std::vector<std::string> available = available_fields(features);
  for (const std::string& name : scene.output.fields)
    if (std::find(available.begin(), available.end(), name) == available.end())
      refuse(scene, "output.fields",
             "this scene has no field '" + name + "'; it has " +
                 std::accumulate(available.begin() + 1, available.end(), available[0],
                                 [](auto a, auto& b) { return a + ", " + b; }));
}

namespace {

/// The slots of the particles in id order.
template <int Dim, class Real> std::vector<std::uint32_t> slots_by_id(const Particles<Dim, Real>& p) {
  std::vector<std::uint32_t> slots;
  for (std::size_t s = 0; s < p.slots(); ++s)
    if (!p.is_padding(s)) slots.push_back(static_cast<std::uint32_t>(s));
  const auto ids = p[id][0];
  std::sort(slots.begin(), slots.end(), [ids](auto a, auto b) { return ids[a] < ids[b]; });
  return slots;
}

template <int Dim, class Real>
SnapshotField read_field(const State<Dim, Real>& s, const std::string& name, std::span<const std::uint32_t> slots) {
  const Particles<Dim, Real>& p = s.particles;
  SnapshotField field;
  const auto scalar = [&](std::string unit, std::string meaning, auto&& of) {
    field = {name, std::move(unit), std::move(meaning), 1, std::vector<double>(slots.size())};
    for (std::size_t k = 0; k < slots.size(); ++k) field.values[k] = of(slots[k]);
  };
  const double rho0 = s.parameters.eos.rest_density;
  const auto delta = p[compression][0];
  if (name == "density") scalar("kg/m3", "density", [&](auto k) { return rho0 * (1 + delta[k]); });
  if (name == "pressure") scalar("Pa", "pressure", [&](auto k) { return s.parameters.eos.pressure(delta[k]); });
  if (name == "temperature")
    scalar(std::string(temperature.unit), "temperature", [&](auto k) { return p[temperature][0][k]; });
  if (name == "internal_energy")
    scalar(std::string(internal_energy.unit), "internal energy", [&](auto k) { return p[internal_energy][0][k]; });
  if (name == "viscosity") scalar("Pa s", "dynamic viscosity", [&](auto k) { return p[viscosity][0][k]; });
  if (name == "velocity") {
    field = {name, "m/s", "velocity", 3, std::vector<double>(3 * slots.size(), 0.0)};
    for (std::size_t k = 0; k < slots.size(); ++k)
      for (int d = 0; d < Dim; ++d) field.values[3 * k + d] = p[velocity][d][slots[k]];
  }
  return field;
}

}  // namespace

template <int Dim, class Real>
Snapshot take_snapshot(const State<Dim, Real>& s, const std::vector<std::string>& fields) {
  Snapshot shot;
  shot.time = s.clock.time;
  shot.step = s.clock.step;
  shot.dimensions = Dim;
  shot.spacing = s.parameters.spacing;
  std::vector<std::uint32_t> slots = slots_by_id(s.particles);
  if (const Real* held_by = s.particles[held][0])
    std::erase_if(slots, [held_by](std::uint32_t slot) { return held_by[slot] > 0; });
  for (const std::uint32_t slot : slots) {
    shot.id.push_back(s.particles[id][0][slot]);
    for (int d = 0; d < 3; ++d) shot.position.push_back(d < Dim ? s.particles[position][d][slot] : 0.0);
  }
  for (const std::string& name : fields.empty() ? available_fields(s.features) : fields)
    shot.fields.push_back(read_field(s, name, std::span<const std::uint32_t>(slots)));
  shot.bodies = snapshots_of(s.bodies);
  return shot;
}

namespace {

template <int Dim, class Real>
std::int64_t count_between(const State<Dim, Real>& s, std::size_t cluster, ListEntry entry, double support2) {
  const auto local = s.particles[local_position];
  const auto& shift = s.neighbours.shifts().of(entry);
  const std::size_t first = s.neighbours.shifts().first_slot(entry);
  std::int64_t count = 0;
  for (std::size_t i = cluster * cluster_size; i < (cluster + 1) * cluster_size; ++i)
    for (std::size_t j = first; j < first + group_size<Real>; ++j) {
      double r2 = 0;
      for (int d = 0; d < Dim; ++d) r2 += std::pow(local[d][i] - shift[d] - local[d][j], 2);
      const bool itself = i == j && std::all_of(shift.begin(), shift.end(), [](double x) { return x == 0; });
      count += r2 < support2 && !itself && !s.particles.is_padding(i) && !s.particles.is_padding(j);
    }
  return count;
}

}  // namespace

template <int Dim, class Real> std::int64_t count_pairs(const State<Dim, Real>& s) {
  const auto chunks = s.neighbours.chunks();
  const double support2 = s.parameters.support_radius * s.parameters.support_radius;
  std::vector<std::int64_t> counts(chunks.size(), 0);
  for_each_piece(chunks.size(), [&](std::size_t k) {
    s.neighbours.for_each_list(chunks[k], [&](std::uint32_t c, std::span<const ListEntry> list) {
      for (const ListEntry e : list) counts[k] += count_between(s, c, e, support2);
    });
  });
  return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
}

template <int Dim, class Real> std::int64_t fastest_particle(const State<Dim, Real>& s) {
  std::int64_t fastest = -1;
  double most = -1;
  for (const std::uint32_t slot : slots_by_id(s.particles)) {
    double v2 = 0;
    for (int d = 0; d < Dim; ++d) v2 += std::pow(double(s.particles[velocity][d][slot]), 2);
    if (v2 > most) most = v2, fastest = s.particles[id][0][slot];
  }
  return fastest;
}

template <int Dim, class Real> std::string find_non_finite(const State<Dim, Real>& s) {
  const Particles<Dim, Real>& p = s.particles;
  const auto likely_cause = [&](std::string_view field) -> std::string {
    if (field == viscosity.name || field == stress.name)
      return "the rheology gave no finite viscosity; check fluid.rheology";
    if (field == temperature.name || field == temperature_rate.name)
      return "heat conduction ran away; lower numerics.courant.conduction or numerics.fixed_dt";
    return std::string("the time step was too large for the ") + name_of(s.clock.limit) +
           " limit or particles met at high speed; lower numerics." + (s.parameters.fixed_dt ? "fixed_dt" : "courant") +
           ", raise numerics.sound_speed or add numerics.xsph";
  };
  std::string line;
  for (const std::uint32_t slot : slots_by_id(p)) {
    for_each_field([&]<class F>(F) {
      if (!line.empty() || !p.has(F{}) || F::storage == Storage::id) return;
      constexpr double largest = F::shape == FieldShape::vector ? 1e18 : 1e30;  // whose square single precision holds
      for (const auto* column : p[F{}].c)
        if (!(std::abs(static_cast<double>(column[slot])) <= largest))
          line = "particle " + std::to_string(p[id][0][slot]) + ": " + std::string(F::name) +
                 " is not finite: " + likely_cause(F::name);
    });
    if (!line.empty()) break;
  }
  return line;
}

#define MOLTEN_INSTANTIATE(Dim, Real)                                                        \
  template Diagnostics diagnose(const State<Dim, Real>&);                                    \
  template Snapshot take_snapshot(const State<Dim, Real>&, const std::vector<std::string>&); \
  template std::int64_t count_pairs(const State<Dim, Real>&);                                \
  template std::int64_t fastest_particle(const State<Dim, Real>&);                           \
  template std::string find_non_finite(const State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
