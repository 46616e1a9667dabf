// A run of the solver for the cases: dimensions and precision are the scene's, so that cases are written once.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/study/case.h"
#include "core/parameters.h"
#include "core/physics/pressure.h"
#include "core/snapshot.h"

namespace molten::study {

using Triple = std::array<double, 3>;

/// Every particle of the fluid at one moment; z = 0 in 2-D.
struct Cloud {
  double time = 0, spacing = 0;            // s, m
  EquationOfState eos;
  double mass = 0, smoothing_length = 0;   // of a particle, kg (2-D: kg/m); m
  std::vector<std::int64_t> id;            // place in Setup::start
  std::vector<Triple> position, velocity;  // m, m/s
  std::vector<double> density, pressure;   // kg/m³, Pa
  std::vector<double> temperature;         // empty without heat
  std::vector<double> wall_pressure;       // Pa, of boundary particles
  std::vector<SnapshotBody> bodies;

  std::size_t count() const { return id.size(); }
};

/// What a case starts from.
struct Setup {
  std::string scene;             // TOML; the request's numerics override it. The fluid's shape is a stand-in
  Start start;                   // the particles
  std::vector<double> pressure;  // Pa, of each; empty: the rest density
  std::function<Triple(const Triple&)> force;  // m/s², a body force that depends on the place; empty: none
};

class Simulation {
 public:
  /// Throws Error(usage) for numerics that the scene refuses.
  static std::unique_ptr<Simulation> make(const Request& request, const Setup& setup, Report& report);
  virtual ~Simulation() = default;

  virtual double time() const = 0;  // s
  virtual Cloud cloud() const = 0;

  /// Steps to exactly this time (s).
  void run_until(double end) { run_until(end, 0, {}); }
  /// The same; calls `probe` at the start, and after the first step at or past each multiple of `every` (s).
  void run_until(double end, double every, const std::function<void(const Cloud&)>& probe);

 protected:
  virtual void step(double stop) = 0;
  explicit Simulation(Report& report) : report_(report) {}

  Report& report_;
};

}  // namespace molten::study
