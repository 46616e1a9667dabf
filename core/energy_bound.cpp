#include "core/energy_bound.h"

#include "core/mover.h"
#include "core/particle_pass.h"
#include "core/step.h"

namespace molten {

namespace {

/// The bound's coefficients without the surplus.
struct Bound {
  double A = 0, B = 0, C = 0;
  double excess() const { return A + B + C; }  // J/kg beyond the bound if all of the acceleration acts
};

template <int Dim, class Real> class EnergyBoundedEuler {
 public:
  explicit EnergyBoundedEuler(State<Dim, Real>& s) : s_(s), p_(s.particles), drift_(s), mover_(s) {}

  /// J/kg that a particle needs of the surplus, or below 0 leaves to it; 0 for padding.
  double excess(std::size_t slot) const { return p_.is_padding(slot) ? 0 : bound(slot).excess(); }

  /// Moves one particle with this surplus (J/kg) at hand; returns the square of its way.
  double advance(std::size_t slot, double surplus) const {
    if (p_.is_padding(slot)) return 0;
    const Bound b = bound(slot);
    const double share = largest_share(b.A, b.B, b.C - surplus), dt = s_.clock.dt;
    share_[slot] = static_cast<Real>(share);
    Motion<Dim> m;
    for (int d = 0; d < Dim; ++d) {
      const double g = s_.parameters.gravity[d];
      m.position[d] = position_[d][slot];
      m.velocity[d] = velocity_[d][slot] + dt * (g + share * (acceleration_[d][slot] - g));
      m.rate[d] = drift_.rate(m.velocity[d], d, slot);
      m.velocity[d] = drift_.overwritten(m.velocity[d], d, slot);
    }
    const Point<Dim> before = m.position;
    mover_.move(slot, m);
    for (int d = 0; d < Dim; ++d) {
      position_[d][slot] = m.position[d];
      velocity_[d][slot] = static_cast<Real>(m.velocity[d]);
    }
    compression_[slot] += static_cast<Real>(dt * compression_rate_[slot]);
    if (s_.features.heat) temperature_[slot] += dt * temperature_rate_[slot];
    return (m.position - before).squaredNorm();
  }

 private:
  Bound bound(std::size_t slot) const {
    const double dt = s_.clock.dt;
    Bound b;
    for (int d = 0; d < Dim; ++d) {
      const double g = s_.parameters.gravity[d], a = acceleration_[d][slot] - g;
      b.A += dt * dt / 2 * a * a;
      b.B += dt * a * velocity_[d][slot];
      b.C -= dt * dt / 2 * g * g;
    }
    return b;
  }

  State<Dim, Real>& s_;
  Particles<Dim, Real>& p_;
  Drift<Dim, Real> drift_;
  Mover<Dim, Real> mover_;
  Column<Position, Dim, double> position_ = p_[position];
  Column<Velocity, Dim, Real> velocity_ = p_[velocity];
  Column<Acceleration, Dim, Real> acceleration_ = p_[acceleration];
  Real* compression_ = p_[compression][0];
  Real* share_ = p_[energy_share][0];
  double* temperature_ = p_[temperature][0];
  const Real* compression_rate_ = p_[compression_rate][0];
  const Real* temperature_rate_ = p_[temperature_rate][0];
};

/// The surplus as slots are gone through in order: it grows by what each leaves and falls, to no less than 0, by what
/// each needs, S ← max(0, S − e).
struct Surplus {
  double change = 0;  // of the slots so far, as if it could fall below 0
  double lowest = 0;  // of that, so far

  void pass(double excess) { change -= excess, lowest = std::min(lowest, change); }
  /// What is left after these slots of what there was before them.
  double after(double before) const { return std::max(before + change, change - lowest); }
};

}  // namespace

template <int Dim, class Real> void integrate_energy_bounded(State<Dim, Real>& s) {
  const EnergyBoundedEuler<Dim, Real> euler(s);
  // Fixed blocks: each one's share of the surplus, then what each starts with, then the particles.
  const std::size_t slots = s.particles.slots(), blocks = (slots + block_size - 1) / block_size;
  const auto for_block = [&](std::size_t b, auto&& f) {
    for (std::size_t slot = b * block_size; slot < std::min(slots, (b + 1) * block_size); ++slot) f(slot);
  };
  std::vector<Surplus> of_block(blocks);
  for_each_piece(blocks,
                 [&](std::size_t b) { for_block(b, [&](std::size_t k) { of_block[b].pass(euler.excess(k)); }); });
  std::vector<double> at_start(blocks + 1, 0.0), way2(blocks, 0.0);
  for (std::size_t b = 0; b < blocks; ++b) at_start[b + 1] = of_block[b].after(at_start[b]);
  for_each_piece(blocks, [&](std::size_t b) {
    double surplus = s.parameters.energy_surplus ? at_start[b] : 0;
    for_block(b, [&](std::size_t k) {
      const double excess = euler.excess(k);
      way2[b] = std::max(way2[b], euler.advance(k, surplus));
      surplus = s.parameters.energy_surplus ? std::max(0.0, surplus - excess) : 0;
    });
  });
  double largest = 0;
  for (const double w : way2) largest = std::max(largest, w);
  s.neighbours.moved(std::sqrt(largest));
  prepare(s);
}

#define MOLTEN_INSTANTIATE(Dim, Real) template void integrate_energy_bounded(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
