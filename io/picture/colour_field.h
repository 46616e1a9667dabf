// Which numbers of a snapshot colour its picture.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/snapshot.h"
#include "io/picture/colour_map.h"

namespace molten {

struct ColourField {
  std::string title;  // "temperature (°C)"
  ColourMap map = ColourMap::viridis;
  std::vector<double> values;  // one a particle; vectors by their magnitude

  /// Lowest and highest finite value; nothing when there is none.
  std::optional<std::array<double, 2>> range() const;
};

/// `wanted`: a field's name, "name magnitude", or empty for temperature, else speed. Nothing when none is wanted and
/// the snapshot has neither; throws Error(usage) listing the fields when it lacks the wanted one.
std::optional<ColourField> colour_field(const Snapshot& snapshot, const std::string& wanted);

}  // namespace molten
