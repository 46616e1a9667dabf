#include "io/geometry/terrain.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"

namespace molten {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

[[noreturn]] void refuse(const fs::path& file, const std::string& what) {
  std::string line = file.string() + ": " + what;
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  throw Error(ExitCode::geometry, line);
}

[[noreturn]] void refuse(const fs::path& file, std::size_t line, const std::string& what) {
  throw Error(ExitCode::geometry, file.string() + ":" + std::to_string(line) + ": " + what);
}

std::string text_of(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) refuse(file, "no such file: check the path");
  std::ifstream in(file, std::ios::binary);
  if (!fs::is_regular_file(file, error) || !in) refuse(file, "cannot be read: give a height grid (.asc or .json)");
  std::string text((std::istreambuf_iterator<char>(in)), {});
  if (text.empty()) refuse(file, "the file is empty: export it again");
  return text;
}

void require_size(const fs::path& file, double columns, double rows) {
  if (columns != std::floor(columns) || rows != std::floor(rows) || !(columns >= 2 && rows >= 2))
    refuse(file, "a height grid needs at least 2 columns and 2 rows");
  if (columns * rows > 2147483647.0) refuse(file, "the height grid has more than 2147483647 samples: make it coarser");
}

void require_cell_size(const fs::path& file, double cell_size) {
  if (!(cell_size > 0) || !std::isfinite(cell_size)) refuse(file, "the cell size must be positive (m)");
}

/// Files give the northern row first, the grid has the southern one first.
void flip_rows(HeightGrid& grid) {
  for (int r = 0; r < grid.rows / 2; ++r) {
    const auto row = grid.heights.begin() + static_cast<std::ptrdiff_t>(r) * grid.columns;
    const auto other = grid.heights.begin() + static_cast<std::ptrdiff_t>(grid.rows - 1 - r) * grid.columns;
    std::swap_ranges(row, row + grid.columns, other);
  }
}

// ---- ESRI ASCII ---------------------------------------------------------------------------------------------------

struct AsciiHeader {
  std::optional<double> columns, rows, cell_size, x_corner, y_corner, x_center, y_center, no_data;
};

std::string_view next_word(std::string_view& rest) {
  constexpr std::string_view blanks = " \t\r\v\f";
  const std::size_t begin = std::min(rest.find_first_not_of(blanks), rest.size());
  const std::size_t end = std::min(rest.find_first_of(blanks, begin), rest.size());
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

std::optional<double> number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

class AsciiReader {
 public:
  explicit AsciiReader(const fs::path& file) : file_(file) {}

  void line(std::string_view line) {
    ++line_;
    std::string_view rest = line;
    const std::string_view first = next_word(rest);
    if (first.empty()) return;
    // A letter begins a header line, but NaN is a height.
    if (grid_.heights.empty() && std::isalpha(static_cast<unsigned char>(first[0])) && !number(first))
      header_line(first, next_word(rest));
    else
      heights(line);
  }

  HeightGrid result(const Terrain& terrain) {
    const double rows = required(header_.rows, "nrows");
    require_size(file_, required(header_.columns, "ncols"), rows);
    if (rows_ != static_cast<std::size_t>(rows))
      refuse(file_, "it has " + std::to_string(rows_) + " of " + std::to_string(static_cast<long long>(rows)) +
                        " rows: export it again");
    grid_.columns = static_cast<int>(*header_.columns);
    grid_.rows = static_cast<int>(rows);
    grid_.cell_size = terrain.cell_size ? *terrain.cell_size : required(header_.cell_size, "cellsize");
    // A corner is that of a cell; the sample is in the cell's middle.
    const double half = grid_.cell_size / 2;
    grid_.origin = {header_.x_center.value_or(header_.x_corner.value_or(-half) + half),
                    header_.y_center.value_or(header_.y_corner.value_or(-half) + half)};
    return std::move(grid_);
  }

 private:
  double required(const std::optional<double>& value, const char* key) const {
    if (!value) refuse(file_, std::string("its header lacks `") + key + "`: add it");
    return *value;
  }

  void header_line(std::string_view key, std::string_view value) {
    std::string name(key);
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    const std::pair<const char*, std::optional<double>*> known[] = {
        {"ncols", &header_.columns},      {"nrows", &header_.rows},          {"cellsize", &header_.cell_size},
        {"xllcorner", &header_.x_corner}, {"yllcorner", &header_.y_corner},  {"xllcenter", &header_.x_center},
        {"yllcenter", &header_.y_center}, {"nodata_value", &header_.no_data}};
    const auto at = std::find_if(std::begin(known), std::end(known), [&](const auto& k) { return k.first == name; });
    if (at == std::end(known))
      refuse(file_, line_, "not a line of an ESRI ASCII grid: give ncols, nrows, cellsize, ...");
    *at->second = number(value);
    const bool may_be_nan = name == "nodata_value";
    if (!*at->second || (!may_be_nan && !std::isfinite(**at->second)))
      refuse(file_, line_, "`" + name + "` needs a number");
  }

  void heights(std::string_view rest) {
    if (rows_ == 0) require_size(file_, required(header_.columns, "ncols"), required(header_.rows, "nrows"));
    const auto columns = static_cast<std::size_t>(*header_.columns);
    std::size_t count = 0;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest), ++count) {
      const auto value = number(word);
      const std::string where = "height " + std::to_string(count + 1) + " of the row ";
      if (value && header_.no_data && *value == *header_.no_data)
        refuse(file_, line_, where + "is missing (NODATA_value): fill the gaps or cut the grid");
      if (!value || !std::isfinite(*value)) refuse(file_, line_, where + "is not a finite number: repair the grid");
      grid_.heights.push_back(*value);
    }
    if (count != columns)
      refuse(file_, line_,
             "the row has " + std::to_string(count) + " heights, but ncols is " + std::to_string(columns));
    ++rows_;
  }

  const fs::path& file_;
  AsciiHeader header_;
  HeightGrid grid_;
  std::size_t line_ = 0, rows_ = 0;
};

