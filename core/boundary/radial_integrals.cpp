#include "core/boundary/radial_integrals.h"

#include "core/boundary/gauss.h"
#include "core/kernel.h"

namespace molten {
namespace {

constexpr std::size_t table_size = 2048;  // linear interpolation is then good to 1e-6

const Gauss<6> coarse;
const Gauss<16> fine;

}  // namespace

RadialIntegrals::RadialIntegrals(KernelKind kind, int dim, double smoothing_length)
    : reach_(kernel_reach(kind) * smoothing_length), per_entry_(table_size / reach_) {
  const std::size_t n = table_size;
  const double step = reach_ / n;
  dim_ = dim;
  kernel_.resize(n + 1, 0);
  slope_.resize(n + 1, 0);
  with_kernel<double>(kind, dim, smoothing_length, 1, [&](const auto& kernel) {
    for (std::size_t k = 0; k < n; ++k) {
      const auto at = kernel(Lanes<double, 1>(k * step));
      kernel_[k] = at.w.v;
      slope_[k] = at.slope.v;
    }
  });
  // From the support inwards; W is linear between the entries, which makes the sums exact to second order.
  weight_beyond_.assign(n + 1, 0);
  volume_beyond_.assign(n + 1, 0);  // ∫_r^R W s² ds
  const auto integral = [&](std::size_t k, auto&& f) { return coarse(k * step, (k + 1) * step, f); };
  for (std::size_t k = n; k-- > 0;) {
    weight_beyond_[k] = weight_beyond_[k + 1] + integral(k, [&](double s) { return at(kernel_, s) * s; });
    volume_beyond_[k] = volume_beyond_[k + 1] + integral(k, [&](double s) { return at(kernel_, s) * s * s; });
  }
  planes_.assign(n + 1, {});
  if (dim == 2)
    fill_planes_2d();
  else
    fill_planes_3d();
}

void RadialIntegrals::fill_planes_3d() {
  const std::size_t n = table_size;
  const double step = reach_ / n;
  Table beyond(n + 1, 0);  // ∫_r^R H s ds; H s = s^−2 ∫_s^R W
  hidden_beyond_.assign(n + 1, 0);
  for (std::size_t k = n; k-- > 1;) {
    const auto slope = [&](double s) { return at(volume_beyond_, s) / (s * s); };
    beyond[k] = beyond[k + 1] + coarse(k * step, (k + 1) * step, slope);
    hidden_beyond_[k] = k * step * beyond[k];
  }
  hidden_beyond_[0] = volume_beyond_[0];  // the limit
  for (std::size_t k = 0; k < n; ++k)
    planes_[k] = {2 * std::numbers::pi * weight_beyond_[k], 2 * std::numbers::pi * hidden_beyond_[k]};
}

void RadialIntegrals::fill_planes_2d() {
  const std::size_t n = table_size;
  for (std::size_t k = 0; k < n; ++k) {
    const double d = k / per_entry_, half = std::sqrt(reach_ * reach_ - d * d);
    planes_[k].weight = 2 * fine(0, half, [&](double t) { return at(kernel_, std::hypot(d, t)); });
    planes_[k].hidden =
        2 * fine(0, std::acos(d / reach_), [&](double a) { return at(weight_beyond_, d / std::cos(a)); });
  }
}

}  // namespace molten
