#include "io/program/run.h"

#include <fmt/format.h>
#include <omp.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <optional>

#include "core/diagnostics.h"
#include "core/step.h"
#include "io/geometry/assemble.h"
#include "io/geometry/bodies.h"
#include "io/geometry/obj_file.h"
#include "io/geometry/vents.h"
#include "io/geometry/warnings.h"
#include "io/hdf5/checkpoint.h"
#include "io/hdf5/frames.h"
#include "io/program/progress.h"
#include "io/program/report.h"
#include "io/program/run_lock.h"
#include "io/program/say.h"
#include "io/program/series.h"
#include "io/program/signals.h"
#include "io/scene/scene_file.h"
#include "version.h"

namespace molten {

namespace {

double seconds_since(std::chrono::steady_clock::time_point t) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - t).count();
}

/// What a run keeps beside its state: where its output stands and what has been spent so far.
struct Ledger {
  std::int64_t frame_number = 0;  // of the next frame's file
  std::int64_t rows = 0;          // of series.csv
  double last_frame = -1;         // s
  double initial_energy = 0, stepping_seconds = 0, particle_steps = 0, asleep_steps = 0, pairs_at_start = 0;
  std::vector<double> level_steps;  // particle-steps by level; empty without levels
  double stages = 0;                // of all steps

  void archive(Archive& a) {
    a.value("run/frame_number", frame_number);
    a.value("run/rows", rows);
    a.value("run/last_frame", last_frame);
    a.value("run/initial_energy", initial_energy);
    a.value("run/stepping_seconds", stepping_seconds);
    a.value("run/particle_steps", particle_steps);
    a.value("run/asleep_steps", asleep_steps);
    a.value("run/pairs_at_start", pairs_at_start);
    if (!level_steps.empty()) a.vector("run/level_steps", level_steps), a.value("run/stages", stages);
  }
};

