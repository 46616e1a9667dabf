// What a run is asked to do, as plain data in SI units: the meaning of a scene file without its syntax. An absent
// optional means that the scene does not have that physics: no column, no pass, no cost (features.h draws the line).
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace molten {

/// Where a thing stands in the scene file, for messages. line 0: not from a file.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
};

// ---- shapes: each exactly one of the forms ----------------------------------------------------------------------

struct MeshFile {
  std::string path;              // OBJ, STL, PLY; relative to the scene's folder, then scenes/
  std::optional<double> height;  // m; scales the mesh uniformly to this extent along the up axis
  std::array<double, 3>
      position{};       // m; where the middle of the mesh's base goes, when `height` or `position` is given
  bool placed = false;  // position was given
  std::array<double, 3> rotation{};  // degrees about x, then y, then z, before scaling and placing
  Place place;
};
struct Sphere {
  std::array<double, 3> center{};  // m
  double radius = 0;               // m
};
struct Box {
  std::array<double, 3> min{}, max{};  // m
};
struct Cylinder {
  std::array<double, 3> base{};   // m; centre of the lower disc; the axis is z (y in 2-D)
  double radius = 0, height = 0;  // m
};
struct Cone {
  std::array<double, 3> base{};                   // m
  double radius = 0, top_radius = 0, height = 0;  // m
};
struct Polygon {
  std::vector<std::array<double, 2>> points;  // m; counter-clockwise; in 2-D the region itself, in 3-D in the x-y plane
  double bottom = 0, top = 0;                 // m; extruded from z = bottom to z = top (3-D only)
  bool open = false;                          // without the edge from the last point to the first (2-D boundaries)
};
struct Text {
  std::string string;                // UTF-8, one line
  std::string font;                  // TrueType or OpenType file; beside the scene or among the system's fonts
  double height = 0, depth = 0;      // m; extent of the upright letters along z, and along y
  std::array<double, 3> position{};  // m; where the middle of the text's base goes
  std::array<double, 3> rotation{};  // degrees about x, then y, then z, before placing
};
struct Plane {
  std::array<double, 3> point{}, normal{};  // m, -; infinite; the fluid is on the side the normal points to
};
struct Terrain {
  std::string path;                             // ESRI ASCII grid (.asc) or JSON height grid {width, height, values}
  std::optional<double> cell_size;              // m between samples; required for JSON unless the file has it
  double scale = 1;                             // factor on heights
  std::optional<std::array<double, 2>> origin;  // m; x, y of the south-west sample; default: as the file has it
  Place place;
};

/// At most one member is set; which one says what the shape is.
struct Shape {
  std::optional<MeshFile> mesh;
  std::optional<Sphere> sphere;
  std::optional<Box> box;
  std::optional<Cylinder> cylinder;
  std::optional<Cone> cone;
  std::optional<Polygon> polygon;
  std::optional<Text> text;
  std::optional<Plane> plane;      // boundaries only
  std::optional<Terrain> terrain;  // boundaries only
  Place place;
};

// ---- fluid ------------------------------------------------------------------------------------------------------

/// What a viscosity is multiplied with at a temperature.
struct ThermalViscosity {
  enum class Kind { arrhenius, vft } kind = Kind::arrhenius;
  double activation_temperature = 0, reference_temperature = 1;  // K; exp(E/R (1/T − 1/T_r))
  double a = 0, b = 0, c = 0;                                    // 10^(A + B/(T − C)), the scene's temperature unit
};

/// Dynamic viscosity η(D, T), D = √(½ tr D²) the strain-rate magnitude (physics/rheology.h, physics/flow_curve.h).
struct Rheology {
  enum class Model { newtonian, smd, power_law, bingham, herschel_bulkley, cross, carreau } model = Model::newtonian;
  double viscosity = 0;                       // Pa s; newtonian (0: inviscid), bingham; cross, carreau: at rest
  double flow_index = 0.5;                    // n
  std::array<double, 2> jump_number{0, 0};    // J hot, J cold ([P] 6-3: J_min, J_max); equal without heat
  double yield_stress = 1;                    // τ0, Pa
  double consistency = 1;                     // K, Pa s^n
  double regularisation = 0;                  // m, s; bingham, herschel_bulkley
  double fast_viscosity = 0;                  // η∞, Pa s; cross, carreau
  double relaxation_time = 0;                 // λ, s; cross, carreau
  double largest_viscosity = 1e30;            // Pa s; all but smd
  std::optional<ThermalViscosity> thermal{};  // all but smd

  /// The viscosity is the same everywhere and always.
  bool constant() const { return model == Model::newtonian && !thermal; }
};

