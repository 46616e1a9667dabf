#include "io/picture/font.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace molten {
namespace {

constexpr int glyph_width = 5, glyph_height = 7, pitch = 6;
constexpr float letter_gap = 1.2f, space_width = 4;   // in cells
constexpr std::string_view descending = "gpqyµρη,;";  // drawn two rows lower

// The characters of a sheet stand side by side, one column apart.
struct Sheet {
  std::string_view characters;
  std::string_view rows[glyph_height];
};

// clang-format off
constexpr Sheet sheets[] = {
    {" !\"#$%&'()*+,-./",
     {"..... ..#.. .#.#. .#.#. ..#.. ##... .##.. ..#.. ...#. .#... ..... ..... ..... ..... ..... ....#",
      "..... ..#.. .#.#. .#.#. .#### ##..# #..#. ..#.. ..#.. ..#.. ..#.. ..#.. ..... ..... ..... ....#",
      "..... ..#.. .#.#. ##### #.#.. ...#. #.#.. ..#.. .#... ...#. #.#.# ..#.. ..... ..... ..... ...#.",
      "..... ..#.. ..... .#.#. .###. ..#.. .#... ..... .#... ...#. .###. ##### ..... ##### ..... ..#..",
      "..... ..#.. ..... ##### ..#.# .#... #.#.# ..... .#... ...#. #.#.# ..#.. ..#.. ..... ..... .#...",
      "..... ..... ..... .#.#. ####. #..## #..#. ..... ..#.. ..#.. ..#.. ..#.. ..#.. ..... ..... #....",
      "..... ..#.. ..... .#.#. ..#.. ...## .##.# ..... ...#. .#... ..... ..... .#... ..... ..#.. #...."}},
    {"0123456789:;<=>?",
     {".###. ..#.. .###. ##### ...#. ##### ..##. ##### .###. .###. ..... ..... ....# ..... #.... .###.",
      "#...# .##.. #...# ...#. ..##. #.... .#... ....# #...# #...# ..... ..#.. ...#. ..... .#... #...#",
      "#...# ..#.. ....# ..#.. .#.#. ####. #.... ...#. #...# #...# ..#.. ..... ..#.. ##### ..#.. ....#",
      "#...# ..#.. ...#. ...#. #..#. ....# ####. ..#.. .###. .#### ..... ..... .#... ..... ...#. ...#.",
      "#...# ..#.. ..#.. ....# ##### ....# #...# .#... #...# ....# ..... ..#.. ..#.. ##### ..#.. ..#..",
      "#...# ..#.. .#... #...# ...#. #...# #...# .#... #...# ...#. ..#.. ..#.. ...#. ..... .#... .....",
      ".###. .###. ##### .###. ...#. .###. .###. .#... .###. .##.. ..... .#... ....# ..... #.... ..#.."}},
    {"@ABCDEFGHIJKLMNO",
     {".###. ..#.. ####. .###. ####. ##### ##### .###. #...# .###. ..### #...# #.... #...# #...# .###.",
      "#...# .#.#. #...# #...# #...# #.... #.... #...# #...# ..#.. ...#. #..#. #.... ##.## ##..# #...#",
      "#.### #...# #...# #.... #...# #.... #.... #.... #...# ..#.. ...#. #.#.. #.... #.#.# #.#.# #...#",
      "#.#.# #...# ####. #.... #...# ####. ####. #.### ##### ..#.. ...#. ##... #.... #...# #..## #...#",
      "#.### ##### #...# #.... #...# #.... #.... #...# #...# ..#.. ...#. #.#.. #.... #...# #...# #...#",
      "#.... #...# #...# #...# #...# #.... #.... #...# #...# ..#.. #..#. #..#. #.... #...# #...# #...#",
      ".###. #...# ####. .###. ####. ##### #.... .###. #...# .###. .##.. #...# ##### #...# #...# .###."}},
    {"PQRSTUVWXYZ[\\]^_",
     {"####. .###. ####. .#### ##### #...# #...# #...# #...# #...# ##### .###. #.... .###. ..#.. .....",
      "#...# #...# #...# #.... ..#.. #...# #...# #...# #...# #...# ....# .#... #.... ...#. .#.#. .....",
      "#...# #...# #...# #.... ..#.. #...# #...# #...# .#.#. .#.#. ...#. .#... .#... ...#. #...# .....",
      "####. #...# ####. .###. ..#.. #...# #...# #...# ..#.. ..#.. ..#.. .#... ..#.. ...#. ..... .....",
      "#.... #.#.# #.#.. ....# ..#.. #...# #...# #.#.# .#.#. ..#.. .#... .#... ...#. ...#. ..... .....",
      "#.... #..#. #..#. ....# ..#.. #...# .#.#. ##.## #...# ..#.. #.... .#... ....# ...#. ..... .....",
      "#.... .##.# #...# ####. ..#.. .###. ..#.. #...# #...# ..#.. ##### .###. ....# .###. ..... #####"}},
    {"`abcdefghijklmno",
     {".#... ..... #.... ..... ....# ..... ..##. .#### #.... ..#.. ...#. #.... .##.. ..... ..... .....",
      "..#.. ..... #.... ..... ....# ..... .#... #...# #.... ..... ..... #.... ..#.. ..... ..... .....",
      "..... .###. ####. .#### .#### .###. ####. #...# ####. .##.. ..##. #..#. ..#.. ##.#. ####. .###.",
      "..... ....# #...# #.... #...# #...# .#... #...# #...# ..#.. ...#. #.#.. ..#.. #.#.# #...# #...#",
      "..... .#### #...# #.... #...# ##### .#... .#### #...# ..#.. ...#. ##... ..#.. #.#.# #...# #...#",
      "..... #...# #...# #.... #...# #.... .#... ....# #...# ..#.. ...#. #.#.. ..#.. #.#.# #...# #...#",
      "..... .#### ####. .#### .#### .###. .#... .###. #...# .###. .##.. #..#. .###. #.#.# #...# .###."}},
    {"pqrstuvwxyz{|}~°",
     {"####. .#### ..... ..... .#... ..... ..... ..... ..... #...# ..... ...#. ..#.. .#... ..... .##..",
      "#...# #...# ..... ..... .#... ..... ..... ..... ..... #...# ..... ..#.. ..#.. ..#.. ..... #..#.",
      "#...# #...# #.##. .#### ####. #...# #...# #...# #...# #...# ##### ..#.. ..#.. ..#.. .#... #..#.",
      "#...# #...# ##... #.... .#... #...# #...# #.#.# .#.#. #...# ...#. .#... ..#.. ...#. #.#.# .##..",
      "####. .#### #.... .###. .#... #...# #...# #.#.# ..#.. .#### ..#.. ..#.. ..#.. ..#.. ...#. .....",
      "#.... ....# #.... ....# .#... #...# .#.#. #.#.# .#.#. ....# .#... ..#.. ..#.. ..#.. ..... .....",
      "#.... ....# #.... ####. ..##. .#### ..#.. .#.#. #...# .###. ##### ...#. ..#.. .#... ..... ....."}},
    {"²³·µ⁻¹−×ρησΔ…ö",
     {".##.. ###.. ..... #...# ..... .#... ..... ..... ..##. #.##. ..... ..#.. ..... .#.#.",
      "#..#. ...#. ..... #...# ..... ##... ..... ..... .#..# ##..# ..... ..#.. ..... .....",
      "..#.. .##.. ..... #...# ###.. .#... ..... #...# .#..# #...# .#### .#.#. ..... .###.",
      ".#... ...#. ..#.. #...# ..... .#... ##### .#.#. .#..# #...# #..#. .#.#. ..... #...#",
      "####. ###.. ..... ####. ..... ###.. ..... ..#.. ####. #...# #...# #...# ..... #...#",
      "..... ..... ..... #.... ..... ..... ..... .#.#. #.... ....# #...# #...# ..... #...#",
      "..... ..... ..... #.... ..... ..... ..... #...# #.... ....# .###. ##### #.#.# .###."}},
};
// clang-format on

struct Stroke {
  float x0, y0, x1, y1;  // in cells of the glyph, row 0 at the top
};
using Strokes = std::vector<Stroke>;

struct Glyph {
  Strokes strokes;
  float left = 0, advance = pitch;  // in cells
};
using Glyphs = std::unordered_map<std::string_view, Glyph>;

std::size_t bytes_of_character(char first) {
  const auto byte = static_cast<unsigned char>(first);
  return byte < 0x80 ? 1 : byte < 0xE0 ? 2 : byte < 0xF0 ? 3 : 4;
}

// One UTF-8 character after the other.
template <class Use> void for_each_character(std::string_view text, Use use) {
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view character = text.substr(at, bytes_of_character(text[at]));
    use(character);
    at += character.size();
  }
}