HeightGrid read_ascii(const Terrain& terrain, const fs::path& file) {
  const std::string text = text_of(file);
  AsciiReader reader(file);
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    reader.line(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return reader.result(terrain);
}

// ---- JSON ---------------------------------------------------------------------------------------------------------

double json_number(const Json& json, const fs::path& file, const char* key) {
  const auto at = json.find(key);
  if (at == json.end() || !at->is_number()) refuse(file, std::string("`") + key + "` must be a number");
  return at->get<double>();
}

HeightGrid read_json(const Terrain& terrain, const fs::path& file) {
  const Json json = Json::parse(text_of(file), nullptr, false);
  if (json.is_discarded()) refuse(file, "it is not valid JSON: export it again");
  if (!json.is_object()) refuse(file, R"(it must be {"width": columns, "height": rows, "values": [...]})");
  const double columns = json_number(json, file, "width"), rows = json_number(json, file, "height");
  require_size(file, columns, rows);
  const auto values = json.find("values");
  if (values == json.end() || !values->is_array()) refuse(file, "`values` must be a list of heights (m)");
  if (static_cast<double>(values->size()) != columns * rows)
    refuse(file, "`values` has " + std::to_string(values->size()) + " heights; width x height is " +
                     std::to_string(static_cast<long long>(columns * rows)));
  HeightGrid grid;
  grid.columns = static_cast<int>(columns);
  grid.rows = static_cast<int>(rows);
  if (!terrain.cell_size && !json.contains("cell_size"))
    refuse(file, "the distance between samples is not known: give `cell_size` (m) in the scene");
  grid.cell_size = terrain.cell_size ? *terrain.cell_size : json_number(json, file, "cell_size");
  for (std::size_t i = 0; i < values->size(); ++i) {
    const Json& value = (*values)[i];
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      refuse(file, "values[" + std::to_string(i) + "] is not a finite number: fill the gaps or cut the grid");
    grid.heights.push_back(value.get<double>());
  }
  return grid;
}

}  // namespace

HeightGrid read_terrain(const Terrain& terrain, const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension != ".asc" && extension != ".json") refuse(file, "unknown kind of height grid: give .asc or .json");
  if (!std::isfinite(terrain.scale)) refuse(file, "the scale of the heights must be finite");
  HeightGrid grid = extension == ".asc" ? read_ascii(terrain, file) : read_json(terrain, file);
  require_cell_size(file, grid.cell_size);
  flip_rows(grid);
  for (double& height : grid.heights) height *= terrain.scale;
  // The scene's origin wins over the file's; an ESRI grid often lies in a national system far from 0.
  if (terrain.origin) grid.origin = {(*terrain.origin)[0], (*terrain.origin)[1]};
  return grid;
}

TriangleMesh triangulate(const HeightGrid& grid) {
  TriangleMesh mesh;
  mesh.vertices.reserve(grid.heights.size());
  mesh.triangles.reserve(2 * grid.heights.size());
  for (int r = 0; r < grid.rows; ++r)
    for (int c = 0; c < grid.columns; ++c)
      mesh.vertices.emplace_back(grid.origin.x() + c * grid.cell_size, grid.origin.y() + r * grid.cell_size,
                                 grid.at(c, r));
  for (int r = 0; r + 1 < grid.rows; ++r)
    for (int c = 0; c + 1 < grid.columns; ++c) {
      const std::int32_t south_west = r * grid.columns + c, south_east = south_west + 1;
      const std::int32_t north_west = south_west + grid.columns, north_east = north_west + 1;
      mesh.triangles.push_back({south_west, south_east, north_east});
      mesh.triangles.push_back({south_west, north_east, north_west});
    }
  return mesh;
}

}  // namespace molten
