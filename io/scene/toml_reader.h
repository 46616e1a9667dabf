// Typed, checked access to one table of a TOML document. Every complaint is one line with place, key and what to do.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/scene/toml_document.h"

namespace molten {

/// The numbers that a key allows, and their unit for messages.
struct Range {
  static constexpr double largest = 1e30;  // beyond, squares overflow single precision
  double low = -largest, high = largest;
  bool low_included = true;
  const char* unit = "";

  static Range any(const char* unit) { return {-largest, largest, true, unit}; }
  static Range positive(const char* unit) { return {0, largest, false, unit}; }
  static Range not_negative(const char* unit) { return {0, largest, true, unit}; }
  static Range fraction() { return {0, 1, true, ""}; }
};

class TomlReader {
 public:
  using Keys = std::vector<std::string_view>;

  /// `path` names the table in messages ("fluid.heat", "" for the root). A key that is not in `keys` is an error.
  TomlReader(const TomlDocument& document, const toml::table& table, std::string path, Keys keys);

  Place place() const { return document_->place(table_->source()); }
  Place place(std::string_view key) const;
  /// Null when absent.
  const toml::node* node(std::string_view key) const;
  bool has(std::string_view key) const { return node(key) != nullptr; }
  /// Throws unless the key is there; `what_to_do` ends the message.
  void require(std::string_view key, std::string_view what_to_do) const;
  [[noreturn]] void fail(std::string_view key, const std::string& message) const;

  // Each returns whether the key is there and leaves `value` alone when it is not.
  bool number(std::string_view key, double& value, const Range& range) const;
  bool number(std::string_view key, std::optional<double>& value, const Range& range) const;
  bool numbers(std::string_view key, std::span<double> values, const Range& range) const;
  /// What a vector has in so many dimensions.
  bool vector(std::string_view key, std::array<double, 3>& value, int dimensions, const Range& range) const {
    return numbers(key, std::span(value).first(static_cast<std::size_t>(dimensions)), range);
  }
  bool whole(std::string_view key, long long& value, long long low, long long high) const;
  bool flag(std::string_view key, bool& value) const;
  bool text(std::string_view key, std::string& value) const;
  bool texts(std::string_view key, std::vector<std::string>& values) const;
  bool points(std::string_view key, std::vector<std::array<double, 2>>& values) const;
  /// An array of rows of numbers, each of one of the `lengths`; `form` says in messages what a row is.
  bool rows(std::string_view key, std::vector<std::vector<double>>& rows, const std::vector<std::size_t>& lengths,
            std::string_view form) const;

  template <class T>
  bool choice(std::string_view key, T& value, const std::vector<std::pair<std::string_view, T>>& choices) const {
    Keys names;
    for (const auto& [name, meaning] : choices) names.push_back(name);
    const std::optional<std::size_t> index = choice_index(key, names);
    if (index) value = choices[*index].second;
    return index.has_value();
  }

  std::optional<TomlReader> table(std::string_view key, Keys keys) const;
  /// The tables of `[[key]]`.
  std::vector<TomlReader> tables(std::string_view key, const Keys& keys) const;

 private:
  std::string full(std::string_view key) const;
  void check_keys() const;
  double checked_number(std::string_view key, const toml::node& node, const Range& range) const;
  std::string checked_text(std::string_view key, const toml::node& node) const;
  std::optional<std::size_t> choice_index(std::string_view key, const Keys& names) const;

  const TomlDocument* document_;
  const toml::table* table_;
  std::string path_;
  Keys keys_;
};

/// `; did you mean NAME?` for the nearest of `names`, or a list of them when none is near.
std::string suggest(std::string_view word, const TomlReader::Keys& names);

}  // namespace molten
