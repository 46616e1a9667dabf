#include "io/scene/toml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <sstream>

#include "core/error.h"

namespace molten {
namespace {

constexpr int deepest_key = 32;
constexpr std::string_view override_prefix = "--set ";

// ---- the file ----

void refuse_deep_keys(const std::string& text, const std::string& file) {
  const std::size_t at = find_deep_key(text, deepest_key);
  if (at == std::string::npos) return;
  const int line = 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
  fail_at({file, line, 1}, fmt::format("a key with more than {} dots; this is no scene", deepest_key));
}

[[noreturn]] void fail_syntax(const Place& place, const toml::parse_error& error) {
  constexpr std::string_view lead = "Error while parsing ";
  std::string_view what = error.description();
  if (what.starts_with(lead)) what.remove_prefix(lead.size());
  fail_at(place, fmt::format("not valid TOML: {}; correct the line", one_line(what)));
}

// ---- overrides ----

[[noreturn]] void fail_override(const std::string& text, const std::string& message) {
  fail_at({std::string(override_prefix) + shown(text), 0, 0}, message);
}

bool is_key_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

bool is_word(std::string_view text) { return !text.empty() && std::all_of(text.begin(), text.end(), is_key_character); }

std::vector<std::string> split_key(const std::string& text, const std::string& key) {
  const std::size_t begin = key.find_first_not_of(' '), end = key.find_last_not_of(' ');
  std::vector<std::string> parts;
  std::stringstream rest(begin == std::string::npos ? "." : key.substr(begin, end - begin + 1) + '.');
  for (std::string part; std::getline(rest, part, '.');) {
    if (!is_word(part)) fail_override(text, "not a key; write --set table.key=value");
    parts.push_back(part);
  }
  if (parts.empty() || parts.size() > deepest_key) fail_override(text, "not a key; write --set table.key=value");
  return parts;
}

/// The value as a table with the one key "value". A bare word counts as a string: shells eat quotes.
toml::table parse_value(const std::string& text, const std::string& value) {
  std::string source = std::string(override_prefix) + shown(text);
  if (find_deep_key(value, deepest_key) == std::string::npos) {
    try {
      toml::table table = toml::parse("value = " + value, std::move(source));
      if (table.size() == 1) return table;
    } catch (const toml::parse_error&) {
      if (is_word(value))
        return toml::parse(fmt::format("value = \"{}\"", value), std::string(override_prefix) + shown(text));
    }
  }
  fail_override(text, "the value is not one TOML value; quote strings, write numbers with a decimal point");
}

toml::node* element(toml::array& array, const std::string& text, const std::string& index) {
  std::size_t at = 0;
  const auto [end, error] = std::from_chars(index.data(), index.data() + index.size(), at);
  if (error != std::errc() || end != index.data() + index.size()) {
    fail_override(text, fmt::format("{} is no index; count the entries from 0", shown(index)));
  }
  if (at >= array.size())
    fail_override(text,
                  fmt::format("there {} only {}, counted from 0", array.size() == 1 ? "is" : "are", array.size()));
  return array.get(at);
}

toml::node* child(toml::node& parent, const std::string& text, const std::string& key) {
  if (toml::array* array = parent.as_array()) return element(*array, text, key);
  toml::table* table = parent.as_table();
  if (table == nullptr) fail_override(text, fmt::format("what holds {} is a plain value, not a table", shown(key)));
  if (!table->contains(key)) table->insert(key, toml::table{});
  return table->get(key);
}

void apply_override(toml::table& root, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) fail_override(text, "no value; write --set key=value");
  const std::vector<std::string> key = split_key(text, text.substr(0, equals));
  toml::table value = parse_value(text, text.substr(equals + 1));
  toml::node* parent = &root;
  for (std::size_t part = 0; part + 1 < key.size(); ++part) parent = child(*parent, text, key[part]);
  toml::node&& node = std::move(*value.get("value"));
  if (toml::array* array = parent->as_array()) {
    toml::node* old = element(*array, text, key.back());
    const auto at = std::find_if(array->cbegin(), array->cend(), [old](const toml::node& one) { return &one == old; });
    array->replace(at, std::move(node));
  } else if (toml::table* table = parent->as_table()) {
    table->insert_or_assign(key.back(), std::move(node));
  } else {
    fail_override(text, fmt::format("what holds {} is a plain value, not a table", shown(key.back())));
  }
}

std::string as_text(const toml::table& root) {
  std::ostringstream out;
  out << root << '\n';
  return out.str();
}

}  // namespace

Place TomlDocument::place(const toml::source_region& source) const {
  if (source.path && source.path->starts_with(override_prefix)) return {*source.path, 0, 0};
  int line = static_cast<int>(source.begin.line), column = static_cast<int>(source.begin.column);
  if (line > 0 && static_cast<std::size_t>(line) <= layout.lines.size()) {
    const SplitText::Line& origin = layout.lines[static_cast<std::size_t>(line) - 1];
    line = origin.line;
    column += origin.shift;
  }
  return {file, line, column};
}

TomlDocument parse_toml(const std::string& raw, const std::string& file, const std::vector<std::string>& overrides) {
  const std::string text = raw.starts_with("\xEF\xBB\xBF") ? raw.substr(3) : raw;  // byte-order mark
  refuse_deep_keys(text, file);
  TomlDocument document{file, text, {}, {}};
  try {
    document.root = toml::parse(text, file);
  } catch (const toml::parse_error& strict) {
    document.layout = split_lines(text);
    if (document.layout.lines.empty()) fail_syntax(document.place(strict.source()), strict);
    try {
      document.root = toml::parse(document.layout.text, file);
      document.text = document.layout.text;
    } catch (const toml::parse_error& error) {
      fail_syntax(document.place(error.source()), error);
    }
  }
  for (const std::string& one : overrides) apply_override(document.root, one);
  if (!overrides.empty()) document.text = as_text(document.root);
  return document;
}

void fail_at(const Place& place, const std::string& message) {
  throw Error(ExitCode::usage, text_of(place) + ": " + message);
}

std::string one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  }
  return line;
}

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 60;
  if (text.size() <= longest) return one_line(text);
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;  // not inside a character
  return one_line(text.substr(0, end)) + "...";
}

}  // namespace molten
