// Density by summation and the density filters: passes of their own before the rates.
#include "core/rates_pass.h"

#include "core/particle_pass.h"
#include "core/physics/density_sums.h"

namespace molten {

template <int Dim, class Real> void sum_density(State<Dim, Real>& s) {
  const auto scope = s.timer.scope("density");
  const Parameters<Dim>& p = s.parameters;
  const auto delta = s.particles[compression][0], term = s.particles[pressure_term][0];
  const auto half = s.particles[half_compression][0];
  const PlainFinish finish{[&](std::size_t slot, const auto& sums) {
    delta[slot] = static_cast<Real>(s.particles.is_padding(slot) ? 0 : sums[kernel_sum] / p.eos.rest_density - 1);
    term[slot] = static_cast<Real>(p.eos.term(delta[slot]));
    if (half) half[slot] = delta[slot];
  }};
  const double h = p.support_radius / kernel_reach(p.density_kernel);
  with_kernel<Real>(p.density_kernel, Dim, h, p.particle_mass, [&](const auto& kernel) {
    pair_pass<native_lanes<Real>>(s.neighbours, s.particles, kernel, finish, DensitySum{});
  });
}

template <int Dim, class Real> void filter_density(State<Dim, Real>& s) {
  list_if_due(s);
  const auto scope = s.timer.scope("density filter");
  const Parameters<Dim>& p = s.parameters;
  const bool mls = p.density_filter.kind == DensityFilter::Kind::mls;
  const auto delta = s.particles[compression][0], term = s.particles[pressure_term][0];
  const auto half = s.particles[half_compression][0], filtered = s.particles[filtered_compression][0];
  const auto held_by = s.particles[held][0];  // null without boundary particles
  const PlainFinish finish{[&](std::size_t slot, const auto& sums) {
    if (s.particles.is_padding(slot) || (held_by && held_by[slot] > 0))
      filtered[slot] = delta[slot];
    else
      filtered[slot] = static_cast<Real>(filtered_compression_of<Dim>(sums, mls, p.smoothing_length));
  }};
  with_run_kernel(s, [&](const auto& kernel) {
    const auto pass = [&](const auto& term) {
      pair_pass<native_lanes<Real>>(s.neighbours, s.particles, kernel, finish, term);
    };
    held_by ? pass(FluidFilterSums{mls}) : pass(DensityFilterSums{mls});
  });
  for_each_slot(s.particles.slots(), [&](std::size_t slot) {
    if (half) half[slot] += filtered[slot] - delta[slot];
    delta[slot] = filtered[slot];
    term[slot] = static_cast<Real>(p.eos.term(delta[slot]));
  });
}

#define MOLTEN_INSTANTIATE(Dim, Real)           \
  template void sum_density(State<Dim, Real>&); \
  template void filter_density(State<Dim, Real>&);
MOLTEN_INSTANTIATE(2, float)
MOLTEN_INSTANTIATE(2, double)
MOLTEN_INSTANTIATE(3, float)
MOLTEN_INSTANTIATE(3, double)

}  // namespace molten
