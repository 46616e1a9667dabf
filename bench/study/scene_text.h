// Pieces of scene files for the cases.
#pragma once

#include <fmt/format.h>

#include <string>

#include "bench/study/simulation.h"

namespace molten::study {

inline std::string vector_text(int dimensions, const Triple& v) {
  return dimensions == 2 ? fmt::format("[{:.17g}, {:.17g}]", v[0], v[1])
                         : fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v[0], v[1], v[2]);
}

inline std::string box_text(int dimensions, const Triple& lower, const Triple& upper) {
  return fmt::format("{{ min = {}, max = {} }}", vector_text(dimensions, lower), vector_text(dimensions, upper));
}

/// The head of a scene; `more` are further lines of [scene].
inline std::string scene_head(int dimensions, const Triple& gravity, const std::string& more = "") {
  return fmt::format("[scene]\ndimensions = {}\ngravity = {}\n{}\n", dimensions, vector_text(dimensions, gravity),
                     more);
}

/// The lines of [scene] for a box (m) that closes on itself along these axes, such as "xy".
inline std::string periodic_text(int dimensions, const Triple& lower, const Triple& upper, const std::string& axes) {
  std::string names;
  for (const char axis : axes) names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", axis);
  return fmt::format("domain = {}\nperiodic = [{}]\n", box_text(dimensions, lower, upper), names);
}

/// [fluid] with a stand-in for the shape, and what follows of it; then [run].
inline std::string fluid_text(int dimensions, double spacing, double density, const std::string& more = "") {
  return fmt::format("[fluid]\nbox = {}\nspacing = {:.17g}\ndensity = {:.17g}\n{}\n[run]\nend_time = 1\n",
                     box_text(dimensions, {0, 0, 0}, {1, 1, 1}), spacing, density, more);
}

inline std::string newtonian_text(double viscosity) {
  return fmt::format("[fluid.rheology]\nviscosity = {:.17g}\n", viscosity);
}

/// [numerics] with the sound speed (m/s) that suits the case: ten times the fastest flow unless it says otherwise.
inline std::string sound_speed_text(double sound_speed) {
  return fmt::format("[numerics]\nsound_speed = {:.17g}\n", sound_speed);
}

/// What makes a wall felt by the fluid before it: to follow the text of [numerics].
/// `diffusion`: δ. Presets that know no support go without (simulation.cpp).
inline std::string wall_support_text(double diffusion = 0.1) {
  return fmt::format("wall_support = true\ndensity_diffusion = {}\n", diffusion);
}

/// With δ = 0.2 the smoothing ratio that leaves the least noise in the pressures of impacts, of 1.3 to 2 with 0.1 to
/// 0.3, for the same run time: longer steps pay for more neighbours. The sources' presets keep their own
/// (simulation.cpp).
inline constexpr std::string_view impact_text = "smoothing_ratio = 1.7\n";

/// Newtonian flow that walls drive, with δ = 0.1: from a ratio of 1.7 to 2 the cavity's errors fall to 0.7 at 30 particles
/// a side, 0.6 at 40 and 0.55 at 50, its run time to 0.9. The sources' presets keep their own here, too.
inline constexpr std::string_view driven_text = "smoothing_ratio = 2\n";

}  // namespace molten::study
