#include "io/scene/toml_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace molten {
namespace {

const char* type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

std::string condition(const Range& range) {
  const bool bounded_low = range.low > -Range::largest, bounded_high = range.high < Range::largest;
  const char* low_word = range.low_included ? "at least" : "above";
  if (bounded_low && bounded_high) return fmt::format(" {} {} and at most {}", low_word, range.low, range.high);
  if (bounded_low) return fmt::format(" {} {}", low_word, range.low);
  if (bounded_high) return fmt::format(" at most {}", range.high);
  return "";
}

std::string wanted(const Range& range) {
  const std::string unit = range.unit[0] == '\0' ? "" : fmt::format(" in {}", range.unit);
  return fmt::format("a number{}{}", condition(range), unit);
}

/// Edits (insert, delete, replace) between two words.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string suggest(std::string_view word, const TomlReader::Keys& names) {
  constexpr std::size_t longest = 40;  // no name is longer; hostile words are
  std::string_view best;
  std::size_t best_distance = word.size() <= 4 ? 2 : 3;
  for (const std::string_view name : names) {
    if (word.size() > longest) break;
    const bool begins = word.size() >= 3 && (name.starts_with(word) || word.starts_with(name));
    const std::size_t edits = begins ? 1 : distance(word, name);
    if (edits < best_distance && edits < std::max(word.size(), name.size())) {
      best = name;
      best_distance = edits;
    }
  }
  if (!best.empty()) return fmt::format("; did you mean {}?", best);
  return fmt::format("; known: {}", fmt::join(names, ", "));
}

TomlReader::TomlReader(const TomlDocument& document, const toml::table& table, std::string path, Keys keys)
    : document_(&document), table_(&table), path_(std::move(path)), keys_(std::move(keys)) {
  check_keys();
}

void TomlReader::check_keys() const {
  for (const auto& [key, value] : *table_) {
    if (std::find(keys_.begin(), keys_.end(), key.str()) != keys_.end()) continue;
    const toml::source_region& source = key.source().begin.line > 0 ? key.source() : value.source();
    fail_at(document_->place(source), full(key.str()) + ": unknown key" + suggest(key.str(), keys_));
  }
}

std::string TomlReader::full(std::string_view key) const {
  const std::string name = shown(key);
  return path_.empty() || name.empty() ? path_ + name : path_ + '.' + name;
}

Place TomlReader::place(std::string_view key) const {
  const toml::node* found = key.empty() ? nullptr : table_->get(key);
  return found != nullptr ? document_->place(found->source()) : place();
}

const toml::node* TomlReader::node(std::string_view key) const {
  assert(std::find(keys_.begin(), keys_.end(), key) != keys_.end());
  return table_->get(key);
}

void TomlReader::require(std::string_view key, std::string_view what_to_do) const {
  if (!has(key)) fail(key, fmt::format("missing; {}", what_to_do));
}

void TomlReader::fail(std::string_view key, const std::string& message) const {
  const std::string name = full(key);
  fail_at(place(key), name.empty() ? message : name + ": " + message);
}

double TomlReader::checked_number(std::string_view key, const toml::node& node, const Range& range) const {
  if (!node.is_number()) fail(key, fmt::format("is {}; give {}", type_name(node), wanted(range)));
  const double value = *node.value<double>();
  const bool above = range.low_included ? value >= range.low : value > range.low;
  if (!std::isfinite(value) || !above || value > range.high) {
    const bool too_large = range.high == Range::largest && std::abs(value) > Range::largest;
    fail(key, fmt::format("{} is out of range; give {}{}", value, wanted(range),
                          too_large ? fmt::format(", at most {}", Range::largest) : ""));
  }
  return value;
}

bool TomlReader::number(std::string_view key, double& value, const Range& range) const {
  const toml::node* found = node(key);
  if (found != nullptr) value = checked_number(key, *found, range);
  return found != nullptr;
}

bool TomlReader::number(std::string_view key, std::optional<double>& value, const Range& range) const {
  double read = 0;
  const bool found = number(key, read, range);
  if (found) value = read;
  return found;
}

bool TomlReader::numbers(std::string_view key, std::span<double> values, const Range& range) const {
  const toml::node* found = node(key);
  if (found == nullptr) return false;
  const toml::array* array = found->as_array();
  if (array == nullptr) fail(key, fmt::format("is {}; give an array of {} numbers", type_name(*found), values.size()));
  if (array->size() != values.size()) {
    fail(key, fmt::format("has {} entries; give {} numbers", array->size(), values.size()));
  }
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = checked_number(key, *array->get(i), range);
  return true;
}

bool TomlReader::whole(std::string_view key, long long& value, long long low, long long high) const {
  const toml::node* found = node(key);
  if (found == nullptr) return false;
  const double read = checked_number(key, *found, Range::any(""));
  if (read != std::floor(read) || read < static_cast<double>(low) || read > static_cast<double>(high)) {
    fail(key, fmt::format("{} does not do; give a whole number from {} to {}", read, low, high));
  }
  value = static_cast<long long>(read);
  return true;
}