struct Heat {
  double diffusivity = 0;                              // k, m²/s
  std::optional<std::array<double, 2>> melting_range;  // T_min, T_max of [P] 6-3, the scene's temperature unit
  double initial_bottom = 0, initial_top = 0;          // linear in height over the fluid's extent at the start
};

/// One body of the fluid: a region filled with particles.
struct Body {
  Shape shape;
  std::array<double, 3> velocity{};   // m/s at the start
  std::optional<double> temperature;  // overrides Heat::initial_* for this body
  std::optional<double> diffusivity;  // m²/s; overrides Heat::diffusivity: its conductivity differs
};

struct Fluid {
  std::vector<Body> bodies;
  std::optional<long long> particles;  // asked number over all bodies; the spacing follows
  std::optional<double> spacing;       // m; or the spacing itself (exactly one of the two)
  double density = 1000;               // ρ0, kg/m³
  bool hydrostatic = false;            // starts with the pressure of a fluid at rest below its highest point
  Rheology rheology;
  std::optional<Heat> heat;
  Place place;
};

// ---- boundaries -------------------------------------------------------------------------------------------------

/// What heat has to pass on its way to a wall's temperature.
struct GroundLayer {
  double diffusivity = 0;  // m²/s: its conductivity over the fluid's density and heat capacity
  double thickness = 0;    // m
};

/// A boundary that moves as it is told.
struct Movement {
  std::array<double, 3> velocity{};               // m/s
  std::array<double, 3> spin{};                   // degrees/s, about the axes; 2-D: z
  std::vector<std::array<double, 7>> key_frames;  // s, m (3), degrees (3): time, shift, turn; instead of the former
  std::optional<std::array<double, 3>> centre;    // m; what it turns about; default: the middle of its bounding box
};

/// A boundary that gravity and the fluid drive: a rigid body.
struct FreeBody {
  double density = 0;                // kg/m³
  std::array<double, 3> velocity{};  // m/s at the start
  std::array<double, 3> spin{};      // degrees/s at the start; 2-D: z
};

struct Boundary {
  Shape shape;
  std::optional<Movement> motion;  // at most one of the two
  std::optional<FreeBody> body;
  double restitution = 0;  // what the normal velocity keeps, reversed
  double slip = 0;         // what the tangential velocity keeps: 0 no-slip, 1 free slip
  // Either makes the wall hold what touches it up to a stress and drag with that stress beyond, instead of slip:
  std::optional<double> friction;      // Coulomb's coefficient; tangential over normal stress
  std::optional<double> yield_stress;  // Pa; sticks up to it, whatever the normal stress
  std::array<double, 3> velocity{};    // m/s, of the surface along the wall, which itself stays where it is
  std::optional<double> temperature;   // of the surface, the scene's unit; none: insulating; with wall support
  std::optional<GroundLayer> ground;   // between the surface and that temperature
  bool inside = false;     // closed shapes: true = a container, the fluid is inside; false = an obstacle, outside
  bool two_sided = false;  // meshes and terrain: holds from behind, too
};

// ---- sources and sinks --------------------------------------------------------------------------------------------

/// Fluid enters at right angles through a flat patch; the wall behind it, if any, lets it pass.
struct Vent {
  std::array<double, 3> centre{}, normal{0, 0, 1};  // m, -; the way the fluid goes; 2-D: x, y
  double radius = 0;                                // m; of a disc (2-D: half the width of a slit); 0 with a mesh
  std::optional<MeshFile> mesh;                     // an open patch instead of the disc; centre and normal are its own
  struct Entry {
    double time = 0;  // s
    double rate = 0;  // m³/s (2-D: m²/s)
    double temperature = 0;
  };
  std::vector<Entry> table;  // at least one, by time; linear between, constant before and after
  Place place;
};

// ---- numerics ---------------------------------------------------------------------------------------------------

enum class KernelKind { gaussian, quadratic, cubic_spline, wendland_c2, lucy, poly6, spiky };
enum class StateEquation { linear, tait, ideal_gas };
enum class DensityForm { continuity, summation };
enum class IntegratorKind {
  leap_frog,
  symplectic_euler,
  explicit_euler,
  midpoint,
  predictor_corrector,
  runge_kutta_4,
  energy_bounded_euler
};
enum class ViscosityForm { morris, monaghan, muller };
enum class StressForm { summed, pairwise };
enum class LaplacianForm { conservative, consistent };
enum class Precision { single, double_ };
enum class Resort { when_due, each_step };

struct Xsph {
  enum class Form { velocity, position } form = Form::position;
  double epsilon = 0.5;
  bool neighbour_density = false;  // weight m/ρ_j ([Q]), which loses momentum, instead of m/ρ̄
};

