#include "core/scene.h"

#include "core/error.h"

namespace molten {

std::string text_of(const Place& place) {
  if (place.line <= 0) return place.file;
  return place.file + ':' + std::to_string(place.line) + ':' + std::to_string(place.column);
}

namespace {

/// Of a key that is not in the file, such as one of a preset: where its table stands.
Place place_of(const Scene& scene, const std::string& key) {
  const auto found = scene.places.find(key);
  if (found != scene.places.end()) return found->second;
  const std::size_t dot = key.rfind('.');
  return dot == std::string::npos ? Place{scene.file, 0, 0} : place_of(scene, key.substr(0, dot));
}

/// Who chose a key of [numerics] that is not in the file.
std::string chooser_of(const Scene& scene, const std::string& key) {
  if (!key.starts_with("numerics.") || scene.places.empty() || scene.places.contains(key)) return "";
  return " (chosen by preset \"" + scene.numerics.preset + "\")";
}

}  // namespace

void refuse(const Scene& scene, const std::string& key, const std::string& why) {
  throw Error(ExitCode::usage, text_of(place_of(scene, key)) + ": " + key + chooser_of(scene, key) + ": " + why);
}

}  // namespace molten
