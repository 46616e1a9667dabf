#include "io/geometry/mesh_checks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace molten {
namespace {

static_assert(std::endian::native == std::endian::little);

[[noreturn]] void refuse(const std::string& what) { throw std::runtime_error(what); }
[[noreturn]] void refuse(std::size_t line, const std::string& what) {
  refuse("line " + std::to_string(line) + ": " + what);
}

constexpr std::string_view blanks = " \t\r\v\f";

/// Cuts the next word off the front; empty at the end.
std::string_view next_word(std::string_view& rest, std::string_view separators = blanks) {
  const std::size_t begin = std::min(rest.find_first_not_of(separators), rest.size());
  const std::size_t end = std::min(rest.find_first_of(separators, begin), rest.size());
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

std::string_view next_line(std::string_view& rest) {
  const std::size_t end = std::min(rest.find('\n'), rest.size());
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return line;
}

template <class Number> std::optional<Number> number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// No NaN, no infinity, and nothing so long that assimp's own parser overflows on its digits.
bool is_coordinate(double value) { return std::abs(value) < 1e15; }

void require_point(std::string_view& rest, std::size_t line, std::string_view separators = blanks) {
  for (int k = 0; k < 3; ++k) {
    const auto value = number<double>(next_word(rest, separators));
    if (!value || !is_coordinate(*value)) refuse(line, "a vertex needs three numbers below 1e15");
  }
}

// ---- OBJ ----------------------------------------------------------------------------------------------------------

class ObjCheck {
 public:
  void line(std::size_t number, std::string_view rest) {
    const std::string_view word = next_word(rest);
    if (word == "v") {
      require_point(rest, number);
      ++vertices_;
    } else if (word == "f") {
      face(number, rest);
    }
  }

  FacesInFile result() const {
    if (highest_ > vertices_)
      refuse(highest_line_,
             "a face names vertex " + std::to_string(highest_) + ", but the file has " + std::to_string(vertices_));
    if (found_.faces == 0) refuse("it has no faces");
    return found_;
  }

 private:
  void face(std::size_t line, std::string_view rest) {
    int corners = 0;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest), ++corners) {
      const auto index = number<long long>(word.substr(0, word.find('/')));
      if (!index || *index == 0 || *index < -vertices_) refuse(line, "a face names a vertex that does not exist");
      if (*index > highest_) highest_ = *index, highest_line_ = line;
    }
    if (corners < 3) refuse(line, "a face has fewer than 3 corners");
    ++found_.faces;
    found_.only_triangles = found_.only_triangles && corners == 3;
  }

  long long vertices_ = 0, highest_ = 0;
  std::size_t highest_line_ = 0;
  FacesInFile found_;
};

// ---- STL ----------------------------------------------------------------------------------------------------------

constexpr std::size_t stl_header = 84, stl_triangle = 50;

FacesInFile check_text_stl(std::string_view text) {
  FacesInFile found;
  std::size_t vertices = 0, ends = 0, solids = 0, line = 0;
  while (!text.empty()) {
    std::string_view rest = next_line(text);
    ++line;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      if (word == "solid") ++solids, rest = {};
      if (word == "endsolid") --solids, rest = {};
      if (word == "vertex") require_point(rest, line), ++vertices;
      if (word == "endfacet") ++ends;
      if (word == "facet") ++found.faces;
    }
  }
  if (solids != 0 || ends != found.faces || vertices != 3 * found.faces)
    refuse("it is truncated: " + std::to_string(found.faces) + " facets begin, " + std::to_string(ends) + " end, and " +
           std::to_string(vertices) + " vertices are given");
  if (found.faces == 0) refuse("it has no triangles");
  return found;
}

// ---- PLY ----------------------------------------------------------------------------------------------------------

enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };

PlyType ply_type(std::string_view name) {
  constexpr std::array<std::string_view, 16> names = {"char",   "int8",    "uchar",  "uint8",  "short", "int16",
                                                      "ushort", "uint16",  "int",    "int32",  "uint",  "uint32",
                                                      "float",  "float32", "double", "float64"};
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) refuse("its header has an unknown type: " + std::string(name.substr(0, 40)));
  return static_cast<PlyType>((at - names.begin()) / 2);
}

