// Scene files: TOML, read with toml++ into core/scene.h. docs/scenes.md documents every key.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/scene.h"

namespace molten {

/// Reads, applies `overrides` ("fluid.density=1200", a TOML value after the first =), validates. Throws Error(usage):
/// one line `file:line:column: key: what is wrong; what to do`. Unknown keys, wrong types, NaN, non-positive where
/// positive is needed, and contradictions are errors.
Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same for a text that is not, or no longer, a file, such as the one a checkpoint carries. `file` names it in
/// messages and is what locate() looks beside.
Scene parse_scene(const std::string& text, const std::string& file, const std::vector<std::string>& overrides = {});

/// Where a file named in the scene is: absolute, beside the scene file, then in the folder above it. Returns the first
/// that exists, else the path beside the scene file.
std::filesystem::path locate(const Scene& scene, const std::string& path);

/// The same for a mesh or a terrain, which must be there. Throws Error(geometry): one line with where the scene asks
/// for it, and what to do.
std::filesystem::path find_file(const Scene& scene, const std::string& path, const Place& place);

}  // namespace molten
