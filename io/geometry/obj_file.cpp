#include "io/geometry/obj_file.h"

#include <fmt/format.h>
#include <fmt/os.h>

#include <fstream>

#include "core/error.h"

namespace molten {

void write_obj(const std::filesystem::path& file, const TriangleMesh& mesh) {
  std::string text = "# walls of the run, for pictures (m)\n";
  for (const Vec3& v : mesh.vertices) text += fmt::format("v {} {} {}\n", v[0], v[1], v[2]);
  for (const auto& t : mesh.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw Error(ExitCode::files, file.string() + ": cannot write; check the disk");
}

}  // namespace molten
