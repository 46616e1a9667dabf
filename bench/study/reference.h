// Measured and published series, from the folder that the environment variable MOLTEN_REFERENCE names.
#pragma once

#include <optional>
#include <string>

#include "bench/study/metrics.h"

namespace molten::study {

/// Two columns of a CSV file, by name; lines that start with # are comments. Empty, with a word on stderr, where there
/// is no folder; Error(files) for a file that is there and cannot be used.
std::optional<Series> reference(const std::string& file, const std::string& abscissa, const std::string& ordinate);

}  // namespace molten::study
