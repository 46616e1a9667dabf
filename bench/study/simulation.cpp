#include "bench/study/simulation.h"

#include <fmt/format.h>

#include <chrono>

#include "bench/study/scene_text.h"
#include "core/diagnostics.h"
#include "core/error.h"
#include "core/step.h"
#include "io/geometry/assemble.h"
#include "io/geometry/vents.h"
#include "io/scene/scene_file.h"

namespace molten::study {

namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

template <int Dim, class Real> State<Dim, Real> state_of(const Scene& scene, const Setup& setup) {
  Start start = setup.start;
  describe_vents(scene, start);
  const Parameters<Dim> p = parameters_of<Dim>(scene, start);
  State<Dim, Real> s = make_state<Dim, Real>(features_of(scene), p, build_surroundings(scene, start, p), start);
  if (setup.pressure.empty()) return s;
  for (std::size_t slot = 0; slot < s.particles.slots(); ++slot) {
    if (s.particles.is_padding(slot) || s.particles[id][0][slot] >= std::ssize(setup.pressure)) continue;
    const auto delta = static_cast<Real>(p.eos.compression(setup.pressure[s.particles[id][0][slot]]));
    s.particles[compression][0][slot] = delta;
    if (s.particles.has(half_compression)) s.particles[half_compression][0][slot] = delta;
  }
  prepare(s);
  return s;
}

template <int Dim, class Real> class Engine : public Simulation {
 public:
  Engine(const Scene& scene, const Setup& setup, Report& report)
      : Simulation(report), state_(state_of<Dim, Real>(scene, setup)), force_(setup.force) {
    report.dimensions = Dim;
    report.particles = static_cast<std::int64_t>(state_.particles.count());
  }

  double time() const override { return state_.clock.time; }

  Cloud cloud() const override {
    const Parameters<Dim>& p = state_.parameters;
    Cloud c;
    c.time = time();
    c.spacing = p.spacing;
    c.mass = p.particle_mass;
    c.smoothing_length = p.smoothing_length;
    c.eos = p.eos;
    const auto x = state_.particles[position];
    const auto v = state_.particles[velocity];
    const Real* held_by = state_.particles[held][0];  // null without boundary particles
    for (std::size_t slot = 0; slot < state_.particles.slots(); ++slot) {
      if (state_.particles.is_padding(slot)) continue;
      if (held_by && held_by[slot] > 0) {
        c.wall_pressure.push_back(p.eos.pressure(double(state_.particles[compression][0][slot])));
        continue;
      }
      Triple place{}, speed{};
      for (int d = 0; d < Dim; ++d) place[d] = x[d][slot], speed[d] = v[d][slot];
      const double delta = state_.particles[compression][0][slot];
      c.id.push_back(state_.particles[id][0][slot]);
      c.position.push_back(place);
      c.velocity.push_back(speed);
      c.density.push_back(p.eos.rest_density * (1 + delta));
      c.pressure.push_back(p.eos.pressure(delta));
      if (state_.features.heat) c.temperature.push_back(state_.particles[temperature][0][slot]);
    }
    c.bodies = snapshots_of(state_.bodies);
    return c;
  }

 private:
  void step(double stop) override {
    state_.clock.stop = stop;
    const double before = seconds();
    kick(state_.clock.dt / 2);
    molten::step(state_);
    kick(state_.clock.dt / 2);
    report_.wall_time += seconds() - before;
    report_.steps = state_.clock.step;
    if (state_.particles.count() == 0) throw Error(ExitCode::diverged, "all particles have left the domain");
  }

  /// The force that gravity, the same everywhere, is not; half of it on either side of a step (Strang).
  void kick(double dt) {
    if (!force_) return;
    const auto x = state_.particles[position];
    const auto v = state_.particles[velocity];
    const auto half_v = state_.particles[half_velocity];
    for (std::size_t slot = 0; slot < state_.particles.slots(); ++slot) {
      if (state_.particles.is_padding(slot)) continue;
      Triple place{};
      for (int d = 0; d < Dim; ++d) place[d] = x[d][slot];
      const Triple f = force_(place);
      for (int d = 0; d < Dim; ++d) {
        v[d][slot] += static_cast<Real>(dt * f[d]);
        if (half_v[d]) half_v[d][slot] += static_cast<Real>(dt * f[d]);
      }
    }
  }

  State<Dim, Real> state_;
  std::function<Triple(const Triple&)> force_;
};

template <int Dim> std::unique_ptr<Simulation> make_engine(const Scene& scene, const Setup& setup, Report& report) {
  if (scene.numerics.precision == Precision::single) return std::make_unique<Engine<Dim, float>>(scene, setup, report);
  return std::make_unique<Engine<Dim, double>>(scene, setup, report);
}

void push_step(Numerics& n, double factor) {
  for (double* limit : {&n.courant_sound, &n.courant_viscous, &n.courant_force, &n.courant_conduction})
    *limit *= factor;
  if (n.fixed_dt) *n.fixed_dt *= factor;
}

std::string without(std::string text, std::string_view part) {
  const std::size_t at = text.find(part);
  return at == std::string::npos ? text : text.erase(at, part.size());
}

/// The sources' presets keep their own smoothing lengths; the methods kept for replication have no support at walls.
std::string as_in_source(const std::string& preset, std::string text) {
  const bool replicates = preset == "dias" || preset == "queiroz";
  if (replicates || preset == "paiva") text = without(without(text, impact_text), driven_text);
  if (replicates)
    for (const double diffusion : {0.1, 0.2}) text = without(text, wall_support_text(diffusion));
  return text;
}

/// A case's text sets the sound speed; an ideal gas takes its square instead.
std::string text_for(const std::string& preset, std::string text) {
  constexpr std::string_view key = "sound_speed = ";
  const std::size_t at = text.find(key);
  if (preset != "queiroz" || at == std::string::npos) return text;
  const std::size_t end = text.find('\n', at);
  const double c = std::stod(text.substr(at + key.size(), end));
  return text.replace(at, end - at, fmt::format("stiffness = {:.17g}", c * c));
}

}  // namespace

std::unique_ptr<Simulation> Simulation::make(const Request& request, const Setup& setup, Report& report) {
  std::vector<std::string> overrides{fmt::format("numerics.preset=\"{}\"", request.numerics)};
  overrides.insert(overrides.end(), request.scene_overrides.begin(), request.scene_overrides.end());
  Scene scene = parse_scene(text_for(request.numerics, as_in_source(request.numerics, setup.scene)), "case", overrides);
  push_step(scene.numerics, request[step_factor]);
  if (scene.dimensions == 2) return make_engine<2>(scene, setup, report);
  return make_engine<3>(scene, setup, report);
}

void Simulation::run_until(double end, double every, const std::function<void(const Cloud&)>& probe) {
  double next = time(), told = seconds();
  const auto probe_when_due = [&] {
    if (!probe || time() < next) return;
    probe(cloud());
    while (next <= time()) next += every;
  };
  probe_when_due();
  while (time() < end) {
    step(end);
    probe_when_due();
    if (seconds() < told + 2) continue;
    told = seconds();
    fmt::print(stderr, "  t = {:.4g} of {:.4g} s, {} particles, step {}, {:.3g} s\n", time(), end, report_.particles,
               report_.steps, report_.wall_time);
  }
}

}  // namespace molten::study
