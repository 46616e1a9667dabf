// The text of a TOML file before its parser sees it: keys side by side, and nesting deep enough to hurt the parser.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace molten {

/// TOML wants a line for every key and header. Scenes may also stand as the design prints them, related keys side by
/// side: `[fluid] density = 1000.0  spacing = 0.01`. `text` is the same bytes with some blanks turned into line ends.
struct SplitText {
  struct Line {
    int line = 0, shift = 0;  // where the line stood in the original: its number, and the columns left of it
  };
  std::string text;
  std::vector<Line> lines;  // of `text`; empty when nothing was split
};
SplitText split_lines(const std::string& text);

/// Offset of the first dotted key with more than `limit` dots, npos if none. The parser recurses over the parts of a
/// dotted key when it frees them, so a file that is nothing but a long one would overflow the stack.
std::size_t find_deep_key(const std::string& text, int limit);

}  // namespace molten