struct PlyProperty {
  std::string_view name;
  PlyType type;
  std::optional<PlyType> list;  // type of the length
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  bool text = false, big_endian = false;
  std::vector<PlyElement> elements;
};

void header_line(PlyHeader& header, std::string_view rest, bool& has_format) {
  const std::string_view word = next_word(rest);
  if (word == "format") {
    const std::string_view kind = next_word(rest);
    header.text = kind == "ascii";
    header.big_endian = kind == "binary_big_endian";
    has_format = header.text || header.big_endian || kind == "binary_little_endian";
  } else if (word == "element") {
    const std::string_view name = next_word(rest);
    const auto count = number<std::uint64_t>(next_word(rest));
    if (!count) refuse("its header has an element without a number");
    header.elements.push_back({name, *count, {}});
  } else if (word == "property") {
    if (header.elements.empty()) refuse("its header has a property before any element");
    PlyProperty property{};
    std::string_view type = next_word(rest);
    if (type == "list") {
      property.list = ply_type(next_word(rest));
      type = next_word(rest);
    }
    property.type = ply_type(type);
    property.name = next_word(rest);
    header.elements.back().properties.push_back(property);
  }
}

PlyHeader ply_header(std::string_view& rest) {
  PlyHeader header;
  bool has_format = false;
  std::string_view first = next_line(rest);
  if (next_word(first) != "ply") refuse("it is not a PLY file (it does not begin with `ply`)");
  while (true) {
    if (rest.empty()) refuse("its header has no end_header");
    std::string_view line = next_line(rest), copy = line;
    if (next_word(copy) == "end_header") break;
    header_line(header, line, has_format);
  }
  if (!has_format) refuse("its header names no known format");
  return header;
}

/// Reads one number after the other from the body.
class PlyBody {
 public:
  PlyBody(const PlyHeader& header, std::string_view rest) : header_(header), rest_(rest) {}

  double next(PlyType type) {
    if (header_.text) {
      const auto value = number<double>(next_word(rest_, " \t\r\v\f\n"));
      if (!value) refuse("it is truncated: it has fewer numbers than its header promises");
      return *value;
    }
    switch (type) {
      case PlyType::i8:
        return take<std::int8_t>();
      case PlyType::u8:
        return take<std::uint8_t>();
      case PlyType::i16:
        return take<std::int16_t>();
      case PlyType::u16:
        return take<std::uint16_t>();
      case PlyType::i32:
        return take<std::int32_t>();
      case PlyType::u32:
        return take<std::uint32_t>();
      case PlyType::f32:
        return take<float>();
      case PlyType::f64:
        return take<double>();
    }
    return 0;
  }

 private:
  template <class Number> Number take() {
    std::array<char, sizeof(Number)> raw;
    if (rest_.size() < raw.size()) refuse("it is truncated: it has fewer bytes than its header promises");
    std::copy_n(rest_.begin(), raw.size(), raw.begin());
    rest_.remove_prefix(raw.size());
    if (header_.big_endian) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<Number>(raw);
  }

  const PlyHeader& header_;
  std::string_view rest_;
};

class PlyCheck {
 public:
  explicit PlyCheck(std::uint64_t vertices) : vertices_(static_cast<double>(vertices)) {}

  void property(const PlyElement& element, const PlyProperty& p, PlyBody& body) {
    const bool indices = element.name == "face" && (p.name == "vertex_indices" || p.name == "vertex_index") && p.list;
    const double length = p.list ? body.next(*p.list) : 1;
    if (!(length >= 0) || length != std::floor(length)) refuse("it has a list of length " + std::to_string(length));
    if (indices && length < 3) refuse("it has a face with fewer than 3 corners");
    for (auto left = static_cast<std::uint64_t>(std::min(length, 1e18)); left > 0; --left) {
      const double value = body.next(p.type);
      const bool coordinate = element.name == "vertex" && (p.name == "x" || p.name == "y" || p.name == "z");
      if (coordinate && !is_coordinate(value)) refuse("a vertex needs three numbers below 1e15");
      if (indices && !(value >= 0 && value < vertices_)) refuse("a face names a vertex that does not exist");
    }
    if (!indices) return;
    ++found.faces;
    found.only_triangles = found.only_triangles && length == 3;
  }

  FacesInFile found;

 private:
  double vertices_;
};

// ---- binary glTF ---------------------------------------------------------------------------------------------------

