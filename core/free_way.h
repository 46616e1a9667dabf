// How far each particle may go from where it was sorted before it can meet a wall, in half a byte: most need no
// collision. And what it then meets, where that is one face for all of a cluster.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/archive.h"
#include "core/particles.h"

namespace molten {

class FreeWay {
 public:
  /// Longer ways (spacings) are not told apart: those between two sorts are shorter, but for wild motion.
  static constexpr double longest = 0.5;

  /// Nobody meets a wall within the longest.
  void reset(std::size_t slots) {
    parts_.assign(slots / 2, beyond << 4 | beyond);
    face_.assign(slots / cluster_size, no_face);
  }
  /// `way` in spacings. Two slots share a byte: those of a cluster are for one thread.
  void set(std::size_t slot, double way) {
    std::uint8_t& both = parts_[slot / 2];
    const int part = way < longest ? part_of(way) : beyond;
    both = static_cast<std::uint8_t>(slot % 2 ? (both & 15) | part << 4 : (both & ~15) | part);
  }

  /// The most that a part may be for a wall to be met within `way` (spacings, at most the longest).
  static std::uint8_t part_of(double way) { return static_cast<std::uint8_t>(parts_per_spacing * std::max(0.0, way)); }
  bool within(std::uint8_t part, std::size_t slot) const { return (parts_[slot / 2] >> slot % 2 * 4 & 15) <= part; }
  /// For any of a cluster.
  bool any_within(std::uint8_t part, std::size_t cluster) const {
    std::uint16_t all;  // far from walls, as most are
    static_assert(sizeof all == cluster_size / 2);
    std::memcpy(&all, &parts_[cluster * sizeof all], sizeof all);
    if (all == 0xffff) return false;
    bool any = false;
    for (int n = 0; n < cluster_size; ++n) any |= within(part, cluster * cluster_size + n);
    return any;
  }

  /// The face (Contact::only_face) that is all that a whole cluster's particles can meet within this way (spacings): as
  /// far as they get with the usual skin, since the further, the fewer clusters there are with one face alone.
  static constexpr double face_reach = 0.25;
  static constexpr std::int32_t no_face = -1;
  void set_face(std::size_t cluster, std::int32_t face) { face_[cluster] = face; }
  std::int32_t face(std::size_t cluster) const { return face_[cluster]; }

  void archive(Archive& a) {
    a.vector("neighbours/free_way", parts_);
    a.vector("neighbours/only_face", face_);
  }
  std::size_t bytes() const { return parts_.capacity() + face_.capacity() * sizeof face_[0]; }

 private:
  static constexpr double parts_per_spacing = 28;
  static constexpr std::uint8_t beyond = 15;
  std::vector<std::uint8_t> parts_;
  std::vector<std::int32_t> face_;  // by cluster
};

}  // namespace molten
