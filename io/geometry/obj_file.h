// Writing triangle meshes as OBJ, full precision.
#pragma once

#include <filesystem>

#include "core/boundary/triangle_mesh.h"

namespace molten {

/// Throws Error(files).
void write_obj(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace molten
