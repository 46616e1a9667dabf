#include "io/geometry/text.h"

#include <fmt/format.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <type_traits>

#include "core/boundary/polygon.h"
#include "core/boundary/shapes.h"
#include "core/error.h"
#include "io/geometry/mesh_file.h"
#include "io/scene/scene_file.h"

namespace molten {
namespace {

namespace fs = std::filesystem;
using Ring = std::vector<Vec2>;
using Library = std::unique_ptr<std::remove_pointer_t<FT_Library>, decltype(&FT_Done_FreeType)>;
using Face = std::unique_ptr<std::remove_pointer_t<FT_Face>, decltype(&FT_Done_Face)>;

constexpr const char* system_fonts = "/usr/share/fonts";

[[noreturn]] void refuse(const Place& place, const std::string& what) {
  throw Error(ExitCode::geometry, fmt::format("{}: text: {}", text_of(place), what));
}

// ---- one letter's outline, in the font's units --------------------------------------------------------------------

Vec2 point(const FT_Vector* v) { return {static_cast<double>(v->x), static_cast<double>(v->y)}; }

/// Takes FreeType's walk round a letter; curves become chords that leave them by a thousandth of the em at most.
struct Pen {
  std::vector<Ring> rings;
  double tolerance = 1;

  Ring& ring() { return rings.back(); }
  /// A Bézier curve of the second or third degree, which bends by no more than `bend`, its largest second difference.
  template <class Curve> void draw(double degree, double bend, const Curve& curve) {
    const double pieces = std::ceil(std::sqrt(degree * (degree - 1) * bend / (8 * tolerance)));
    for (double k = 1; k < pieces; ++k) ring().push_back(curve(k / pieces));
    ring().push_back(curve(1.0));
  }
};

int move_to(const FT_Vector* to, void* pen) {
  static_cast<Pen*>(pen)->rings.push_back({point(to)});
  return 0;
}

int line_to(const FT_Vector* to, void* pen) {
  static_cast<Pen*>(pen)->ring().push_back(point(to));
  return 0;
}

int conic_to(const FT_Vector* middle, const FT_Vector* to, void* pen) {
  Pen& p = *static_cast<Pen*>(pen);
  const Vec2 a = p.ring().back(), b = point(middle), c = point(to);
  p.draw(2, (a - 2 * b + c).norm(),
         [&](double t) -> Vec2 { return (1 - t) * (1 - t) * a + 2 * t * (1 - t) * b + t * t * c; });
  return 0;
}

int cubic_to(const FT_Vector* first, const FT_Vector* second, const FT_Vector* to, void* pen) {
  Pen& p = *static_cast<Pen*>(pen);
  const Vec2 a = p.ring().back(), b = point(first), c = point(second), d = point(to);
  p.draw(3, std::max((a - 2 * b + c).norm(), (b - 2 * c + d).norm()), [&](double t) -> Vec2 {
    const double s = 1 - t;
    return s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d;
  });
  return 0;
}

/// Without points that repeat the one before; rings that enclose nothing go.
void tidy(std::vector<Ring>& rings) {
  for (Ring& ring : rings) {
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  }
  std::erase_if(rings, [](const Ring& ring) { return ring.size() < 3 || twice_area(ring) == 0; });
}

// ---- a letter's solid parts ---------------------------------------------------------------------------------------

/// Each outline with the holes in it, whichever way the font walks them: a ring within an even number of others is an
/// outline, one within an odd number a hole of the innermost outline round it.
std::vector<std::vector<Ring>> sort_rings(std::vector<Ring> rings) {
  const auto depth = [&](const Ring& inner) {
    return std::count_if(rings.begin(), rings.end(),
                         [&](const Ring& r) { return &r != &inner && goes_round(r, inner[0]); });
  };
  std::vector<long> depths;
  for (const Ring& ring : rings) depths.push_back(depth(ring));
  std::vector<std::vector<Ring>> parts;
  for (std::size_t k = 0; k < rings.size(); ++k) {
    if (depths[k] % 2 == 1) continue;
    parts.push_back({rings[k]});
    for (std::size_t h = 0; h < rings.size(); ++h)
      if (depths[h] == depths[k] + 1 && goes_round(rings[k], rings[h][0])) parts.back().push_back(rings[h]);
    for (Ring& ring : parts.back())
      if ((twice_area(ring) > 0) != (&ring == &parts.back()[0])) std::reverse(ring.begin(), ring.end());
  }
  return parts;
}

bool is_sound(const std::vector<Ring>& rings) {
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (!polygon_defect(rings[i]).empty()) return false;
    for (std::size_t j = 0; j < i; ++j)
      if (rings_touch(rings[i], rings[j])) return false;
  }
  return true;
}

// ---- the text -----------------------------------------------------------------------------------------------------

/// The characters of a string that is known to be valid UTF-8.
std::u32string characters(const std::string& utf8) {
  std::u32string all;
  for (const char c : utf8) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80U)
      all.push_back(byte);
    else if (byte < 0xC0U)
      all.back() = all.back() << 6U | (byte & 0x3FU);
    else
      all.push_back(byte & (byte < 0xE0U ? 0x1FU : byte < 0xF0U ? 0x0FU : 0x07U));
  }
  return all;
}

