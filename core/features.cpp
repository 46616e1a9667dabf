#include "core/features.h"

#include <algorithm>

#include "core/error.h"

namespace molten {

namespace {

[[noreturn]] void refuse(const Scene& scene, const std::string& why) {
  throw Error(ExitCode::usage, scene.file + ": " + why);
}

void require_sense(const Scene& scene) {
  const Rheology& r = scene.fluid.rheology;
  const bool two_jumps = r.model == Rheology::Model::smd && r.jump_number[0] != r.jump_number[1];
  const bool melts = scene.fluid.heat && scene.fluid.heat->melting_range;
  if (two_jumps && !melts)
    refuse(scene,
           "fluid.rheology.jump_number: two values need [fluid.heat] with melting_range; give one value or add them");
  if (melts && r.model != Rheology::Model::smd)
    refuse(scene, "fluid.heat.melting_range: only model = \"smd\" melts; choose it or remove the range");
  for (int d = 0; d < scene.dimensions; ++d)
    if (scene.periodic[d] && !scene.domain)
      refuse(scene, "scene.periodic: a periodic axis needs scene.domain for its length");
}

}  // namespace

Features features_of(const Scene& scene) {
  require_sense(scene);
  Features f;
  f.heat = scene.fluid.heat.has_value();
  f.stress = scene.fluid.rheology.model == Rheology::Model::smd;
  f.laminar = !f.stress && scene.fluid.rheology.viscosity > 0;
  f.artificial_viscosity = scene.numerics.artificial_viscosity > 0;
  f.xsph = scene.numerics.xsph && scene.numerics.xsph->epsilon > 0;
  f.contact = !scene.boundaries.empty();
  f.bodies = std::any_of(scene.boundaries.begin(), scene.boundaries.end(),
                         [](const Boundary& b) { return b.motion || b.body; });
  f.vents = !scene.vents.empty();
  f.outflow = !scene.outflows.empty();
  f.integrator = scene.numerics.integrator;
  return f;
}

FieldSet Features::columns() const {
  FieldSet s = field_set(FieldList<Id, Position, LocalPosition, Velocity, Compression, PressureTerm, Acceleration,
                                   CompressionRate, PreviousCompressionRate>{});
  if (integrator == IntegratorKind::leap_frog) s |= field_set(FieldList<HalfVelocity, HalfCompression>{});
  if (integrator == IntegratorKind::symplectic_euler) s |= field_set(FieldList<OlderCompressionRate>{});
  if (heat) s |= field_set(FieldList<Temperature, LocalTemperature, TemperatureRate>{});
  if (stress) s |= field_set(FieldList<Viscosity, Stress>{});
  if (xsph) s |= field_set(FieldList<XsphVelocity>{});
  if (vents) s |= field_set(FieldList<Inlet>{});
  return s;
}

std::vector<std::string> Features::passes() const {
  std::vector<std::string> p;
  if (stress) p.push_back("viscosity");
  p.push_back(heat ? "forces and heat" : "forces");
  p.push_back(contact ? "integrate and collide" : "integrate");
  return p;
}

std::vector<std::string> Features::names() const {
  std::vector<std::string> n;
  if (heat) n.push_back("heat");
  if (stress) n.push_back("smd-viscosity");
  if (laminar) n.push_back("laminar-viscosity");
  if (artificial_viscosity) n.push_back("artificial-viscosity");
  if (xsph) n.push_back("xsph");
  if (contact) n.push_back("contact");
  if (bodies) n.push_back("moving-bodies");
  if (vents) n.push_back("vents");
  if (outflow) n.push_back("outflow");
  n.push_back(integrator == IntegratorKind::leap_frog ? "leap-frog" : "symplectic-euler");
  return n;
}

}  // namespace molten
