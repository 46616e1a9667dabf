#include "io/picture/colour_field.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace molten {
namespace {

const SnapshotField* find(const Snapshot& snapshot, const std::string& name) {
  const auto found = std::find_if(snapshot.fields.begin(), snapshot.fields.end(),
                                  [&](const SnapshotField& field) { return field.name == name; });
  return found != snapshot.fields.end() ? &*found : nullptr;
}

// "velocity magnitude" and "speed" mean the field "velocity", unless a field has just that name.
const SnapshotField* find_wanted(const Snapshot& snapshot, std::string name) {
  if (const SnapshotField* field = find(snapshot, name)) return field;
  if (name == "speed") return find(snapshot, "velocity");
  const std::string suffix = " magnitude";
  if (!name.ends_with(suffix)) return nullptr;
  name.resize(name.size() - suffix.size());
  return find(snapshot, name);
}

std::string names_of(const Snapshot& snapshot) {
  std::string names;
  for (const SnapshotField& field : snapshot.fields) names += (names.empty() ? "" : ", ") + field.name;
  return names.empty() ? "no fields at all" : names;
}

std::vector<double> magnitudes(const SnapshotField& field, std::size_t count) {
  if (field.components == 1) return field.values;
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0;
    for (int c = 0; c < field.components; ++c) sum += std::pow(field.values[i * field.components + c], 2);
    values[i] = std::sqrt(sum);
  }
  return values;
}

}  // namespace

std::optional<std::array<double, 2>> ColourField::range() const {
  std::optional<std::array<double, 2>> range;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    if (!range) range = {value, value};
    (*range)[0] = std::min((*range)[0], value);
    (*range)[1] = std::max((*range)[1], value);
  }
  return range;
}

std::optional<ColourField> colour_field(const Snapshot& snapshot, const std::string& wanted) {
  const SnapshotField* field = find_wanted(snapshot, wanted.empty() ? "temperature" : wanted);
  if (!field && wanted.empty()) field = find_wanted(snapshot, "speed");
  if (!field && wanted.empty()) return std::nullopt;
  if (!field)
    throw Error(ExitCode::usage, "there is no field '" + wanted + "' to colour by; there are: " + names_of(snapshot));
  ColourField result;
  result.title = field->name == "velocity" ? "speed" : field->name + (field->components > 1 ? " magnitude" : "");
  if (!field->unit.empty() && field->unit != "1") result.title += " (" + field->unit + ")";
  std::replace(result.title.begin(), result.title.end(), '_', ' ');
  result.map = field->name == "temperature" ? ColourMap::inferno : ColourMap::viridis;
  result.values = magnitudes(*field, snapshot.count());
  result.values.resize(snapshot.count(), std::nan(""));
  return result;
}

}  // namespace molten
