// How HDF5 writes our files. HDF5 1.10 crashes in H5Fclose after a write has failed (tried: compressed arrays on a full
// disk), so this driver never lets it see a failure: it notes the first one and ignores all further writes.
#pragma once

#include <cstdint>

namespace molten {

/// Makes files opened with this access property list write through the driver. `*first_error`, an errno or 0, must live
/// until the file is closed. False when HDF5 refuses.
bool use_careful_driver(std::int64_t access_list, int* first_error);

}  // namespace molten
