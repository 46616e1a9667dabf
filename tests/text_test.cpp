// Text as a shape: letters are closed, with their holes, as large as asked; bad fonts end in one clear line.
#include "io/geometry/text.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/boundary/polygon.h"
#include "core/boundary/shapes.h"
#include "core/error.h"
#include "core/features.h"
#include "io/geometry/assemble.h"
#include "io/geometry/mesh_file.h"
#include "io/scene/scene_file.h"
#include "tests/temp_folder.h"

namespace molten::text_test {
namespace {

Shape letters(const std::string& string, const std::string& font = "DejaVuSans-Bold.ttf") {
  Shape shape;
  shape.text = Text{string, font, 0.2, 0.05, {}, {}};
  shape.place = {"s.toml", 3, 8};
  return shape;
}

TriangleMesh mesh_of(const std::string& string) { return extrude_text(Scene{}, letters(string)); }

/// V − E + F of a closed mesh: 2 a part without holes, 2 less for every hole through it.
int euler(const TriangleMesh& mesh) {
  return static_cast<int>(mesh.vertices.size()) - static_cast<int>(mesh.triangles.size()) / 2;
}

std::string refusal(const Shape& shape) {
  try {
    extrude_text(Scene{}, shape);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::geometry);
    const std::string what = error.what();
    EXPECT_EQ(what.rfind("s.toml:3:8: text: ", 0), 0u) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    return what;
  }
  return "";
}

TEST(Text, LettersAreClosedAndHaveTheirHoles) {
  const std::pair<const char*, int> cases[] = {{"C", 2},  {"F", 2}, {"0", 0},         {"8", -2},
                                               {"B", -2}, {"i", 4}, {"CGF 2007", 10}, {"Öé", 6}};
  for (const auto& [string, characteristic] : cases) {
    const TriangleMesh mesh = mesh_of(string);
    EXPECT_NO_THROW(require_closed(mesh, string));
    EXPECT_EQ(euler(mesh), characteristic) << string;
  }
}

TEST(Text, IsAsLargeAsAsked) {
  const TriangleMesh mesh = mesh_of("CGF 2007");
  Eigen::AlignedBox3d box;
  for (const Vec3& v : mesh.vertices) box.extend(v);
  EXPECT_NEAR(box.sizes().z(), 0.2, 1e-12);
  EXPECT_NEAR(box.sizes().y(), 0.05, 1e-12);
  EXPECT_GT(box.sizes().x(), 0.8);  // eight of them side by side
}

TEST(Text, CapsHaveTheAreaOfTheRings) {
  const std::vector<std::vector<Vec2>> rings = {
      {{0, 0}, {6, 0}, {6, 4}, {0, 4}}, {{1, 1}, {1, 2}, {2, 2}, {2, 1}}, {{3, 1}, {3, 3}, {5, 3}, {5, 1}}};
  double twice = 0;
  for (const auto& ring : rings) twice += twice_area(ring);
  const auto corner = [&](std::size_t k) { return rings[k / 4][k % 4]; };  // four to a ring
  double covered = 0;
  const auto triangles = clip_ears(rings);
  EXPECT_EQ(triangles.size(), 14u);  // 12 corners and twice two bridges, less 2
  for (const auto& t : triangles) {
    const double part = twice_area({corner(t[0]), corner(t[1]), corner(t[2])});
    EXPECT_GE(part, 0);
    covered += part;
  }
  EXPECT_NEAR(covered, twice, 1e-12);
  EXPECT_NEAR(signed_volume(extrude(rings, 0, 2)), twice, 1e-12);
}

TEST(Text, TheLettersSceneHasItsParticles) {
  const Scene scene = read_scene(MOLTEN_SOURCE_DIR "/scenes/letters.toml");
  const Start start = fill_bodies(scene, features_of(scene));
  EXPECT_NEAR(static_cast<double>(start.position.size()), 10773, 107);
  double lowest = 1, highest = 0;
  for (const auto& x : start.position) lowest = std::min(lowest, x[2]), highest = std::max(highest, x[2]);
  EXPECT_GT(lowest, 0);
  EXPECT_NEAR(highest, 0.15, 0.01);
}

TEST(Text, BadFontsEndInOneLine) {
  const TempFolder folder;
  write_bytes(folder.path() / "no.ttf", "this is no font");
  EXPECT_NE(refusal(letters("A", (folder.path() / "no.ttf").string())).find("no font that can be read"),
            std::string::npos);
  EXPECT_NE(refusal(letters("A", (folder.path() / "gone.ttf").string())).find("check the path"), std::string::npos);
  EXPECT_NE(refusal(letters("A", "NoSuchFont.ttf")).find("scripts/setup"), std::string::npos);
  EXPECT_NE(refusal(letters("\xF3\xB0\x80\x80")).find("U+F0000"), std::string::npos);
  EXPECT_NE(refusal(letters("  ")).find("no outline"), std::string::npos);
}

}  // namespace
}  // namespace molten::text_test