/// One run in its folder: steps, and writes what is due between them.
template <int Dim, class Real> class Runner {
 public:
  Runner(const Scene& scene, const std::filesystem::path& folder, State<Dim, Real> state, std::string fingerprint)
      : scene_(scene), folder_(folder), state_(std::move(state)), fingerprint_(std::move(fingerprint)) {
    if (state_.features.levels) ledger_.level_steps.resize(state_.levels.particles.size());
  }

  void restore(const std::filesystem::path& checkpoint) {
    read_checkpoint(checkpoint, [this](Archive& a) { archive(a); });
    const std::int64_t kept = drop_frames_from(folder_, static_cast<int>(ledger_.frame_number));
    if (kept < ledger_.frame_number)
      say("warning: {}: {} of the {} frames so far are not there; going on without them\n",
          (folder_ / "frames").string(), ledger_.frame_number - kept, ledger_.frame_number);
    last_row_step_ = state_.clock.step;
    schedule();
    fresh_ = false;
  }

  std::size_t particles() const { return state_.particles.count(); }

  ExitCode run() {
    begin();
    ExitCode code = ExitCode::done;
    try {
      while (!is_over()) {
        if (stop_requested()) {
          code = ExitCode::interrupted;
          break;
        }
        advance();
      }
    } catch (const Error& e) {
      if (e.code() == ExitCode::diverged) report_divergence(e);
      throw;
    }
    finish(code);
    return code;
  }

 private:
  void begin() {
    series_.emplace(folder_ / "series.csv", Series::Kept{ledger_.rows, state_.clock.step}, state_.features,
                    state_.bodies.count());
    ledger_.rows = series_->rows();
    if (fresh_) {
      const Diagnostics d = diagnose(state_);
      ledger_.initial_energy = d.kinetic_energy + d.potential_energy;
      ledger_.pairs_at_start = static_cast<double>(count_pairs(state_));
      write_row(d);
      if (scene_.output.frames_per_second > 0) write_snapshot();
      schedule();
      checkpoint();
    }
    progress_.emplace(state_.clock.time, scene_.run.end_time, ledger_.initial_energy);
    last_checkpoint_ = std::chrono::steady_clock::now();
  }

  bool is_over() const {
    return state_.clock.time >= scene_.run.end_time * (1 - 1e-12) ||
           (scene_.run.max_steps && state_.clock.step >= *scene_.run.max_steps);
  }

  /// The first multiple of an interval (s) after a time; one that is further off only by round-off is that time.
  static double next_multiple(double interval, double time) {
    return (std::floor(time / interval + 1e-6) + 1) * interval;
  }

  /// Sets the times (s) of the next frame and row: the next multiples of their intervals. Steps end on frames' times
  /// alone, so a stop and a resume leave no trace.
  void schedule() {
    const double fps = scene_.output.frames_per_second, every = scene_.output.series_every;
    state_.clock.stop = fps > 0 ? next_multiple(1 / fps, state_.clock.time) : 1e300;
    next_row_ = every > 0 ? next_multiple(every, state_.clock.time) : 1e300;
  }

  void advance() {
    const auto start = std::chrono::steady_clock::now();
    step(state_);
    if (state_.particles.count() == 0)
      throw Error(ExitCode::diverged, "all particles have left the domain; enlarge scene.domain or add walls");
    ledger_.stepping_seconds += seconds_since(start);
    ledger_.particle_steps += static_cast<double>(state_.particles.count());
    ledger_.asleep_steps += static_cast<double>(state_.sleep.asleep);
    for (std::size_t k = 0; k < ledger_.level_steps.size(); ++k)
      ledger_.level_steps[k] += static_cast<double>(state_.levels.particles[k]);
    ledger_.stages += state_.levels.stages;
    write_due();
    if (scene_.output.checkpoint_every > 0 && seconds_since(last_checkpoint_) > scene_.output.checkpoint_every)
      checkpoint();
    if (progress_->is_due()) show_progress();
  }

  void write_due() {
    const bool frame_due = state_.clock.time >= state_.clock.stop;
    if (!frame_due && state_.clock.time < next_row_) return;
    const auto scope = state_.timer.scope("output");
    write_row(diagnose(state_));
    if (frame_due) write_snapshot();
    schedule();
  }

  void write_row(const Diagnostics& d) {
    series_->add(state_.clock, d);
    ledger_.rows = series_->rows();
    last_row_step_ = state_.clock.step;
    if (d.max_compression > much_compression && !said_compression_) say_compression(d.max_compression);
  }

  /// Once a run: liquids whose density is far from theirs are not what was asked for. Gases may be, and sums over
  /// neighbours, which lack some at a surface.
  void say_compression(double compression) {
    const EquationOfState& eos = state_.parameters.eos;
    if (eos.kind == StateEquation::ideal_gas || state_.features.density_sum) return;
    if (progress_) progress_->finish();
    fmt::print(
        stderr,
        "note: at t = {:.4g} s the density is up to {:.0f} % off: {}raise numerics.sound_speed above {:.3g} m/s, or "
        "give the fluid more room\n",
        state_.clock.time, 100 * compression, step_cure(), eos.sound_speed);
    said_compression_ = true;
  }

  /// What makes steps shorter that the scene has made longer.
  const char* step_cure() const {
    const Numerics& n = scene_.numerics;
    if (n.fixed_dt) return "lower numerics.fixed_dt, ";
    return n.courant_sound > Numerics{}.courant_sound ? "lower numerics.courant.sound, " : "";
  }

  void write_snapshot() {
    write_frame(folder_, static_cast<int>(ledger_.frame_number++), take_snapshot(state_, scene_.output.fields));
    ledger_.last_frame = state_.clock.time;
  }

  void checkpoint() {
    const auto scope = state_.timer.scope("checkpoint");
    const CheckpointHead head{state_.clock.step, state_.clock.time, scene_.text, fingerprint_, MOLTEN_VERSION};
    write_checkpoint(
        folder_, head, [this](Archive& a) { archive(a); }, scene_.output.checkpoints_kept);
    last_checkpoint_ = std::chrono::steady_clock::now();
  }

  void archive(Archive& a) {
    ledger_.archive(a);
    state_.archive(a);
  }

  void show_progress() { progress_->show(state_.clock, diagnose(state_)); }

  void finish(ExitCode code) {
    show_progress();
    progress_->finish();
    checkpoint();
    // The last state is worth a row and a frame even between their times; a resume drops them again.
    if (code == ExitCode::done && state_.clock.step > last_row_step_) write_row(diagnose(state_));
    if (code == ExitCode::done && scene_.output.frames_per_second > 0 && state_.clock.time > ledger_.last_frame)
      write_snapshot();
    if (state_.neighbours.dropped() > 0) say("note: {} particles have left the domain\n", state_.neighbours.dropped());
    summarise(code == ExitCode::done ? "done" : "interrupted");
    if (code == ExitCode::interrupted)
      say("stopped at t = {:.6g} s, step {}; go on with: molten resume {}\n", state_.clock.time, state_.clock.step,
          folder_.string());
  }

  void summarise(const std::string& status) {
    Summary s;
    s.status = status;
    s.particles = static_cast<std::int64_t>(state_.particles.count());
    s.particles_asleep = state_.sleep.asleep;
    if (state_.features.boundary_particles) s.boundary_particles = static_cast<std::int64_t>(state_.boundary_count);
    if (state_.features.repulsion) s.boundary_particles = static_cast<std::int64_t>(state_.repulsion.count());
    if (state_.features.sleep) s.energy_taken_by_sleep = state_.sleep.taken_energy;
    s.particles_lost = static_cast<std::int64_t>(state_.neighbours.dropped());
    s.steps = state_.clock.step;
    s.simulated_time_s = state_.clock.time;
    s.wall_time_s = ledger_.stepping_seconds;
    s.particle_steps = ledger_.particle_steps;
    s.asleep_steps = ledger_.asleep_steps;
    s.level_steps = ledger_.level_steps;
    s.stages = ledger_.stages;
    const double pairs_a_step = (ledger_.pairs_at_start + static_cast<double>(count_pairs(state_))) / 2;
    s.pairs = pairs_a_step * static_cast<double>(state_.clock.step);
    s.threads = omp_get_max_threads();
    s.state_bytes = state_.bytes();
    s.passes = state_.timer.seconds();
    write_summary(folder_, s);
  }

  void report_divergence(const Error& e) {
    progress_->finish();
    summarise("diverged");
    const auto files = list_checkpoints(folder_);
    throw Error(ExitCode::diverged,
                fmt::format("step {}, t = {:.6g} s: {}{}", state_.clock.step, state_.clock.time, e.what(),
                            files.empty() ? "" : "; the last good checkpoint is " + files.front().string()));
  }

  Scene scene_;
  std::filesystem::path folder_;
  State<Dim, Real> state_;
  std::string fingerprint_;
  Ledger ledger_;
  bool fresh_ = true;
  double next_row_ = 0;  // s
  std::int64_t last_row_step_ = -1;
  std::optional<Series> series_;
  std::optional<Progress> progress_;
  static constexpr double much_compression = 0.3;
  bool said_compression_ = false;
  std::chrono::steady_clock::time_point last_checkpoint_;
};

