// Height grids: both formats, their orientation, and refusals that name the place.
#include "io/geometry/terrain.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/error.h"
#include "tests/temp_folder.h"

namespace molten::terrain_test {
namespace {

const std::string header = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\nNODATA_value -9999\n";

class TerrainTest : public testing::Test {
 protected:
  HeightGrid read(const std::string& name, const std::string& text, const Terrain& terrain = {}) {
    write_bytes(folder_.path() / name, text);
    return read_terrain(terrain, folder_.path() / name);
  }

  std::string refusal(const std::string& name, const std::string& text, const Terrain& terrain = {}) {
    try {
      read(name, text, terrain);
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_EQ(error.code(), ExitCode::geometry);
      EXPECT_EQ(what.find('\n'), std::string::npos);
      EXPECT_NE(what.find(name), std::string::npos) << what;
      return what;
    }
    return "";
  }

  TempFolder folder_;
};

void expect_same(const HeightGrid& grid) {
  ASSERT_EQ(grid.columns, 3);
  ASSERT_EQ(grid.rows, 2);
  EXPECT_EQ(grid.cell_size, 10);
  EXPECT_EQ(grid.at(0, 1), 1);  // the file's first row is the northern one
  EXPECT_EQ(grid.at(2, 1), 3);
  EXPECT_EQ(grid.at(0, 0), 4);
  EXPECT_EQ(grid.at(2, 0), 6.5);
}

TEST_F(TerrainTest, ReadsAscii) {
  const HeightGrid grid = read("a.asc", header + "1 2 3\n4 5 6.5\n");
  expect_same(grid);
  EXPECT_EQ(grid.origin, Vec2(105, 205));  // the middle of the corner cell
  const HeightGrid center =
      read("b.ASC", "NCOLS 3\r\nNROWS 2\r\nXLLCENTER 100\r\nYLLCENTER 200\r\nCELLSIZE 10\r\n\r\n1 2 3\r\n4 5 +6.5\r\n");
  expect_same(center);
  EXPECT_EQ(center.origin, Vec2(100, 200));
  EXPECT_EQ(read("c.asc", "ncols 3\nnrows 2\ncellsize 10\n1 2 3\n4 5 6.5\n").origin, Vec2(0, 0));
}

TEST_F(TerrainTest, ReadsJson) {
  Terrain terrain;
  terrain.cell_size = 10;
  expect_same(read("a.json", R"({"width": 3, "height": 2, "values": [1, 2, 3, 4, 5, 6.5]})", terrain));
  expect_same(read("b.json", R"({"width": 3, "height": 2, "cell_size": 10, "values": [1, 2, 3, 4, 5, 6.5]})"));
}

TEST_F(TerrainTest, SceneScalesAndPlaces) {
  Terrain terrain;
  terrain.scale = 0.5;
  terrain.cell_size = 2;
  terrain.origin = std::array{-7.0, 8.0};
  const HeightGrid grid = read("a.asc", header + "1 2 3\n4 5 6.5\n", terrain);
  EXPECT_EQ(grid.at(2, 0), 3.25);
  EXPECT_EQ(grid.cell_size, 2);
  EXPECT_EQ(grid.origin, Vec2(-7, 8));
}

TEST_F(TerrainTest, RefusesBadAscii) {
  const std::string ragged = refusal("a.asc", header + "1 2 3\n4 5\n");
  EXPECT_NE(ragged.find("a.asc:8: the row has 2 heights, but ncols is 3"), std::string::npos) << ragged;
  EXPECT_NE(refusal("a.asc", header + "1 2 3 4\n4 5 6\n").find(":7:"), std::string::npos);
  EXPECT_NE(refusal("a.asc", header + "1 2 3\n").find("1 of 2 rows"), std::string::npos);
  EXPECT_NE(refusal("a.asc", header + "1 2 3\n4 5 6\n7 8 9\n"), "");
  EXPECT_NE(refusal("a.asc", header + "1 2 3\n4 -9999 6\n").find("NODATA"), std::string::npos);
  EXPECT_NE(refusal("a.asc", header + "nan 2 3\n4 5 6\n"), "");
  EXPECT_NE(refusal("a.asc", header + "1 2 3\n4 inf 6\n"), "");
  EXPECT_NE(refusal("a.asc", header + "1 2 3\n4 x 6\n"), "");
  EXPECT_NE(refusal("a.asc", "1 2 3\n4 5 6\n").find("header lacks"), std::string::npos);
  EXPECT_NE(refusal("a.asc", "ncols 3\nnrows 2\n1 2 3\n4 5 6\n").find("cellsize"), std::string::npos);
  EXPECT_NE(refusal("a.asc", "ncols 1\nnrows 2\ncellsize 1\n1\n2\n"), "");
  EXPECT_NE(refusal("a.asc", "ncols 1e9\nnrows 1e9\ncellsize 1\n1\n2\n"), "");
  EXPECT_NE(refusal("a.asc", "ncols 1e300\nnrows 1e300\ncellsize 1\n"), "");
  EXPECT_NE(refusal("a.asc", "ncols -3\nnrows 2.5\ncellsize 1\n1 2 3\n"), "");
  EXPECT_NE(refusal("a.asc", "ncols 3\nnrows 2\ncellsize 0\n1 2 3\n4 5 6\n"), "");
  EXPECT_NE(refusal("a.asc", std::string("\0\xff garbage\n", 11)), "");
  EXPECT_NE(refusal("a.asc", ""), "");
}

TEST_F(TerrainTest, RefusesBadJson) {
  EXPECT_NE(refusal("a.json", R"({"width": 3, "height": 2, "values": [1, 2, 3, 4, 5, 6]})").find("cell_size"),
            std::string::npos);
  Terrain terrain;
  terrain.cell_size = 10;
  for (const char* text :
       {"", "{", "[1, 2]", "{}", R"({"width": 3})", R"({"width": "3", "height": 2, "values": []})",
        R"({"width": 3, "height": 2, "values": [1, 2, 3, 4, 5]})",
        R"({"width": 3, "height": 2, "values": [1, 2, 3, null, 5, 6]})",
        R"({"width": 3, "height": 2, "values": [1, 2, 3, NaN, 5, 6]})",
        R"({"width": 3, "height": 2, "values": [1, 2, 3, "x", 5, 6]})",
        R"({"width": 1e300, "height": 1e300, "values": [1]})", R"({"width": 1, "height": 2, "values": [1, 2]})",
        R"({"width": 2.5, "height": 2, "values": [1, 2, 3, 4, 5]})"})
    EXPECT_NE(refusal("a.json", text, terrain), "") << text;
  EXPECT_NE(refusal("a.json", std::string(100000, '['), terrain), "");
  EXPECT_NE(refusal("a.tif", "II*", terrain), "");
}

TEST_F(TerrainTest, MissingFilesAreRefused) { EXPECT_THROW(read_terrain({}, folder_.path() / "none.asc"), Error); }

TEST_F(TerrainTest, TrianglesPointUp) {
  const HeightGrid grid = read("a.asc", header + "1 2 3\n4 5 6.5\n");
  const TriangleMesh mesh = triangulate(grid);
  ASSERT_EQ(mesh.vertices.size(), 6u);
  ASSERT_EQ(mesh.triangles.size(), 4u);
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    const double twice = (b - a).cross(c - a).z();
    EXPECT_GT(twice, 0);
    area += twice / 2;
  }
  EXPECT_NEAR(area, 200, 1e-9);
  EXPECT_EQ(mesh.vertices[0], Vec3(105, 205, 4));
  EXPECT_EQ(mesh.vertices[5], Vec3(125, 215, 3));
}

TEST(TerrainModels, Volcano) {
  const std::filesystem::path file = std::filesystem::path(MOLTEN_SOURCE_DIR) / "scenes/models/volcano.json";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "run scripts/models to fetch the models";
  const HeightGrid grid = read_terrain({}, file);
  EXPECT_EQ(grid.columns, 87);
  EXPECT_EQ(grid.rows, 61);
  EXPECT_EQ(grid.cell_size, 10);
  EXPECT_EQ(grid.at(19, 30), 195);  // the rim's highest point
  EXPECT_EQ(triangulate(grid).triangles.size(), 2u * 86 * 60);
}

}  // namespace
}  // namespace molten::terrain_test
