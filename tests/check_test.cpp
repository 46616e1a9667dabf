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

TEST_F(CheckTest, RefusesAVentTooLargeToLetIn) {
  const std::string vent = "[[vent]]\ndisc = { centre = [0.1, 0.5], normal = [0, -1], radius = 1e20 }\nrate = 1\n[run]";
  expect_bad(replaced(block_scene, "[run]", vent), 2,
             {"vent: a layer of it would be 1e+22 particles", "make it smaller"});
}

TEST_F(CheckTest, RefusesTwoVentsInOnePlace) {
  const std::string vent = "[[vent]]\ndisc = { centre = [0.1, 0.9], normal = [0, -1], radius = 0.05 }\nrate = 0.01\n";
  const std::string aside = replaced(vent, "[0.1, 0.9]", "[0.21, 0.9]");
  expect_bad(replaced(block_scene, "[run]", vent + vent + "[run]"), 3,
             {"vent.1: lets fluid in where vent.0 does", "a table of times and rates"});
  const Outcome o = molten_program({"check", scene(replaced(block_scene, "[run]", vent + aside + "[run]")).string()});
  EXPECT_EQ(o.code, 0) << o.err;
}

TEST_F(CheckTest, NamesTheOverrideThatAVentOrFluidCameFrom) {
  const std::string vent = "[[vent]]\ndisc = { centre = [0.1, -0.5], normal = [0, 1], radius = 0.05 }\nrate = 1\n[run]";
  const std::string text = replaced(block_scene, "[run]", vent);
  expect_bad(text, 2, {"--set vent.0={ disc = ", ": vent: a layer of it"},
             {"--set", "vent.0={ disc = { centre = [0, 1], normal = [0, 1], radius = 1e20 }, rate = 1 }"});
}

TEST_F(CheckTest, RefusesWallsFasterThanTheFluidCanFollow) {
  const auto moving = [](const std::string& motion) {
    return block_scene + "[[boundary]]\nbox = { min = [5, 5], max = [6, 6] }\n" + motion + "\n";
  };
  expect_bad(moving("motion = { velocity = [1e30, 0] }"), 2, {":", "boundary.1.motion: moves faster than light"});
  expect_bad(moving("motion = { spin = 1e25 }"), 2, {"boundary.1.motion: moves faster than light"});
  expect_bad(moving("motion = { key_frames = [[0, 0, 0], [1e-20, 1, 0]] }"), 2, {"boundary.1.motion: moves faster"});
  expect_bad(moving("motion = { velocity = [4000, 0] }") + "[numerics]\nsound_speed = 100\n", 2,
             {"boundary.1.motion: moves at 4000", "raise numerics.sound_speed"});
  const std::string vent = "[[vent]]\ndisc = { centre = [5, 5], normal = [0, 1], radius = 0.05 }\nrate = ";
  expect_bad(block_scene + vent + "1e9\n", 2, {":", "vent: moves faster than light"});
  expect_bad(block_scene + vent + "400\n[numerics]\nsound_speed = 100\n", 2,
             {"vent: moves at", "raise numerics.sound"});
}

TEST_F(CheckTest, RefusesAnOutflowThatTakesAllFluid) {
  const auto outflow = [](const std::string& normal) {
    return block_scene + "[[outflow]]\nplane = { point = [5, 0], normal = " + normal + " }\n";
  };
  expect_bad(outflow("[-1, 0]"), 3, {"outflow.0: all of the fluid starts beyond its plane; turn its normal"});
  EXPECT_EQ(molten_program({"check", scene(outflow("[1, 0]")).string()}).code, 0);
  const std::string vent = "[[vent]]\ndisc = { centre = [9, 5], normal = [0, 1], radius = 0.05 }\nrate = 0.01\n";
  expect_bad(outflow("[1, 0]") + vent, 3, {"outflow.0: a vent lets fluid in beyond its plane"});
}

}  // namespace
}  // namespace molten