Face open(const Library& library, const fs::path& file, const Place& place) {
  FT_Face face = nullptr;
  if (FT_New_Face(library.get(), file.c_str(), 0, &face) != 0)
    refuse(place, fmt::format("{} is no font that can be read; give a TrueType or OpenType file", file.string()));
  Face opened(face, FT_Done_Face);
  if (!FT_IS_SCALABLE(face))
    refuse(place, fmt::format("{} has no outlines; give a TrueType or OpenType file", file.string()));
  return opened;
}

std::vector<Ring> outline_of(FT_Face face, FT_UInt glyph) {
  Pen pen{{}, face->units_per_EM / 1000.0};
  const FT_Outline_Funcs walk{move_to, line_to, conic_to, cubic_to, 0, 0};
  if (FT_Load_Glyph(face, glyph, FT_LOAD_NO_SCALE) != 0 || face->glyph->format != FT_GLYPH_FORMAT_OUTLINE) return {};
  if (FT_Outline_Decompose(&face->glyph->outline, &walk, &pen) != 0) return {};
  tidy(pen.rings);
  return pen.rings;
}

/// The letters' solid parts side by side, in the font's units.
std::vector<std::vector<Ring>> set_in_type(FT_Face face, const Text& text, const Place& place) {
  std::vector<std::vector<Ring>> all;
  double x = 0;
  FT_UInt before = 0;
  for (const char32_t c : characters(text.string)) {
    const FT_UInt glyph = FT_Get_Char_Index(face, c);
    if (glyph == 0) refuse(place, fmt::format("the font has no letter U+{:04X}; take another font", std::uint32_t(c)));
    std::vector<Ring> rings = outline_of(face, glyph);
    if (!is_sound(rings))
      refuse(place, fmt::format("the outline of U+{:04X} crosses itself; take another font", std::uint32_t(c)));
    FT_Vector kerning{};
    if (before != 0 && FT_Get_Kerning(face, before, glyph, FT_KERNING_UNSCALED, &kerning) == 0)
      x += static_cast<double>(kerning.x);
    for (Ring& ring : rings)
      for (Vec2& p : ring) p.x() += x;
    for (auto& part : sort_rings(std::move(rings))) all.push_back(std::move(part));
    x += static_cast<double>(face->glyph->advance.x);
    before = glyph;
  }
  if (all.empty()) refuse(place, "its letters have no outline; give others than blanks");
  return all;
}

void append(TriangleMesh& all, const TriangleMesh& part) {
  const auto first = static_cast<std::int32_t>(all.vertices.size());
  all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& t : part.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

}  // namespace

fs::path find_font(const Scene& scene, const Text& text, const Place& place) {
  const fs::path asked = locate(scene, text.font), name = asked.filename();
  std::error_code error;
  if (fs::is_regular_file(asked, error)) return asked;
  if (fs::path(text.font).has_parent_path())
    refuse(place, fmt::format("no font file {}; check the path", asked.string()));
  std::vector<fs::path> found;
  fs::recursive_directory_iterator at(system_fonts, fs::directory_options::skip_permission_denied, error);
  for (; !error && at != fs::recursive_directory_iterator(); at.increment(error))
    if (at->path().filename() == name) found.push_back(at->path());
  if (found.empty())
    refuse(place, fmt::format("no font {} beside the scene or in {}; run scripts/setup, which installs DejaVu's",
                              text.font, system_fonts));
  return *std::min_element(found.begin(), found.end());
}

TriangleMesh extrude_text(const Scene& scene, const Shape& shape) {
  const Text& text = *shape.text;
  FT_Library started = nullptr;
  if (FT_Init_FreeType(&started) != 0) refuse(shape.place, "FreeType does not start; install it again");
  const Library library(started, FT_Done_FreeType);
  const Face face = open(library, find_font(scene, text, shape.place), shape.place);
  const std::vector<std::vector<Ring>> parts = set_in_type(face.get(), text, shape.place);

  Eigen::AlignedBox2d box;
  for (const auto& part : parts)
    for (const Vec2& p : part[0]) box.extend(p);
  const double scale = text.height / box.sizes().y();
  TriangleMesh mesh;
  for (std::vector<Ring> part : parts) {
    for (Ring& ring : part)
      for (Vec2& p : ring) p *= scale;
    append(mesh, extrude(part, -text.depth / 2, text.depth / 2));
  }
  for (Vec3& v : mesh.vertices) v = Vec3(v.x(), -v.z(), v.y());
  require_closed(mesh, text_of(shape.place) + ": text");
  return mesh;
}

}  // namespace molten