/// What assimp takes as it comes: it leaves out triangles whose corners do not exist, and flattens by any matrix.
class GlbCheck {
 public:
  GlbCheck(std::string_view json, std::string_view buffer) : root_(Json::parse(json, nullptr, false)), buffer_(buffer) {
    if (root_.is_discarded() || !root_.is_object()) refuse("its JSON chunk is not JSON");
  }

  void run() const {
    for (const Json& mesh : list(root_, "meshes"))
      for (const Json& primitive : list(mesh, "primitives")) check_triangles(primitive);
    for (const Json& node : list(root_, "nodes")) check_placing(node);
  }

 private:
  using Json = nlohmann::json;

  static const Json& list(const Json& parent, const char* name) {
    static const Json none = Json::array();
    const auto found = parent.is_object() ? parent.find(name) : parent.end();
    return found != parent.end() && found->is_array() ? *found : none;
  }
  /// A whole number; `otherwise` where there is none.
  static std::uint64_t whole(const Json& parent, const char* name, std::uint64_t otherwise) {
    const auto found = parent.find(name);
    if (found == parent.end()) return otherwise;
    if (!found->is_number_unsigned()) refuse(std::string("its ") + name + " is no whole number");
    return found->get<std::uint64_t>();
  }
  const Json& entry(const char* array, std::uint64_t index) const {
    const Json& all = list(root_, array);
    if (index >= all.size() || !all[index].is_object())
      refuse(std::string("it names an entry of ") + array + " that does not exist");
    return all[index];
  }

  void check_triangles(const Json& primitive) const {
    constexpr std::uint64_t triangles = 4, none = std::numeric_limits<std::uint64_t>::max();
    if (!primitive.is_object() || whole(primitive, "mode", triangles) != triangles) return;
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->contains("POSITION")) return;
    const std::uint64_t vertices = whole(entry("accessors", whole(*attributes, "POSITION", 0)), "count", 0);
    const std::uint64_t at = whole(primitive, "indices", none);
    const std::uint64_t corners = at == none ? vertices : whole(entry("accessors", at), "count", 0);
    if (corners % 3 != 0) refuse("a mesh has " + std::to_string(corners) + " corners, which make no whole triangles");
    if (at != none) check_indices(entry("accessors", at), corners, vertices);
  }

  void check_indices(const Json& accessor, std::uint64_t count, std::uint64_t vertices) const {
    constexpr std::uint64_t bytes = 5121, shorts = 5123, longs = 5125, none = std::numeric_limits<std::uint64_t>::max();
    const std::uint64_t type = whole(accessor, "componentType", 0), at = whole(accessor, "bufferView", none);
    if (at == none) return;  // compressed: the reader's own affair
    const std::uint64_t size = type == bytes ? 1 : type == shorts ? 2 : type == longs ? 4 : 0;
    if (size == 0) refuse("its faces are not numbered by whole numbers");
    const Json& view = entry("bufferViews", at);
    const std::uint64_t begin = whole(view, "byteOffset", 0), inside = whole(accessor, "byteOffset", 0);
    if (begin > buffer_.size() || inside > buffer_.size() - begin || count > (buffer_.size() - begin - inside) / size)
      refuse("it is truncated: it has fewer bytes than its faces need");
    for (std::uint64_t k = 0; k < count; ++k) {
      std::uint32_t index = 0;
      std::memcpy(&index, buffer_.data() + begin + inside + k * size, size);
      if (index >= vertices) refuse("a face names vertex " + std::to_string(index) + " of " + std::to_string(vertices));
    }
  }

  /// The numbers of a node's key; none if it has none.
  static std::vector<double> numbers(const Json& node, const char* name, std::size_t count) {
    std::vector<double> values;
    if (!node.contains(name)) return values;
    for (const Json& value : list(node, name))
      if (value.is_number() && is_coordinate(value.get<double>())) values.push_back(value.get<double>());
    if (values.size() != count || list(node, name).size() != count)
      refuse(std::string("a node's ") + name + " needs " + std::to_string(count) + " numbers below 1e15");
    return values;
  }

  static void check_placing(const Json& node) {
    if (!node.is_object()) refuse("a node is no table");
    numbers(node, "translation", 3);
    numbers(node, "rotation", 4);
    for (const double s : numbers(node, "scale", 3))
      if (s == 0) refuse("a node scales by 0, which leaves no body");
    const std::vector<double> m = numbers(node, "matrix", 16);  // column by column
    if (m.empty()) return;
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
      refuse("a node's matrix is no placing: its last row is not 0 0 0 1");
    const double volume =
        m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) + m[8] * (m[1] * m[6] - m[2] * m[5]);
    if (volume == 0) refuse("a node's matrix flattens its mesh");
  }

  Json root_;
  std::string_view buffer_;
};

}  // namespace

