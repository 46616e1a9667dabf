// What `molten check` says of meshes and vents.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/program.h"

namespace molten::check_test {
namespace {

using CheckTest = ProgramTest;

TEST_F(CheckTest, SaysWhereAMeshIsBroken) {
  const std::string broken = cube_obj.substr(0, cube_obj.rfind("f 4 5 8"));
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

TEST_F(CheckTest, RefusesAVentOutsideTheDomain) {
  const std::string vent = "[[vent]]\ndisc = { centre = [3, 1], normal = [0, 1], radius = 0.05 }\nrate = 0.01\n[run]";
  const std::string domain = "[scene]\ndomain = { min = [-1, -1], max = [2, 2] }\n";
  expect_bad(replaced(replaced(block_scene, "[run]", vent), "[scene]\n", domain), 3,
             {"vent: reaches x = 2.96 m, outside scene.domain, which is from -1 to 2 m there"});
}

TEST_F(CheckTest, RefusesAVentThatWaitsInTheFluid) {
  const auto with_vent = [](double height) {
    return replaced(
        block_scene, "[run]",
        fmt::format("[[vent]]\ndisc = {{ centre = [0.1, {}], normal = [0, 1], radius = 0.05 }}\nrate = 0\n[run]",
                    height));
  };
  expect_bad(with_vent(0.15), 3, {"vent: ", "particles of the fluid start where the vent's own wait"});
  EXPECT_EQ(run(with_vent(0.02)).code, 0) << "below the fluid, at its surface";
}

TEST_F(CheckTest, RefusesPeriodsInWhichAParticleMeetsItself) {
  const std::string domain = "[scene]\nperiodic = [\"x\"]\ndomain = { min = [0, -1], max = [0.12, 2] }\n";
  expect_bad(replaced(block_scene, "[scene]\n", domain), 2, {"scene.domain", "twice the support"});
}

/// The finding of a check, and what a run says of it; empty if there is none.
class WarningTest : public ProgramTest {
 protected:
  std::string warning(const std::string& text) const {
    const Outcome o = molten_program({"check", scene(text).string()});
    EXPECT_EQ(o.code, 0) << o.err;
    const std::size_t at = o.out.find("warning  ");
    if (at == std::string::npos) return "";
    EXPECT_TRUE(contains(o.out, "it can be run, but see the ")) << o.out;
    return o.out.substr(at, o.out.find('\n', at) - at);
  }
  static std::string above_a_sheet(const std::string& keys) {
    return "[fluid]\nbox = { min = [0.3, 0.3, 0.3], max = [0.6, 0.6, 0.6] }\nspacing = 0.1\n[[boundary]]\n"
           "mesh = \"sheet.obj\"\n" +
           keys + "\n[run]\nend_time = 0.001\n";
  }
};

TEST_F(WarningTest, FluidAboveABackThatLetsItThrough) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  file("sheet.obj", corners + "f 1 3 2\nf 1 4 3\n");
  const std::string said = warning(above_a_sheet(""));
  EXPECT_TRUE(contains(said, "boundary.0: 100 % of the fluid is above its back")) << said;
  EXPECT_TRUE(contains(said, "two_sided = true")) << said;
  const Outcome o = run(above_a_sheet(""));
  EXPECT_EQ(o.code, 0);
  EXPECT_TRUE(contains(o.err, "note: boundary.0: 100 % of the fluid")) << o.err;
  const auto check = [&](const std::string& text) { return molten_program({"check", scene(text).string()}).out; };
  EXPECT_FALSE(contains(check(above_a_sheet("two_sided = true")), "its back"));
  file("sheet.obj", corners + "f 1 2 3\nf 1 3 4\n");
  EXPECT_FALSE(contains(check(above_a_sheet("")), "its back"));
  EXPECT_EQ(warning(block_scene), "");
}

TEST_F(WarningTest, AKernelThatReachesTooFew) {
  const auto with = [](const std::string& numerics) {
    return replaced(block_scene, "[run]", "[numerics]\n" + numerics + "\n[run]");
  };
  EXPECT_TRUE(contains(warning(with("kernel = \"spiky\"")), "particles see only 1.7 spacings far"));
  EXPECT_EQ(warning(with("kernel = \"spiky\"\nsmoothing_ratio = 2.6")), "");
  EXPECT_EQ(warning(with("preset = \"queiroz\"")), "");
}

/// Two blocks, or the left one alone, beside a box between x = 0.5 m and 0.5 m + thickness; particles see 0.26 m far.
std::string partitioned(int dimensions, double thickness, bool both) {
  const auto box = [&](double from, double to, double low, double high) {
    return dimensions == 2
               ? fmt::format("box = {{ min = [{}, {}], max = [{}, {}] }}\n", from, low, to, high)
               : fmt::format("box = {{ min = [{0}, {1}, {1}], max = [{2}, {3}, {3}] }}\n", from, low, to, high);
  };
  std::string text = fmt::format("[scene]\ndimensions = {}\n[fluid]\nspacing = 0.1\n[[fluid.body]]\n", dimensions);
  text += box(0, 0.5, 0, 0.5);
  const double next = std::ceil(10 * thickness - 1e-9) / 10;  // of the lattice
  if (both) text += "[[fluid.body]]\n" + box(0.5 + next, 1 + next, 0, 0.5);
  return text + "[[boundary]]\n" + box(0.5, 0.5 + thickness, -0.5, 3) + "[run]\nend_time = 0.001\n";
}

TEST_F(WarningTest, AWallThatFluidSeesThrough) {
  for (const int dimensions : {2, 3}) {
    const std::string said = warning(partitioned(dimensions, 0.1, true));
    EXPECT_TRUE(contains(said, "boundary.0: is 0.1 m thick at (0.")) << said;
    EXPECT_TRUE(contains(said, "less than the 0.26 m that particles see")) << said;
    EXPECT_TRUE(contains(warning(partitioned(dimensions, 0.15, true)), "is 0.15 m thick"))
        << "0.3 m from each other, but not for long";
    EXPECT_EQ(warning(partitioned(dimensions, 0.1, false)), "") << "nothing behind it";
    EXPECT_EQ(warning(partitioned(dimensions, 0.2, true)), "") << "the nearest are 0.3 m from each other";
  }
}

TEST_F(WarningTest, ASheetThatFluidSeesThrough) {
  file("sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 3 2\nf 1 4 3\n");
  const auto beside_sheet = [](const std::string& more) {
    return "[fluid]\nspacing = 0.1\n[[fluid.body]]\nbox = { min = [0.3, 0.3, 0.0], max = [0.6, 0.6, 0.3] }\n" + more +
           "[[boundary]]\nmesh = \"sheet.obj\"\ntwo_sided = true\n[run]\nend_time = 0.001\n";
  };
  const std::string below = "[[fluid.body]]\nbox = { min = [0.3, 0.3, -0.3], max = [0.6, 0.6, 0.0] }\n";
  EXPECT_TRUE(contains(warning(beside_sheet(below)), "boundary.0: is 0 m thick at (0."));
  EXPECT_EQ(warning(beside_sheet("")), "");
}

TEST_F(WarningTest, VentsNarrowerThanAParticle) {
  const std::string vent = "[[vent]]\ndisc = { centre = [0.1, 0.9], normal = [0, -1], radius = 1e-4 }\nrate = 1e-5\n";
  EXPECT_TRUE(contains(warning(block_scene + vent), "vent.0: is 0.0002 m wide and its stream one particle"));
}

TEST_F(WarningTest, StepsTooLong) {
  EXPECT_TRUE(contains(warning(block_scene + "[numerics]\nfixed_dt = 0.001\n"), "numerics.fixed_dt: steps of 0.001 s"));
  EXPECT_TRUE(contains(warning(block_scene + "[numerics]\ncourant = { sound = 2 }\n"), "numerics.courant: steps of"));
}

}  // namespace
}  // namespace molten::check_test
