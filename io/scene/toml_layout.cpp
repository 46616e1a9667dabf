#include "io/scene/toml_layout.h"

#include <algorithm>
#include <string_view>

namespace molten {
namespace {

constexpr auto npos = std::string::npos;

/// Whether a byte starts a character of UTF-8; positions count characters.
bool starts_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }

std::size_t end_of_line(std::string_view text, std::size_t at) { return std::min(text.find('\n', at), text.size()); }

/// The offset behind the string that starts at `at`, whichever of the four kinds it is; unterminated: the end.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const bool multi_line = text.size() >= at + 3 && text[at + 1] == quote && text[at + 2] == quote;
  const std::size_t width = multi_line ? 3 : 1;
  const std::string closing(width, quote);
  for (at += width; at < text.size(); ++at) {
    if (text[at] == '\\' && quote == '"') {
      ++at;
    } else if (text.compare(at, width, closing) == 0) {
      return at + width;
    } else if (text[at] == '\n' && !multi_line) {
      return at;
    }
  }
  return text.size();
}

/// The offset behind the string or comment that starts at `at`, or `at` itself when there is none.
std::size_t skip_quoted(std::string_view text, std::size_t at) {
  if (text[at] == '"' || text[at] == '\'') return end_of_string(text, at);
  if (text[at] == '#') return end_of_line(text, at);
  return at;
}

/// The offset behind the bracket that closes the one at `at`: an array, an inline table, or a header.
std::size_t end_of_brackets(std::string_view text, std::size_t at) {
  int depth = 0;
  while (at < text.size()) {
    if (const std::size_t behind = skip_quoted(text, at); behind != at) {
      at = behind;
      continue;
    }
    const char c = text[at++];
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && --depth == 0) return at;
  }
  return text.size();
}

std::size_t end_of_value(std::string_view text, std::size_t at) {
  if (at == text.size()) return at;
  if (text[at] == '"' || text[at] == '\'') return end_of_string(text, at);
  if (text[at] == '[' || text[at] == '{') return end_of_brackets(text, at);
  return std::min(text.find_first_of(" \t\r\n#", at), text.size());
}

/// The offset of the = of the key at `at`; npos when its line has none.
std::size_t find_equals(std::string_view text, std::size_t at) {
  while (at < text.size() && text[at] != '\n') {
    if (text[at] == '=') return at;
    const std::size_t behind = skip_quoted(text, at);
    at = behind == at ? at + 1 : behind;
  }
  return npos;
}

/// The offset behind the header or key and value that starts at `at`; npos when it is neither.
std::size_t end_of_entry(std::string_view text, std::size_t at) {
  if (text[at] == '[') return end_of_brackets(text, at);
  const std::size_t equals = find_equals(text, at);
  if (equals == npos) return npos;
  return end_of_value(text, std::min(text.find_first_not_of(" \t", equals + 1), text.size()));
}

/// Offsets of the blanks that have to become line ends.
std::vector<std::size_t> find_breaks(std::string_view text) {
  std::vector<std::size_t> breaks;
  for (std::size_t at = text.find_first_not_of(" \t\r\n"); at < text.size();
       at = text.find_first_not_of(" \t\r\n", at)) {
    if (text[at] == '#') {
      at = end_of_line(text, at);
      continue;
    }
    const std::size_t end = end_of_entry(text, at);
    if (end == npos) break;
    at = std::min(text.find_first_not_of(" \t", end), text.size());
    if (at == text.size() || text[at] == '#' || text[at] == '\r' || text[at] == '\n') continue;
    if (at == end) break;  // no blank between: the parser shall say what is wrong
    breaks.push_back(end);
  }
  return breaks;
}

}  // namespace

SplitText split_lines(const std::string& text) {
  SplitText split{text, {}};
  const std::vector<std::size_t> breaks = find_breaks(text);
  if (breaks.empty()) return split;
  SplitText::Line line{1, 0};
  int column = 0;
  split.lines.push_back(line);
  for (std::size_t at = 0, next = 0; at < text.size(); ++at) {
    if (starts_character(text[at])) ++column;
    const bool split_here = next < breaks.size() && breaks[next] == at;
    if (!split_here && text[at] != '\n') continue;
    line = split_here ? SplitText::Line{line.line, column} : SplitText::Line{line.line + 1, 0};
    if (split_here) {
      split.text[at] = '\n';
      ++next;
    } else {
      column = 0;
    }
    split.lines.push_back(line);
  }
  return split;
}

std::size_t find_deep_key(const std::string& text, int limit) {
  int dots = 0;
  for (std::size_t at = 0; at < text.size();) {
    if (const std::size_t behind = skip_quoted(text, at); behind != at) {
      at = behind;
      continue;
    }
    const char c = text[at++];
    if (c == '.' && ++dots > limit) return at - 1;
    if (c == ',' || c == '=' || c == '\n' || c == '[' || c == ']' || c == '{' || c == '}') dots = 0;
  }
  return npos;
}

}  // namespace molten
