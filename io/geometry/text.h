// Letters as closed surfaces: their outlines come from a font file, read by FreeType.
#pragma once

#include <filesystem>

#include "core/boundary/triangle_mesh.h"
#include "core/scene.h"

namespace molten {

/// Where the text's font is: where the scene says, else the file of that name among the system's fonts. Throws
/// Error(geometry) when there is none. `place`: for the message.
std::filesystem::path find_font(const Scene& scene, const Text& text, const Place& place);

/// The text of the shape standing up: it reads along x, its front is towards −y, its extents along z and y are `height`
/// and `depth`; not yet turned or placed. Throws Error(geometry) with the scene's line when the font can't be read,
/// lacks a letter, or has outlines that cross.
TriangleMesh extrude_text(const Scene& scene, const Shape& shape);

}  // namespace molten
