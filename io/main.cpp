// The program: reads the command line and calls what it names. Errors are one line and an exit code (core/error.h).
#include <fmt/format.h>
#include <omp.h>

#include <CLI/CLI.hpp>
#include <new>

#include "io/program/commands.h"
#include "io/program/run.h"
#include "io/program/say.h"
#include "io/scene/scene_file.h"
#include "version.h"

namespace {

using molten::ExitCode;

constexpr int most_threads = 4096;

/// For options whose default is meant only where they are not given.
const CLI::Validator not_empty([](const std::string& text) { return text.empty() ? "is empty; leave it out" : ""; },
                               "");

/// For what is required; an empty name is most often a shell variable that is not set.
const CLI::Validator some_name(
    [](const std::string& text) { return text.empty() ? "is empty; name a file or folder" : ""; }, "");

/// One subcommand: its options and what it does.
struct Commands {
  std::string scene, other;
  std::vector<std::string> overrides;
  molten::RunOptions run;
  molten::ResumeOptions resume;
  molten::RenderChoice render;
  std::function<ExitCode()> chosen;
};

void add_run(CLI::App& app, Commands& c) {
  CLI::App* run =
      app.add_subcommand("run", "Run a scene\n  molten run scenes/bunny.toml -o runs/bunny --set run.end_time=0.1");
  run->add_option("scene", c.scene, "Scene file (TOML; docs/scenes.md)")->required()->check(some_name);
  run->add_option("-o,--output", c.run.folder, "Folder of the run (default: runs/<name of the scene>)")
      ->check(not_empty);
  run->add_option("--threads", c.run.threads, "Threads (default: OMP_NUM_THREADS or all cores)")
      ->check(CLI::Range(1, most_threads));
  run->add_option("--set", c.overrides, "Override a key of the scene; again for each more")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  run->add_flag("--overwrite", c.run.overwrite, "Replace a run that the folder already holds");
  run->callback([&] {
    c.chosen = [&] {
      if (c.run.folder.empty()) c.run.folder = std::filesystem::path("runs") / std::filesystem::path(c.scene).stem();
      return run_scene(molten::read_scene(c.scene, c.overrides), c.run);
    };
  });
}

void add_resume(CLI::App& app, Commands& c) {
  CLI::App* resume = app.add_subcommand(
      "resume", "Go on from a run's newest checkpoint\n  molten resume runs/bunny --set run.end_time=0.8");
  resume->add_option("run", c.resume.folder, "Folder of the run")->required()->check(some_name);
  resume->add_option("--threads", c.resume.threads, "Threads")->check(CLI::Range(1, most_threads));
  resume->add_option("--set", c.resume.overrides, "Override a key of [run] or [output]; again for each more")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  resume->add_flag("--force", c.resume.force, "Go on although the scene, a mesh or the numerics changed");
  resume->callback([&] { c.chosen = [&] { return resume_run(c.resume); }; });
}

void add_check(CLI::App& app, Commands& c) {
  CLI::App* check =
      app.add_subcommand("check", "Check a scene and say what a run would take\n  molten check scenes/volcano.toml");
  check->add_option("scene", c.scene, "Scene file")->required()->check(some_name);
  check->add_option("--set", c.overrides, "Override a key of the scene; again for each more")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  check->callback([&] { c.chosen = [&] { return check_scene(molten::read_scene(c.scene, c.overrides)); }; });
}

void add_info(CLI::App& app, Commands& c) {
  CLI::App* info =
      app.add_subcommand("info", "Say what a run folder, frame, checkpoint or mesh holds\n  molten info runs/bunny");
  info->add_option("file", c.scene, "Run folder, .hdf frame, .h5 checkpoint, or mesh")->required()->check(some_name);
  info->callback([&] { c.chosen = [&] { return molten::show_info(c.scene); }; });
}

void add_render(CLI::App& app, Commands& c) {
  CLI::App* render =
      app.add_subcommand("render", "Draw frames to PNG\n  molten render runs/bunny --frames last --field temperature");
  molten::PictureOptions& p = c.render.picture;
  render->add_option("run", c.render.run, "Folder of the run")->required()->check(some_name);
  render->add_option("-o,--output", c.render.output, "Folder for the pictures (default: RUN/pictures)")
      ->check(not_empty);
  render->add_option("--frames", c.render.frames, "all, last, numbers 0,10,20 or a range 0:100:10")
      ->capture_default_str();
  render->add_option("--field", p.field, "Field to colour by (default: temperature, else speed)")->check(not_empty);
  render->add_option("--range", p.range, "Lowest and highest value of the colours")->delimiter(',');
  render->add_option("--eye", p.eye, "Where the camera is: x y z, m")->delimiter(',');
  render->add_option("--look-at", p.look_at, "Where it looks: x y z, m")->delimiter(',');
  render->add_option("--azimuth", p.azimuth, "Direction of view about the vertical, degrees")->capture_default_str();
  render->add_option("--elevation", p.elevation, "Height of view, degrees")->capture_default_str();
  render->add_option("--zoom", p.zoom, "Larger is closer")->capture_default_str()->check(CLI::Range(0.001, 1000.0));
  render->add_option("--width", p.width, "Pixels")->capture_default_str()->check(CLI::Range(16, 8192));
  render->add_option("--height", p.height, "Pixels")->capture_default_str()->check(CLI::Range(16, 8192));
  render->add_flag_callback(
      "--no-walls", [&p] { p.boundaries = false; }, "Leave the walls out");
  render->callback([&] { c.chosen = [&] { return render_run(c.render); }; });
}

void add_compare(CLI::App& app, Commands& c) {
  CLI::App* compare =
      app.add_subcommand("compare",
                         "Differences between the last common frames of two runs, or between two frames\n"
                         "  molten compare runs/bunny runs/bunny-double");
  compare->add_option("a", c.scene, "Run folder or frame")->required()->check(some_name);
  compare->add_option("b", c.other, "Run folder or frame")->required()->check(some_name);
  compare->callback([&] { c.chosen = [&] { return molten::compare(c.scene, c.other); }; });
}

int guarded(const std::function<ExitCode()>& f) {
  try {
    const ExitCode code = f();
    molten::finish_output();
    return static_cast<int>(code);
  } catch (const molten::Error& e) {
    molten::say("molten: {}\n", e.what());
    return static_cast<int>(e.code());
  } catch (const std::bad_alloc&) {
    molten::say("molten: out of memory; ask for fewer particles\n");
    return static_cast<int>(ExitCode::usage);
  } catch (const std::exception& e) {
    molten::say("molten: {}\n", e.what());
    return static_cast<int>(ExitCode::files);
  }
}

/// What is wrong with the command line, in one line.
std::string complaint(const CLI::App* app, const CLI::Error& e) {
  const auto subcommands = app->get_subcommands();
  const auto unknown = app->remaining();
  if (subcommands.empty() && !unknown.empty())
    return fmt::format("molten: {} is no command; see molten --help\n", unknown.front());
  return fmt::format("molten: {}; see molten{}{} --help\n", e.what(), subcommands.empty() ? "" : " ",
                     subcommands.empty() ? "" : subcommands.front()->get_name());
}

/// The runtime creates as many threads as the environment asks for, until it breaks.
void require_possible_threads() {
  if (omp_get_max_threads() > most_threads)
    throw molten::Error(ExitCode::usage,
                        fmt::format("OMP_NUM_THREADS: {} threads are more than {}; set no more than the "
                                    "machine has cores",
                                    omp_get_max_threads(), most_threads));
}

}  // namespace

int main(int argc, char** argv) {
  molten::open_standard_streams();
  CLI::App app{"molten: melting bodies, lava and dam breaks with smoothed particle hydrodynamics"};
  app.set_version_flag("--version", std::string("molten ") + MOLTEN_VERSION + " (" + MOLTEN_COMMIT + ")");
  app.require_subcommand(1);
  app.failure_message(complaint);
  app.footer(
      "Exit codes: 0 done, 2 usage or scene, 3 mesh or overlap, 4 diverged, 5 files, 6 checkpoint, 75 stopped, "
      "resumable");
  Commands commands;
  add_run(app, commands);
  add_resume(app, commands);
  add_check(app, commands);
  add_info(app, commands);
  add_render(app, commands);
  add_compare(app, commands);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (app.exit(e) != 0) return static_cast<int>(ExitCode::usage);
    return guarded([] { return ExitCode::done; });
  }
  return guarded([&] {
    require_possible_threads();
    return commands.chosen();
  });
}
