// The command line of the study: from words to a request, and from a report to CSV.
#pragma once

#include <string>
#include <vector>

#include "bench/study/case.h"

namespace molten::study {

/// The case of this name. Throws Error(usage) with the nearest name.
const Case& find_case(const std::string& name);

/// A request with the case's defaults and what was given. `settings` are key=value: a parameter of the case, or a key
/// of the scene with its table (numerics.*, boundary.*). Throws Error(usage).
Request make_request(const Case& chosen, const std::string& size, const std::string& numerics,
                     const std::vector<std::string>& settings);

/// The header line and one line a quantity.
std::string csv_header();
std::string csv_lines(const Case& chosen, const Request& request, const Report& report);

/// Runs the case; a run that diverges keeps its lines with errors that are not a number, and says why on stderr.
/// Returns false when it diverged.
bool run_case(const Case& chosen, const Request& request, Report& report);

/// The table of all cases: size, parameters with defaults, in Markdown.
std::string cases_page();

}  // namespace molten::study
