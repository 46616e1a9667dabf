#include "core/features.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <string>

#include "core/error.h"
#include "tests/particle_sets.h"

namespace molten::features_test {
namespace {

using Names = std::vector<std::string>;

/// Names of the columns in the order of fields.h.
Names columns_of(const Features& features) {
  Names names;
  for_each_field([&]<class F>(F) {
    if (features.columns().test(field_index<F>)) names.emplace_back(F::name);
  });
  return names;
}

Scene minimal() {
  Scene scene;
  scene.numerics.artificial_viscosity = 0;
  return scene;
}

const Names minimal_columns = {"id",
                               "position",
                               "velocity",
                               "compression",
                               "half_velocity",
                               "half_compression",
                               "previous_compression_rate",
                               "local_position",
                               "pressure_term",
                               "acceleration",
                               "compression_rate"};

/// What `with` has and `without` has not, and the other way round.
Names difference(const Names& with, const Names& without) {
  Names names;
  for (const std::string& n : with)
    if (std::find(without.begin(), without.end(), n) == without.end()) names.push_back(n);
  return names;
}

struct Change {
  Names columns, passes_gone, passes_new;
};

/// Holds a scene with one more thing against the minimal one.
void expect_adds(const std::function<void(Scene&)>& edit, const Change& expected) {
  Scene scene = minimal();
  edit(scene);
  const Features features = features_of(scene), least = features_of(minimal());
  EXPECT_EQ(difference(columns_of(features), minimal_columns), expected.columns);
  EXPECT_EQ(difference(minimal_columns, columns_of(features)), Names{}) << "nothing may go missing";
  EXPECT_EQ(difference(least.passes(), features.passes()), expected.passes_gone);
  EXPECT_EQ(difference(features.passes(), least.passes()), expected.passes_new);
}

TEST(Features, MinimalSceneHasExactlyThis) {
  const Features features = features_of(minimal());
  EXPECT_EQ(columns_of(features), minimal_columns);
  EXPECT_EQ(features.passes(), (Names{"forces", "integrate"}));
  EXPECT_EQ(features.names(), (Names{"leap-frog"}));
}

TEST(Features, SymplecticEulerSwapsTheIntegratorsColumns) {
  Scene scene = minimal();
  scene.numerics.integrator = IntegratorKind::symplectic_euler;
  const Features features = features_of(scene);
  EXPECT_EQ(difference(columns_of(features), minimal_columns), (Names{"older_compression_rate"}));
  EXPECT_EQ(difference(minimal_columns, columns_of(features)), (Names{"half_velocity", "half_compression"}));
  EXPECT_EQ(features.names(), (Names{"symplectic-euler"}));
}

TEST(Features, RungeKuttaStagesHaveTheirColumns) {
  const auto columns = [](IntegratorKind integrator) {
    Scene scene = minimal();
    scene.numerics.integrator = integrator;
    Names names = difference(columns_of(features_of(scene)), minimal_columns);
    EXPECT_EQ(difference(minimal_columns, columns_of(features_of(scene))),
              (Names{"half_velocity", "half_compression", "previous_compression_rate"}));
    return names;
  };
  const Names base = {"base_position", "base_velocity", "base_compression"};
  EXPECT_EQ(columns(IntegratorKind::explicit_euler), Names{});
  EXPECT_EQ(columns(IntegratorKind::midpoint), base);
  EXPECT_EQ(columns(IntegratorKind::predictor_corrector), base);
  EXPECT_EQ(columns(IntegratorKind::runge_kutta_4).size(), base.size() + 3);
}

TEST(Features, HeatAddsItsColumns) {
  expect_adds([](Scene& s) { s.fluid.heat = Heat{}; },
              {{"temperature", "local_temperature", "temperature_rate"}, {"forces"}, {"forces and heat"}});
}

TEST(Features, BodiesThatConductDifferentlyAddTheirConductivity) {
  expect_adds(
      [](Scene& s) {
        s.fluid.heat = Heat{2, std::nullopt, 20, 20};
        s.fluid.bodies.emplace_back().diffusivity = 1;
      },
      {{"temperature", "local_temperature", "temperature_rate", "conductivity", "interface_distance",
        "interface_resistance"},
       {"forces"},
       {"interfaces", "forces and heat"}});
  expect_adds([](Scene& s) { s.fluid.bodies.emplace_back().diffusivity = 1; }, {});  // no heat
}

TEST(Features, HeatBesideWallsWithSupportAddsWhatTheyHide) {
  const auto walls = [](Scene& s) { s.boundaries.emplace_back(), s.numerics.wall_support = true; };
  expect_adds([&](Scene& s) { walls(s), s.fluid.heat = Heat{}; },
              {{"temperature", "local_temperature", "temperature_rate", "heat_completion"},
               {"forces", "integrate"},
               {"walls", "forces and heat", "integrate and collide"}});
  expect_adds(walls, {{}, {"integrate"}, {"integrate and collide"}});
}

TEST(Features, VaryingViscosityAddsItsPass) {
  expect_adds([](Scene& s) { s.fluid.rheology.model = Rheology::Model::smd; },
              {{"viscosity", "stress"}, {}, {"viscosity"}});
  expect_adds(
      [](Scene& s) {
        s.fluid.rheology.model = Rheology::Model::smd;
        s.numerics.gradient_correction = true;
        s.numerics.stress_form = StressForm::pairwise;
      },
      {{"viscosity", "correction", "laplacian_correction", "strain_rate", "vorticity", "thinning", "inner"},
       {},
       {"corrections", "viscosity"}});
  expect_adds([](Scene& s) { s.numerics.stress_form = StressForm::pairwise; }, {});  // nothing to act on
}

TEST(Features, ConstantViscosityAddsNoColumn) {
  expect_adds([](Scene& s) { s.fluid.rheology.viscosity = 1; }, {});
  expect_adds([](Scene& s) { s.numerics.artificial_viscosity = 0.1; }, {});
}

TEST(Features, ConsistentLaplaciansAddTheirWeights) {
  const auto consistent = [](Scene& s) {
    s.numerics.gradient_correction = true;
    s.numerics.laplacian = LaplacianForm::consistent;
  };
  const Names weights = {"correction", "laplacian_tilt", "laplacian_bend"};
  const auto flow = [&](Scene& s) { consistent(s), s.fluid.rheology.viscosity = 1; };
  expect_adds(flow, {weights, {}, {"corrections"}});
  expect_adds(consistent, {{"correction"}, {}, {"corrections"}});  // nothing to act on
}

TEST(Features, XsphAddsItsColumn) {
  expect_adds([](Scene& s) { s.numerics.xsph = Xsph{}; }, {{"xsph_velocity"}, {}, {}});
  expect_adds([](Scene& s) { s.numerics.xsph = Xsph{Xsph::Form::position, 0}; }, {});
}

TEST(Features, CorrectedGradientsAddTheirPassAndShiftingItsColumn) {
  const auto corrected = [](Scene& s) { s.numerics.gradient_correction = true; };
  expect_adds(corrected, {{"correction"}, {}, {"corrections"}});
  expect_adds([&](Scene& s) { corrected(s), s.fluid.rheology.viscosity = 1; },
              {{"correction", "laplacian_correction"}, {}, {"corrections"}});
  expect_adds([&](Scene& s) { corrected(s), s.numerics.shifting = Shifting{}; },
              {{"correction", "shift_velocity", "coupling_rate"}, {}, {"corrections"}});
  expect_adds(
      [&](Scene& s) {
        corrected(s), s.numerics.shifting = Shifting{10, 0};
      },
      {{"correction", "shift_velocity"}, {}, {"corrections"}});
  expect_adds(  // nothing leaks from what closes on itself
      [&](Scene& s) {
        corrected(s), s.numerics.shifting = Shifting{};
        s.periodic = {true, true, true}, s.domain = Box{{0, 0, 0}, {1, 1, 1}};
      },
      {{"correction", "shift_velocity"}, {}, {"corrections"}});
}

TEST(Features, DensityFiltersAndSummationAddTheirPasses) {
  expect_adds([](Scene& s) { s.numerics.density_filter = DensityFilter{}; },
              {{"filtered_compression"}, {}, {"density filter"}});
  expect_adds([](Scene& s) { s.numerics.density = DensityForm::summation; }, {{}, {}, {"density"}});
}

TEST(Features, SleepAddsItsColumnAndItsPass) {
  expect_adds([](Scene& s) { s.numerics.sleep.emplace(); }, {{"rest_time"}, {}, {"wake and rest"}});
  Scene scene = minimal();
  scene.fluid.heat = Heat{};
  const Names awake = columns_of(features_of(scene));
  scene.numerics.sleep.emplace();
  EXPECT_EQ(difference(columns_of(features_of(scene)), awake), (Names{"rest_time", "heat_rest_time"}));
}

TEST(Features, LevelsAddTheirColumnsAndTheirPass) {
  Scene scene = minimal();
  scene.fluid.rheology.model = Rheology::Model::smd;
  for (const auto integrator : {IntegratorKind::leap_frog, IntegratorKind::symplectic_euler}) {
    scene.numerics.integrator = integrator;
    scene.numerics.time_step_levels = 0;
    const Features without = features_of(scene);
    scene.numerics.time_step_levels = 3;
    const Features with = features_of(scene);
    Names columns{"stiff_acceleration", "stage_change", "earlier_change"};
    if (integrator == IntegratorKind::symplectic_euler) columns.insert(columns.begin() + 1, "start_velocity");
    EXPECT_EQ(difference(columns_of(with), columns_of(without)), columns);
    EXPECT_EQ(difference(with.passes(), without.passes()), (Names{"stages"}));
  }
}

TEST(Features, WallsAddTheirPass) {
  expect_adds([](Scene& s) { s.boundaries.emplace_back(); }, {{}, {"integrate"}, {"integrate and collide"}});
}

TEST(Features, BoundaryParticlesAddAColumnWhereThereAreWalls) {
  const auto dynamic = [](Scene& s) { s.numerics.boundary_particles = BoundaryParticles{}; };
  expect_adds(dynamic, {});
  const auto walls = [](Scene& s) { s.boundaries.emplace_back().shape.box.emplace(); };
  expect_adds([&](Scene& s) { dynamic(s), walls(s); }, {{"held"}, {"integrate"}, {"integrate and collide"}});
  const auto repulsive = [&](Scene& s) {
    walls(s);
    s.numerics.boundary_particles = BoundaryParticles{BoundaryParticles::Kind::repulsive};
  };
  expect_adds(repulsive, {{}, {"integrate"}, {"integrate and collide"}});
}

TEST(Features, SupportAndDensityDiffusionAddNoColumnAndNoPass) {
  expect_adds([](Scene& s) { s.numerics.density_diffusion = 0.1; }, {});
  expect_adds([](Scene& s) { s.numerics.wall_support = true; }, {});
  Scene scene = minimal();
  scene.numerics.wall_support = true;
  EXPECT_FALSE(features_of(scene).wall_support) << "without walls";
  scene.boundaries.emplace_back();
  scene.numerics.density_diffusion = 0.1;
  EXPECT_EQ(features_of(scene).names(), (Names{"contact", "wall-support", "density-diffusion", "leap-frog"}));
  scene.numerics.gradient_correction = true;
  scene.numerics.shifting = Shifting{};
  EXPECT_EQ(features_of(scene).names(), (Names{"gradient-correction", "shifting", "density-coupling", "contact",
                                               "wall-support", "density-diffusion", "leap-frog"}));
}

TEST(Features, WallsHeatMeltingAndXsphTogether) {
  Scene scene = minimal();
  scene.boundaries.emplace_back();
  scene.fluid.rheology = {Rheology::Model::smd, 0, 0.5, {15, 150}, 60, 20};
  scene.fluid.heat = Heat{1e-4, std::array<double, 2>{40, 60}, 20, 90};
  scene.numerics.xsph = Xsph{};
  scene.numerics.artificial_viscosity = 1;
  const Features features = features_of(scene);
  EXPECT_EQ(features.passes(), (Names{"viscosity", "forces and heat", "integrate and collide"}));
  EXPECT_EQ(features.names(), (Names{"heat", "smd-viscosity", "artificial-viscosity", "xsph", "contact", "leap-frog"}));
  EXPECT_EQ(columns_of(features).size(), minimal_columns.size() + 3 + 2 + 1);
}

/// The reason for which a scene is refused; empty if it is not.
std::string refusal(const std::function<void(Scene&)>& edit) {
  Scene scene = minimal();
  scene.file = "bad.toml";
  edit(scene);
  try {
    features_of(scene);
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::usage);
    return e.what();
  }
  return {};
}

void expect_refused(const std::function<void(Scene&)>& edit, const std::string& reason) {
  const std::string line = refusal(edit);
  EXPECT_TRUE(line.starts_with("bad.toml: " + reason)) << line;
}

TEST(Features, RefusesConductivitiesTooFarApart) {
  for (const double k : {1e-13, 1e-300, 1e13})
    expect_refused(
        [k](Scene& s) {
          s.fluid.heat = Heat{1, std::nullopt, 20, 20};
          s.fluid.bodies.resize(2);
          s.fluid.bodies[1].diffusivity = k;
        },
        "fluid.body.1.diffusivity: is further than a factor of 10^12");
  const auto within = [](Scene& s) {
    s.fluid.heat = Heat{1, std::nullopt, 20, 20};
    s.fluid.bodies.emplace_back().diffusivity = 1e-12;
  };
  EXPECT_EQ(refusal(within), "");
}

TEST(Features, RefusesWhatMakesNoSense) {
  const auto two_jumps = [](Scene& s) { s.fluid.rheology = {Rheology::Model::smd, 0, 0.5, {15, 150}, 60, 20}; };
  const std::string jumps = "fluid.rheology.jump_number: differs between hot and cold, but nothing melts";
  expect_refused(two_jumps, jumps);
  expect_refused([&](Scene& s) { two_jumps(s), s.fluid.heat = Heat{}; }, jumps);
  expect_refused(
      [](Scene& s) {
        s.fluid.heat = Heat{1e-4, std::array<double, 2>{40, 60}, 20, 90};
      },
      "fluid.heat.melting_range: acts on the jump_number of model \"smd\" alone");
  expect_refused(
      [](Scene& s) {
        s.numerics.density_filter = DensityFilter{};
        s.numerics.density = DensityForm::summation;
      },
      "numerics.density_filter: has nothing to do for density = \"summation\"");
  expect_refused([](Scene& s) { s.numerics.shifting = Shifting{}; }, "numerics.shifting: needs corrected gradients");
  expect_refused(
      [](Scene& s) {
        s.periodic = {true, false, false};
      },
      "scene.periodic: needs the size of the period; add domain");
  expect_refused([](Scene& s) { s.numerics.sleep.emplace().temperature_rate = 1; },
                 "numerics.sleep.temperature_rate: ");
  const auto with = [](IntegratorKind integrator, auto&& edit) {
    return [=](Scene& s) { s.numerics.integrator = integrator, edit(s); };
  };
  const auto moves = [](Scene& s) { s.boundaries.emplace_back().motion.emplace(); };
  const auto vent = [](Scene& s) { s.vents.emplace_back(); };
  const auto outflow = [](Scene& s) { s.outflows.emplace_back(); };
  expect_refused(with(IntegratorKind::runge_kutta_4, moves), "numerics.integrator: runge-kutta-4 knows no walls that");
  expect_refused(with(IntegratorKind::energy_bounded_euler, vent), "numerics.integrator: energy-bounded-euler knows");
  expect_refused(with(IntegratorKind::predictor_corrector, outflow), "numerics.integrator: predictor-corrector knows");
}

TEST(Features, RefusesAPairwiseStressWithoutWhatItNeeds) {
  const auto pairwise = [](Scene& s) {
    s.fluid.rheology.model = Rheology::Model::smd;
    s.numerics.stress_form = StressForm::pairwise;
  };
  expect_refused(pairwise, "numerics.stress_form: \"pairwise\" needs corrected gradients; add gradient_cor");
  const auto corrected = [&](Scene& s) { pairwise(s), s.numerics.gradient_correction = true; };
  EXPECT_EQ(refusal(corrected), "");
  Scene replica = minimal();  // with methods kept for replication it is the sum of stresses
  corrected(replica);
  EXPECT_TRUE(features_of(replica).pairwise_stress);
  replica.numerics.tensile_correction = true;
  EXPECT_FALSE(features_of(replica).pairwise_stress);
}

TEST(Features, RefusesConsistentLaplaciansWithWhatTheyDoNotGoWith) {
  const auto with = [](auto&& edit) {
    return [edit](Scene& s) {
      s.fluid.rheology.viscosity = 1;
      s.numerics.laplacian = LaplacianForm::consistent;
      s.numerics.gradient_correction = true;
      edit(s);
    };
  };
  EXPECT_EQ(refusal(with([](Scene&) {})), "");
  expect_refused(with([](Scene& s) { s.numerics.gradient_correction = false; }),
                 "numerics.laplacian: \"consistent\" needs corrected gradients; add gradient_cor");
  expect_refused(with([](Scene& s) { s.numerics.viscosity_form = ViscosityForm::monaghan; }),
                 "numerics.laplacian: \"consistent\" is one with viscosity_form \"morris\"");
  expect_refused(with([](Scene& s) { s.fluid.bodies.emplace_back().diffusivity = 1; }),
                 "numerics.laplacian: \"consistent\" takes one diffusivity for all");
  expect_refused(with([](Scene& s) { s.boundaries.emplace_back(), s.numerics.wall_support = true; }),
                 "numerics.laplacian: \"consistent\" knows nothing of the support of walls");
  expect_refused(with([](Scene& s) { s.numerics.tensile_correction = true; }),
                 "numerics.laplacian: does not go together with the methods kept for replication");
}

TEST(Features, RefusesLevelsWithWhatTheyDoNotGoWith) {
  const auto levels = [](Scene& s) {
    s.fluid.rheology.model = Rheology::Model::smd;
    s.numerics.time_step_levels = 3;
  };
  EXPECT_EQ(refusal(levels), "");
  expect_refused([](Scene& s) { s.numerics.time_step_levels = 3; }, "numerics.time_step_levels: tells regions apart");
  const auto refused = [&](auto&& edit) {
    expect_refused([&](Scene& s) { levels(s), edit(s.numerics); }, "numerics.time_step_levels: goes with the integ");
  };
  refused([](Numerics& n) { n.integrator = IntegratorKind::midpoint; });
  refused([](Numerics& n) { n.gradient_correction = true; });
  refused([](Numerics& n) { n.wall_support = true; });
  refused([](Numerics& n) { n.internal_energy = true; });
  refused([](Numerics& n) { n.sleep.emplace(); });
  refused([](Numerics& n) { n.boundary_particles.emplace(); });
}

TEST(Features, RefusesADensityBySummationWithWhatActsOnItsRate) {
  const auto summed = [](Scene& s) { s.numerics.density = DensityForm::summation; };
  expect_refused([&](Scene& s) { summed(s), s.numerics.wall_support = true; }, "numerics.wall_support: ");
  expect_refused([&](Scene& s) { summed(s), s.numerics.density_diffusion = 0.1; }, "numerics.density_diffusion: ");
  expect_refused([&](Scene& s) { summed(s), s.fluid.hydrostatic = true; }, "fluid.hydrostatic: ");
  expect_refused([](Scene& s) { s.numerics.density_kernel = KernelKind::poly6; }, "numerics.density_kernel: ");
}

TEST(Features, RefusesWallsThatItWouldGetWrong) {
  const auto walls = [](Scene& s) {
    s.numerics.wall_support = true;
    s.domain = Box{{0, 0, 0}, {1, 1, 1}};
    s.boundaries.resize(2);
    s.boundaries[0].shape.plane.emplace();
    s.boundaries[1].shape.plane.emplace();
  };
  const auto with_sphere = [&](Scene& s) {
    walls(s);
    s.boundaries[1].shape.plane.reset();
    s.boundaries[1].shape.sphere.emplace();
  };
  EXPECT_EQ(refusal([&](Scene& s) { walls(s), s.periodic[0] = true; }), "");
  EXPECT_EQ(refusal(with_sphere), "");
  expect_refused([&](Scene& s) { with_sphere(s), s.periodic[0] = true; }, "boundary.1: wall support of a wall that is");
  const auto moving = [&](Scene& s) { walls(s), s.boundaries[1].velocity = {1, 0, 0}; };
  EXPECT_EQ(refusal(moving), "");
  expect_refused([&](Scene& s) { moving(s), s.numerics.sleep.emplace(); }, "boundary.1.velocity: a wall in motion");
}

TEST(Features, RefusesInternalEnergyOfForcesThatActInPart) {
  const auto bounded = [](Scene& s) { s.numerics.integrator = IntegratorKind::energy_bounded_euler; };
  EXPECT_EQ(refusal(bounded), "");
  expect_refused([&](Scene& s) { bounded(s), s.numerics.internal_energy = true; }, "numerics.internal_energy: ");
}

TEST(Features, ARefusalSaysWhereTheKeyOrItsTableStands) {
  const auto shifting = [](Scene& s) { s.numerics.shifting = Shifting{}; };
  const auto line = [&](std::map<std::string, Place, std::less<>> places) {
    return refusal([&](Scene& s) { shifting(s), s.places = places; }).substr(0, 40);
  };
  const Place place{"bad.toml", 7, 3};
  EXPECT_EQ(line({{"numerics.shifting", place}}), "bad.toml:7:3: numerics.shifting: needs c");
  EXPECT_EQ(line({{"numerics", place}}), "bad.toml:7:3: numerics.shifting (chosen ");
  EXPECT_EQ(line({{"numerics.shifting", {"--set numerics.shifting=true", 0, 0}}}),
            "--set numerics.shifting=true: numerics.s");
}

TEST(Features, TakesWhatMakesSense) {
  EXPECT_EQ(refusal([](Scene& s) { s.fluid.rheology = {Rheology::Model::smd, 0, 0.5, {15, 15}, 60, 20}; }), "");
  EXPECT_EQ(refusal([](Scene& s) { s.fluid.heat = Heat{}; }), "");
  EXPECT_EQ(refusal([](Scene& s) {
              s.periodic = {true, false, false};
              s.domain = Box{{0, 0, 0}, {1, 1, 1}};
            }),
            "");
  EXPECT_EQ(refusal([](Scene& s) { s.dimensions = 2, s.periodic = {false, false, true}; }), "") << "no z in 2-D";
}

TEST(Features, PassesAreTheTimersNames) {
  Scene scene = particle_sets::plain_scene(2);
  scene.fluid.rheology = {Rheology::Model::smd, 0, 0.5, {15, 15}, 60, 20};
  scene.fluid.heat = Heat{1e-4, std::nullopt, 20, 90};
  auto s = particle_sets::state_of<2, float>(scene, particle_sets::cube<2>(6, 0.1), 0.1);
  step(s);
  Names timed;
  for (const auto& [name, seconds] : s.timer.seconds())
    if (name != "sort and list") timed.push_back(name);
  Names passes = s.features.passes();
  std::sort(passes.begin(), passes.end());
  EXPECT_EQ(timed, passes);
}

TEST(Features, ColumnsThatARunLacksTakeNoMemory) {
  using namespace particle_sets;
  const auto bytes = [](const Scene& scene) {
    return state_of<3, float>(scene, cube<3>(16, 0.1), 0.1).particles.bytes();
  };
  Scene hot = plain_scene(3);
  hot.fluid.heat = Heat{};
  const std::size_t particles = 16 * 16 * 16, more = bytes(hot) - bytes(plain_scene(3));
  EXPECT_GE(more, particles * (8 + 4 + 4));
  EXPECT_LT(more, particles * (8 + 4 + 4) * 1.5) << "a double and two floats each, and room for padding";
}

}  // namespace
}  // namespace molten::features_test