// Neighbouring dots are joined, so that the letters come out as smooth lines at any size and not as blocks.
Strokes join_dots(const Sheet& sheet, int place, float lower) {
  const auto dot = [&](int x, int y) {
    return x >= 0 && x < glyph_width && y < glyph_height && sheet.rows[y][place * pitch + x] == '#';
  };
  Strokes strokes;
  for (int y = 0; y < glyph_height; ++y)
    for (int x = 0; x < glyph_width; ++x) {
      if (!dot(x, y)) continue;
      const auto join = [&](int to_x, int to_y) {
        strokes.push_back({static_cast<float>(x), y + lower, static_cast<float>(to_x), to_y + lower});
      };
      join(x, y);
      if (dot(x + 1, y)) join(x + 1, y);
      if (dot(x, y + 1)) join(x, y + 1);
      if (dot(x + 1, y + 1) && !dot(x + 1, y) && !dot(x, y + 1)) join(x + 1, y + 1);
      if (dot(x - 1, y + 1) && !dot(x - 1, y) && !dot(x, y + 1)) join(x - 1, y + 1);
    }
  return strokes;
}

// Narrow letters stand closer; digits don't, so that a running clock keeps its width.
Glyph spaced(Strokes strokes, bool fixed_width) {
  Glyph glyph{std::move(strokes)};
  if (glyph.strokes.empty()) return glyph.advance = space_width, glyph;
  if (fixed_width) return glyph;
  float left = glyph_width, right = 0;
  for (const Stroke& stroke : glyph.strokes) {
    left = std::min({left, stroke.x0, stroke.x1});
    right = std::max({right, stroke.x0, stroke.x1});
  }
  glyph.left = left;
  glyph.advance = right - left + 1 + letter_gap;
  return glyph;
}