/// A run's state and what else its folder holds, ready to step.
template <int Dim, class Real>
Runner<Dim, Real> prepare_run(const Scene& scene, const std::filesystem::path& folder, const Features& features,
                              const Start& start, const std::string& print) {
  const Parameters<Dim> parameters = parameters_of<Dim>(scene, start);
  const std::vector<Wall<Dim>> walls = build_walls<Dim>(scene, start.spacing);
  Surroundings<Dim> around = build_surroundings(scene, start, parameters, walls);
  require_no_overlap(scene, start, walls, around.contact);
  require_open_vents(scene, start, walls, around.contact);
  for (const std::string& w : warnings_of(scene, start, walls)) say("note: {}\n", w);
  return Runner<Dim, Real>(scene, folder, make_state<Dim, Real>(features, parameters, std::move(around), start), print);
}

/// Calls f.template operator()<Dim, Real>() for the scene's dimensions and precision.
template <class F> ExitCode dispatch(const Scene& scene, F&& f) {
  const bool single = scene.numerics.precision == Precision::single;
  if (scene.dimensions == 2) return single ? f.template operator()<2, float>() : f.template operator()<2, double>();
  return single ? f.template operator()<3, float>() : f.template operator()<3, double>();
}

bool holds_run(const std::filesystem::path& folder) {
  std::error_code error;
  return std::filesystem::exists(folder / "manifest.json", error) ||
         std::filesystem::exists(folder / "checkpoints", error);
}

void make_folder(const std::filesystem::path& folder, bool overwrite) {
  if (holds_run(folder) && !overwrite)
    throw Error(ExitCode::files, folder.string() + ": already holds a run; go on with `molten resume " +
                                     folder.string() +
                                     "`, choose another folder with -o, or replace it with --overwrite");
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(ExitCode::files, folder.string() + ": cannot create the output folder: " + error.message());
}

/// Takes away what an earlier run left.
void clear_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (holds_run(folder))
    for (const char* name : {"frames", "checkpoints", "frames.hdf.series", "series.csv", "summary.json",
                             "manifest.json", "scene.toml", "walls.obj", "bodies", "pictures"})
      std::filesystem::remove_all(folder / name, error);
  std::ofstream probe(folder / "scene.toml");
  if (!probe)
    throw Error(ExitCode::files, folder.string() + ": the output folder is not writable; choose another with -o");
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw Error(ExitCode::files, file.string() + ": cannot write; check the disk");
}

void write_bodies(const std::filesystem::path& folder, const std::vector<TriangleMesh>& bodies) {
  if (!bodies.empty()) std::filesystem::create_directories(folder);
  for (std::size_t k = 0; k < bodies.size(); ++k) write_obj(folder / fmt::format("{}.obj", k), bodies[k]);
}