struct Shifting {
  double strength = 7;  // C of δv = −C U h Σ V ∇W
  double coupling = 1;  // κ of the rate κ U/h at which the density takes on that of the particles' places; 0: not
};

struct DensityFilter {
  enum class Kind { shepard, mls } kind = Kind::shepard;
  long long every = 30;  // steps
};

/// Walls made of particles, for replication (boundary/boundary_particles.h).
struct BoundaryParticles {
  enum class Kind { dynamic, repulsive } kind = Kind::dynamic;
  long long every = 1;  // steps; how often the dynamic ones' density follows its rate
};

/// Bounds within which a particle is at rest; defaults from the scene (parameters.cpp).
struct SleepBounds {
  std::optional<double> speed;             // m/s
  std::optional<double> density_rate;      // 1/s; rate of density over the rest density
  std::optional<double> temperature_rate;  // K/s
  std::optional<double> temperature;       // K; by which one at rest may change where the viscosity varies
  std::optional<double> after;             // s at rest before a particle may sleep
};

struct Numerics {
  std::string preset = "molten";
  Precision precision = Precision::single;
  Resort resort = Resort::when_due;
  KernelKind kernel = KernelKind::wendland_c2;
  double smoothing_ratio = 1.3;  // smoothing length h / spacing
  double skin = 0.3;             // of the list, in spacings
  IntegratorKind integrator = IntegratorKind::leap_frog;
  StateEquation state_equation = StateEquation::tait;
  double gamma = 7;                   // Tait exponent
  std::optional<double> sound_speed;  // m/s; default 10 × the largest speed expected
  double artificial_viscosity = 0.1;  // α; 0: no term
  bool particle_sound_speed = false;  // c_i in the artificial viscosity; Tait with γ = 7
  bool tensile_correction = false;
  ViscosityForm viscosity_form = ViscosityForm::morris;  // of a constant viscosity
  StressForm stress_form = StressForm::summed;           // of a viscosity that varies
  bool internal_energy = false;
  std::optional<Xsph> xsph;
  std::optional<double> stiffness;  // k of the ideal gas, m²/s²; default: the square of the sound speed's default
  std::optional<KernelKind> density_kernel;  // of the summation; default: the kernel
  bool half_pressure = false;                // [Q]'s force, half of the pressure's gradient
  bool energy_surplus = true;                // energy_bounded_euler hands on what particles leave of their bounds
  DensityForm density = DensityForm::continuity;
  std::optional<DensityFilter> density_filter;
  bool gradient_correction = false;
  LaplacianForm laplacian = LaplacianForm::conservative;  // of conduction and constant viscosity
  std::optional<Shifting> shifting;                       // needs gradient_correction
  double courant_sound = 0.2, courant_viscous = 0.1, courant_force = 0.25, courant_conduction = 0.4;
  double density_diffusion = 0;  // δ of δ-SPH; 0: no term
  bool wall_support = false;     // walls make up for what they cut off a particle's support
  std::optional<BoundaryParticles> boundary_particles;
  std::optional<double> fixed_dt;  // s; overrides the adaptive step
  long long time_step_levels = 0;  // powers of two by which a step may exceed the smallest stable viscous one
  std::optional<SleepBounds> sleep;
};

// ---- the whole --------------------------------------------------------------------------------------------------

struct Run {
  double end_time = 0;                 // s
  std::optional<long long> max_steps;  // stop early, for measuring
};

struct Output {
  double frames_per_second = 25;    // 0: none
  std::vector<std::string> fields;  // empty: all that the scene has
  double series_every = 0;          // s; 0: with the frames
  double checkpoint_every = 300;    // s of wall time; 0: only at the end and on signals
  int checkpoints_kept = 2;
};

struct Scene {
  std::string title, file, text;                     // text: the file as read (after --set), stored with the run
  std::map<std::string, Place, std::less<>> places;  // of its keys by their full names, such as "boundary.0.slip"
  int dimensions = 3;
  std::array<double, 3> gravity{0, 0, -9.81};  // m/s²; 2-D: x, y
  std::array<bool, 3> periodic{};              // per axis; needs the domain
  std::optional<Box> domain;                   // particles that leave it are removed; default: generous bounding box
  Fluid fluid;
  std::vector<Boundary> boundaries;
  std::vector<Vent> vents;
  std::vector<Plane> outflows;  // what has passed one, to where its normal points, is removed
  Numerics numerics;
  Run run;
  Output output;
};

/// "file:line:column", or the file alone.
std::string text_of(const Place& place);

/// Throws Error(usage): one line with where the key, or the table that it would be in, stands, the key, and why.
[[noreturn]] void refuse(const Scene& scene, const std::string& key, const std::string& why);

}  // namespace molten
