// SIGINT, SIGTERM and SIGHUP: the first asks the run to stop cleanly, the second ends the program at once. SIGXCPU,
// which comes again every second once the limit of CPU time is reached, asks for the same.
#pragma once

namespace molten {

void catch_stop_signals();
/// What nobody reads any more and what is beyond the limit of a file's size are errors of writing, no end of the
/// program.
void let_writes_fail();
bool stop_requested();

}  // namespace molten