bool TomlReader::flag(std::string_view key, bool& value) const {
  const toml::node* found = node(key);
  if (found == nullptr) return false;
  if (!found->is_boolean()) fail(key, fmt::format("is {}; give true or false", type_name(*found)));
  value = *found->value<bool>();
  return true;
}

std::string TomlReader::checked_text(std::string_view key, const toml::node& node) const {
  if (!node.is_string()) fail(key, fmt::format("is {}; give a string in quotes", type_name(node)));
  std::string value = *node.value<std::string>();
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (value.empty()) fail(key, "is empty; write something or leave the key out");
  if (std::any_of(value.begin(), value.end(), is_control)) fail(key, "has control characters; write plain text");
  return value;
}

bool TomlReader::text(std::string_view key, std::string& value) const {
  const toml::node* found = node(key);
  if (found != nullptr) value = checked_text(key, *found);
  return found != nullptr;
}

bool TomlReader::texts(std::string_view key, std::vector<std::string>& values) const {
  const toml::node* found = node(key);
  if (found == nullptr) return false;
  const toml::array* array = found->as_array();
  if (array == nullptr) fail(key, fmt::format("is {}; give an array of strings", type_name(*found)));
  values.clear();
  for (const toml::node& one : *array) {
    std::string value = checked_text(key, one);
    if (std::find(values.begin(), values.end(), value) != values.end()) {
      fail(key, fmt::format("has \"{}\" twice; keep one", shown(value)));
    }
    values.push_back(std::move(value));
  }
  return true;
}

bool TomlReader::points(std::string_view key, std::vector<std::array<double, 2>>& values) const {
  const toml::node* found = node(key);
  if (found == nullptr) return false;
  const toml::array* array = found->as_array();
  if (array == nullptr) fail(key, fmt::format("is {}; give an array of points [x, y]", type_name(*found)));
  values.clear();
  for (const toml::node& one : *array) {
    const toml::array* pair = one.as_array();
    if (pair == nullptr || pair->size() != 2) fail(key, "has an entry that is no pair; give points [x, y] in m");
    values.push_back(
        {checked_number(key, *pair->get(0), Range::any("m")), checked_number(key, *pair->get(1), Range::any("m"))});
  }
  return true;
}

bool TomlReader::rows(std::string_view key, std::vector<std::vector<double>>& rows,
                      const std::vector<std::size_t>& lengths, std::string_view form) const {
  const toml::node* found = node(key);
  if (found == nullptr) return false;
  const toml::array* array = found->as_array();
  if (array == nullptr) fail(key, fmt::format("is {}; give rows {}", type_name(*found), form));
  rows.clear();
  for (const toml::node& one : *array) {
    const toml::array* row = one.as_array();
    if (row == nullptr || std::find(lengths.begin(), lengths.end(), row->size()) == lengths.end())
      fail(key, fmt::format("row {} has another form; give {}", rows.size(), form));
    auto& numbers = rows.emplace_back();
    for (const toml::node& number : *row) numbers.push_back(checked_number(key, number, Range::any("")));
  }
  return true;
}

std::optional<std::size_t> TomlReader::choice_index(std::string_view key, const Keys& names) const {
  std::string word;
  if (!text(key, word)) return std::nullopt;
  const auto found = std::find(names.begin(), names.end(), word);
  if (found == names.end()) fail(key, fmt::format("unknown choice \"{}\"{}", shown(word), suggest(word, names)));
  return static_cast<std::size_t>(found - names.begin());
}

std::optional<TomlReader> TomlReader::table(std::string_view key, Keys keys) const {
  const toml::node* found = node(key);
  if (found == nullptr) return std::nullopt;
  if (found->is_array_of_tables()) fail(key, fmt::format("stands more than once; write one [{}]", full(key)));
  const toml::table* table = found->as_table();
  if (table == nullptr) fail(key, fmt::format("is {}; give a table: {}", type_name(*found), fmt::join(keys, ", ")));
  return TomlReader(*document_, *table, full(key), std::move(keys));
}

std::vector<TomlReader> TomlReader::tables(std::string_view key, const Keys& keys) const {
  const toml::node* found = node(key);
  std::vector<TomlReader> readers;
  if (found == nullptr) return readers;
  const toml::array* array = found->as_array();
  if (array == nullptr) fail(key, fmt::format("is {}; write [[{}]], once for each", type_name(*found), full(key)));
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::table* one = array->get(i)->as_table();
    if (one == nullptr) fail(key, fmt::format("holds {}; write [[{}]]", type_name(*array->get(i)), full(key)));
    readers.emplace_back(*document_, *one, fmt::format("{}.{}", full(key), i), keys);
  }
  return readers;
}

}  // namespace molten
