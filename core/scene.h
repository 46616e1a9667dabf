// What a run is asked to do, as plain data in SI units: the meaning of a scene file without its syntax. An absent
// optional means that the scene does not have that physics: no column, no pass, no cost (features.h draws the line).
#pragma once

#include <Eigen/Core>
#include <array>
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
};
struct Plane {
  std::array<double, 3> point{}, normal{};  // m, -; infinite; the fluid is on the side the normal points to
};
struct Terrain {
  std::string path;                             // ESRI ASCII grid (.asc) or JSON height grid {width, height, values}
  std::optional<double> cell_size;              // m between samples; required for JSON unless the file has it
  double scale = 1;                             // factor on heights
  std::optional<std::array<double, 2>> origin;  // m; x, y of the south-west sample; default: as the file has it
};

/// At most one member is set; which one says what the shape is.
struct Shape {
  std::optional<MeshFile> mesh;
  std::optional<Sphere> sphere;
  std::optional<Box> box;
  std::optional<Cylinder> cylinder;
  std::optional<Cone> cone;
  std::optional<Polygon> polygon;
  std::optional<Plane> plane;      // boundaries only
  std::optional<Terrain> terrain;  // boundaries only
  Place place;
};

// ---- fluid ------------------------------------------------------------------------------------------------------

/// Dynamic viscosity η(D, T), D = √(½ tr D²) the strain-rate magnitude.
struct Rheology {
  enum class Model { newtonian, smd } model = Model::newtonian;
  double viscosity = 0;                     // Pa s; newtonian. 0: inviscid
  double flow_index = 0.5;                  // n; smd
  std::array<double, 2> jump_number{0, 0};  // J hot, J cold ([P] 6-3: J_min, J_max); equal without heat
  double yield_stress = 1;                  // τ0, Pa
  double consistency = 1;                   // K, Pa s^n
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
};

struct Fluid {
  std::vector<Body> bodies;
  std::optional<long long> particles;  // asked number over all bodies; the spacing follows
  std::optional<double> spacing;       // m; or the spacing itself (exactly one of the two)
  double density = 1000;               // ρ0, kg/m³
  Rheology rheology;
  std::optional<Heat> heat;
  Place place;
};

// ---- boundaries -------------------------------------------------------------------------------------------------

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
enum class StateEquation { linear, tait };
enum class IntegratorKind { leap_frog, symplectic_euler };
enum class Precision { single, double_ };
enum class Resort { when_due, each_step };

struct Xsph {
  enum class Form { velocity, position } form = Form::position;
  double epsilon = 0.5;
};

struct Numerics {
  std::string preset = "molten";
  Precision precision = Precision::single;
  Resort resort = Resort::when_due;
  KernelKind kernel = KernelKind::wendland_c2;
  double smoothing_ratio = 1.3;  // smoothing length h / spacing
  double skin = 0.2;             // of the list, in spacings
  IntegratorKind integrator = IntegratorKind::leap_frog;
  StateEquation state_equation = StateEquation::tait;
  double gamma = 7;                   // Tait exponent
  std::optional<double> sound_speed;  // m/s; default 10 × the largest speed expected
  double artificial_viscosity = 0.1;  // α; 0: no term
  std::optional<Xsph> xsph;
  double courant_sound = 0.2, courant_viscous = 0.1, courant_force = 0.25, courant_conduction = 0.4;
  std::optional<double> fixed_dt;  // s; overrides the adaptive step
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
  std::string title, file, text;  // text: the file as read (after --set), stored with the run
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

}  // namespace molten
