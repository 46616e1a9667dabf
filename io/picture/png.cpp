#include <png.h>

#include "core/error.h"
#include "io/hdf5/atomic_file.h"
#include "io/picture/render.h"

namespace molten {

void write_png(const Picture& picture, const std::filesystem::path& path) {
  AtomicFile file(path);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  if (!png_image_write_to_file(&image, file.temporary().c_str(), 0, picture.rgb.data(), 0, nullptr))
    throw Error(ExitCode::files, path.string() + ": cannot write the picture: " + image.message);
  file.commit();
}

}  // namespace molten
