// Looks over a mesh file before assimp reads it. assimp makes the best of a damaged file; here a truncated one is
// refused.
#pragma once

#include <cstddef>
#include <string>

namespace molten {

struct FacesInFile {
  std::size_t faces = 0;  // triangles and other polygons
  bool only_triangles = true;
};

// Each throws std::runtime_error with what is wrong (without the file's name): a bad header, fewer data than promised,
// a face that names a missing vertex, a coordinate that is no sensible number, no faces.

/// Blanks the references to material files in `text`, so that nothing but the file itself is read.
FacesInFile check_obj(std::string& text);
FacesInFile check_stl(const std::string& bytes);
FacesInFile check_ply(const std::string& bytes);
/// Binary glTF: the chunks; how often its meshes stand in the scene is left to the reader.
FacesInFile check_glb(const std::string& bytes);

}  // namespace molten