Glyphs make_glyphs() {
  Glyphs glyphs;
  for (const Sheet& sheet : sheets) {
    int place = 0;
    for_each_character(sheet.characters, [&](std::string_view character) {
      const bool lower = descending.find(character) != std::string_view::npos;
      const bool digit = character[0] >= '0' && character[0] <= '9';
      glyphs[character] = spaced(join_dots(sheet, place++, lower ? 2.0f : 0.0f), digit);
    });
  }
  return glyphs;
}

const Glyph& glyph_of(std::string_view character) {
  static const Glyphs glyphs = make_glyphs();
  const auto known = glyphs.find(character);
  return (known != glyphs.end() ? known : glyphs.find("?"))->second;
}

float distance(const Stroke& s, float x, float y) {
  const float dx = s.x1 - s.x0, dy = s.y1 - s.y0, length2 = dx * dx + dy * dy;
  const float along = length2 > 0 ? std::clamp(((x - s.x0) * dx + (y - s.y0) * dy) / length2, 0.0f, 1.0f) : 0.0f;
  return std::hypot(x - s.x0 - along * dx, y - s.y0 - along * dy);
}

float distance(const Strokes& strokes, float x, float y) {
  float nearest = 1e9f;
  for (const Stroke& stroke : strokes) nearest = std::min(nearest, distance(stroke, x, y));
  return nearest;
}

void draw_glyph(Picture& picture, const Strokes& strokes, float left, float top, float size, Rgb colour) {
  const float thickness = 0.52f;  // half a stroke's width, in cells
  const int reach_x = static_cast<int>(size * pitch), reach_y = static_cast<int>(size * (glyph_height + 3));
  const int x0 = static_cast<int>(left), y0 = static_cast<int>(top);
  for (int y = y0 - 1; y <= y0 + reach_y; ++y)
    for (int x = x0 - 1; x <= x0 + reach_x; ++x) {
      const float cell_x = (x + 0.5f - left) / size - 0.5f, cell_y = (y + 0.5f - top) / size - 0.5f;
      const float cover = (thickness - distance(strokes, cell_x, cell_y)) * size + 0.5f;
      if (cover > 0) blend(picture, x, y, colour, std::min(cover, 1.0f));
    }
}

}  // namespace

float text_width(std::string_view text, float size) {
  float cells = 0;
  for_each_character(text, [&](std::string_view character) { cells += glyph_of(character).advance; });
  return size * std::max(cells - letter_gap, 0.0f);
}

float text_height(float size) { return size * glyph_height; }

void draw_text(Picture& picture, std::string_view text, float left, float top, float size, Rgb colour) {
  for_each_character(text, [&](std::string_view character) {
    const Glyph& glyph = glyph_of(character);
    if (!glyph.strokes.empty()) draw_glyph(picture, glyph.strokes, left - size * glyph.left, top, size, colour);
    left += size * glyph.advance;
  });
}

}  // namespace molten
