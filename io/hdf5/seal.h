// A seal over a whole file: its first 512 bytes say in plain text what it is, how long and with which hash, so that one
// flipped bit anywhere, or a missing end, is found before anything else looks at the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace molten {

constexpr std::uint64_t seal_bytes = 512;  // also the smallest user block that HDF5 leaves free

/// Fills in the seal of a finished file whose first `seal_bytes` are free. Throws Error(files).
void seal(const std::filesystem::path& file, const std::string& kind, int format);

/// Empty when the file is whole and of this kind and format, else the reason why not.
std::string seal_defect(const std::filesystem::path& file, const std::string& kind, int format);

}  // namespace molten
