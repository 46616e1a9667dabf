// Meshes of boundaries that cannot be what was meant are refused with what is wrong.
#include <gtest/gtest.h>

#include <sstream>

#include "core/error.h"
#include "io/geometry/assemble.h"
#include "io/scene/scene_file.h"
#include "tests/temp_folder.h"

namespace molten::placed_mesh_test {
namespace {

/// What is said of a boundary with this mesh and these keys; empty: nothing.
std::string complaint_of(const std::string& obj, const std::string& keys) {
  const TempFolder folder;
  write_bytes(folder.path() / "m.obj", obj);
  const std::string file = (folder.path() / "s.toml").string();
  write_bytes(file,
              "[fluid]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nspacing = 0.1\n[[boundary]]\nmesh = \"m.obj\"\n" +
                  keys + "\n[run]\nend_time = 1\n");
  try {
    build_walls<3>(read_scene(file), 0.1);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

const std::string tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
const std::string open_tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n";
const std::string flipped_tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 3 4\n";
const std::string flat = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST(PlacedMesh, SensibleOnesAreTaken) {
  EXPECT_EQ(complaint_of(tetrahedron, "height = 2\nposition = [5, 5, -3]"), "");
  EXPECT_EQ(complaint_of(flat, "position = [5, 5, -3]"), "");
  EXPECT_EQ(complaint_of(open_tetrahedron, ""), "") << "only bodies and containers have to be closed";
  EXPECT_EQ(complaint_of(tetrahedron, "body = { density = 500 }"), "");
}

TEST(PlacedMesh, AFlatOneHasNoHeight) {
  EXPECT_NE(complaint_of(flat, "height = 1").find("is flat there; leave height out"), std::string::npos);
}

TEST(PlacedMesh, OneFarOffItsSizeIsRefused) {
  EXPECT_NE(complaint_of(tetrahedron, "position = [1e28, 0, 0]").find("1e+28 m away"), std::string::npos);
  EXPECT_NE(complaint_of(tetrahedron, "height = 1e-20\nposition = [1, 0, 0]").find("check its position"),
            std::string::npos);
}

TEST(PlacedMesh, OneFarSmallerThanParticlesIsRefused) {
  EXPECT_NE(complaint_of(tetrahedron, "height = 1e-20").find("far below the spacing"), std::string::npos);
}

TEST(PlacedMesh, AnObstacleFacesOutwards) {
  std::string inverted;  // each face walked the other way round
  std::istringstream lines(tetrahedron);
  for (std::string line; std::getline(lines, line);) {
    if (line[0] == 'f') std::swap(line[4], line[6]);
    inverted += line + '\n';
  }
  EXPECT_NE(complaint_of(inverted, "").find("inside out"), std::string::npos);
  EXPECT_NE(complaint_of(flipped_tetrahedron, "").find("opposite ways"), std::string::npos);
  EXPECT_EQ(complaint_of(inverted, "two_sided = true"), "");
  EXPECT_EQ(complaint_of(flipped_tetrahedron, "two_sided = true"), "");
}

TEST(PlacedMesh, ABodyIsClosed) {
  EXPECT_NE(complaint_of(open_tetrahedron, "body = { density = 500 }").find("not closed"), std::string::npos);
  EXPECT_NE(complaint_of(flipped_tetrahedron, "body = { density = 500 }").find("opposite ways"), std::string::npos);
}

}  // namespace
}  // namespace molten::placed_mesh_test
