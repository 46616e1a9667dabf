// A TOML file as toml++ nodes, with the overrides of the command line in it and every node's place known.
#pragma once

#include <toml++/toml.h>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene.h"
#include "io/scene/toml_layout.h"

namespace molten {

struct TomlDocument {
  std::string file;  // as messages show it
  std::string text;  // the effective TOML: as read, or written anew when there are overrides
  toml::table root;
  SplitText layout;

  /// Where a node stands: in the file, or in the override that set it.
  Place place(const toml::source_region& source) const;
};

/// Throws Error(usage) with the place of the first syntax error, or with the override that cannot be applied.
TomlDocument parse_toml(const std::string& text, const std::string& file, const std::vector<std::string>& overrides);

/// Throws Error(usage) with the line `file:line:column: message`.
[[noreturn]] void fail_at(const Place& place, const std::string& message);

/// Text of others for a message: control characters blanked; shown() also cuts what is long.
std::string one_line(std::string_view text);
std::string shown(std::string_view text);

}  // namespace molten