FacesInFile check_obj(std::string& text) {
  for (std::size_t at = text.find('\\'); at != std::string::npos; at = text.find('\\', at + 1))
    if (text.compare(at, 2, "\\\n") == 0) text.replace(at, 2, "  ");  // a continued line
  ObjCheck check;
  std::string_view rest = text;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::string_view whole = next_line(rest);
    if (whole.find('\0') != std::string_view::npos) refuse(line, "it is not text, so not an OBJ file");
    std::string_view copy = whole;
    const std::string_view word = next_word(copy);
    if (word == "mtllib" || word == "usemtl") text[static_cast<std::size_t>(word.data() - text.data())] = '#';
    check.line(line, whole);
  }
  return check.result();
}

FacesInFile check_stl(const std::string& bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= stl_header) std::memcpy(&count, bytes.data() + stl_header - sizeof count, sizeof count);
  const std::size_t promised = stl_header + stl_triangle * static_cast<std::size_t>(count);
  if (bytes.size() < stl_header || bytes.size() != promised) {
    std::string_view begin = bytes;
    if (next_word(begin, " \t\r\n") == "solid" && bytes.find('\0') == std::string::npos) return check_text_stl(bytes);
    if (bytes.size() < stl_header)
      refuse("it is not an STL file: it has only " + std::to_string(bytes.size()) + " bytes");
    refuse("it is truncated or not an STL file: for the " + std::to_string(count) +
           " triangles that it promises it needs " + std::to_string(promised) + " bytes and has " +
           std::to_string(bytes.size()));
  }
  if (count == 0) refuse("it has no triangles");
  return {count, true};
}

FacesInFile check_ply(const std::string& bytes) {
  std::string_view rest = bytes;
  const PlyHeader header = ply_header(rest);
  const auto vertices = std::find_if(header.elements.begin(), header.elements.end(),
                                     [](const PlyElement& element) { return element.name == "vertex"; });
  if (vertices == header.elements.end()) refuse("it has no vertices");
  PlyBody body(header, rest);
  PlyCheck check(vertices->count);
  for (const PlyElement& element : header.elements) {
    if (element.properties.empty()) continue;
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) check.property(element, property, body);
  }
  if (check.found.faces == 0) refuse("it has no faces");
  return check.found;
}

FacesInFile check_glb(const std::string& bytes) {
  constexpr std::uint32_t magic = 0x46546C67, json = 0x4E4F534A;  // "glTF", "JSON"
  std::array<std::uint32_t, 5> head{};                            // magic, version, length; length and type of a chunk
  if (bytes.size() < sizeof head)
    refuse("it is not a binary glTF file: it has only " + std::to_string(bytes.size()) + " bytes");
  std::memcpy(head.data(), bytes.data(), sizeof head);
  if (head[0] != magic) refuse("it is not a binary glTF file (it does not begin with `glTF`)");
  if (head[1] != 2) refuse("it has glTF version " + std::to_string(head[1]) + "; only version 2 is read");
  if (head[2] != bytes.size())
    refuse("it is truncated: it promises " + std::to_string(head[2]) + " bytes and has " +
           std::to_string(bytes.size()));
  if (head[4] != json || head[3] > bytes.size() - sizeof head) refuse("it does not begin with a JSON chunk");
  const std::string_view text = std::string_view(bytes).substr(sizeof head, head[3]);
  if (text.find("\"uri\"") != std::string_view::npos) refuse("it refers to other files: export it as one .glb");
  constexpr std::size_t chunk_head = 8;
  std::string_view rest = std::string_view(bytes).substr(sizeof head + head[3]);
  rest.remove_prefix(std::min(chunk_head, rest.size()));
  GlbCheck(text, rest).run();
  return {1, false};
}

}  // namespace molten
