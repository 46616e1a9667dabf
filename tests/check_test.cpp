// What `molten check` says of meshes and vents.
#include <gtest/gtest.h>

#include "tests/program.h"

namespace molten {
namespace {

using CheckTest = ProgramTest;

TEST_F(CheckTest, SaysWhereAMeshIsBroken) {
  const std::string broken = cube.substr(0, cube.rfind("f 4 5 8"));
  write_bytes(folder.path() / "cube.obj", broken);
  const Outcome o = molten_program({"check", scene(mesh_scene("cube.obj")).string()});
  EXPECT_EQ(o.code, 3) << o.err;
  EXPECT_TRUE(contains(o.out, "hole or rim of 3 edges")) << o.out;
  EXPECT_TRUE(contains(o.out, "Fill Holes")) << o.out;
}

TEST_F(CheckTest, RefusesAVentInsideRock) {
  const std::string text =
      replaced(block_scene, "[run]",
               "[[vent]]\ndisc = { centre = [0.1, -0.5], normal = [0, 1], radius = 0.05 }\nrate = 1\n[run]");
  expect_bad(text, 3, {"vent", "would be inside a wall", "move it to the wall's surface"});
}

}  // namespace
}  // namespace molten