void set_threads(int threads) {
  if (threads > 0) omp_set_num_threads(threads);
}

}  // namespace

ExitCode run_scene(const Scene& scene, const RunOptions& options) {
  let_writes_fail();
  const Features features = features_of(scene);
  require_fields(scene, features);
  const Start start = fill_bodies(scene, features);  // meshes are read in child processes: before any threads
  const std::string print = fingerprint(scene, start);
  set_threads(options.threads);
  return dispatch(scene, [&]<int Dim, class Real>() {
    auto runner = prepare_run<Dim, Real>(scene, options.folder, features, start, print);
    make_folder(options.folder, options.overwrite);
    const RunLock lock(options.folder);
    clear_folder(options.folder);
    write_text(options.folder / "scene.toml", scene.text);
    write_obj(options.folder / "walls.obj", picture_of_walls(scene, start));
    write_bodies(options.folder / "bodies", pictures_of_bodies(scene, start));
    write_manifest(options.folder, scene, features, print);
    say("{}: {} particles, spacing {:.4g} m, {}-D, {} precision, {} threads, into {}\n",
        scene.title.empty() ? scene.file : scene.title, runner.particles(), start.spacing, Dim,
        sizeof(Real) == 4 ? "single" : "double", omp_get_max_threads(), options.folder.string());
    catch_stop_signals();
    return runner.run();
  });
}

namespace {

struct Usable {
  std::filesystem::path file;
  CheckpointHead head;
};

/// The newest checkpoint that reads well; tells of those that don't.
Usable newest_usable(const std::filesystem::path& folder) {
  std::vector<std::string> defects;
  for (const auto& file : list_checkpoints(folder)) {
    try {
      const CheckpointHead head = read_checkpoint_head(file);
      for (const std::string& defect : defects) say("warning: {}; taking the one before\n", defect);
      return {file, head};
    } catch (const Error& e) {
      defects.push_back(e.what());
    }
  }
  throw Error(ExitCode::checkpoint,
              defects.empty()
                  ? folder.string() + ": holds no checkpoint; start it again with `molten run SCENE -o " +
                        folder.string() + " --overwrite`"
                  : defects[0] + (defects.size() > 1 ? ", and no older checkpoint is whole" : "") +
                        "; start the run again with `molten run SCENE -o " + folder.string() + " --overwrite`");
}

}  // namespace

ExitCode resume_run(const ResumeOptions& options) {
  let_writes_fail();
  if (!std::filesystem::is_directory(options.folder))
    throw Error(ExitCode::checkpoint, options.folder.string() +
                                          ": no such folder; start a run with `molten run SCENE -o " +
                                          options.folder.string() + "`");
  const RunLock lock(options.folder);
  const Usable checkpoint = newest_usable(options.folder);
  const std::filesystem::path copy = options.folder / "scene.toml";
  std::ifstream in(copy, std::ios::binary);
  const std::string text = in ? std::string(std::istreambuf_iterator<char>(in), {}) : checkpoint.head.scene_text;
  Scene scene = parse_scene(text, copy.string(), options.overrides);
  scene.file = scene_file_of(options.folder);
  const Features features = features_of(scene);
  require_fields(scene, features);
  const Start start = fill_bodies(scene, features);
  set_threads(options.threads);
  const std::string print = fingerprint(scene, start);
  if (print != checkpoint.head.scene_hash && !options.force)
    throw Error(ExitCode::checkpoint,
                options.folder.string() +
                    ": the scene, a mesh or the numerics changed since the checkpoint; only [run] and "
                    "[output] may change; undo it or go on all the same with --force");
  return dispatch(scene, [&]<int Dim, class Real>() {
    auto runner = prepare_run<Dim, Real>(scene, options.folder, features, start, print);
    runner.restore(checkpoint.file);
    write_text(copy, scene.text);
    say("resuming {} from t = {:.6g} s, step {}\n", options.folder.string(), checkpoint.head.time,
        checkpoint.head.step);
    catch_stop_signals();
    if (checkpoint.head.time >= scene.run.end_time)
      say("note: that is past run.end_time = {:.6g} s; to go on: molten resume {} --set run.end_time=...\n",
          scene.run.end_time, options.folder.string());
    if (scene.run.max_steps && checkpoint.head.step >= *scene.run.max_steps)
      say("note: run.max_steps = {} are done; to go on: molten resume {} --set run.max_steps=...\n",
          *scene.run.max_steps, options.folder.string());
    return runner.run();
  });
}

}  // namespace molten
