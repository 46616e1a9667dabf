// How far each particle may go from where it was sorted before it can meet a wall, in a byte: most need no collision.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/particles.h"

namespace molten {

class FreeWay {
 public:
  /// Longer ways (spacings) are not told apart: those between two sorts are shorter, but for wild motion.
  static constexpr double longest = 0.5;

  /// Nobody meets a wall within the longest.
  void reset(std::size_t slots) { parts_.assign(slots, beyond); }
  /// `way` in spacings.
  void set(std::size_t slot, double way) { parts_[slot] = way < longest ? part_of(way) : beyond; }

  /// The most that a byte may be for a wall to be met within `way` (spacings, at most the longest).
  static std::uint8_t part_of(double way) { return static_cast<std::uint8_t>(parts_per_spacing * std::max(0.0, way)); }
  bool within(std::uint8_t part, std::size_t slot) const { return parts_[slot] <= part; }
  /// For any of a cluster.
  bool any_within(std::uint8_t part, std::size_t cluster) const {
    bool any = false;
    for (int n = 0; n < cluster_size; ++n) any |= within(part, cluster * cluster_size + n);
    return any;
  }

  std::vector<std::uint8_t>& column() { return parts_; }
  std::size_t bytes() const { return parts_.capacity(); }

 private:
  static constexpr double parts_per_spacing = 256;
  static constexpr std::uint8_t beyond = 255;
  std::vector<std::uint8_t> parts_;
};

}  // namespace molten
