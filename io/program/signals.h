// SIGINT, SIGTERM and SIGHUP: the first asks the run to stop cleanly, the second ends the program at once.
#pragma once

namespace molten {

void catch_stop_signals();
/// Goes on when nobody reads any more what the program says.
void outlive_readers();
bool stop_requested();

}  // namespace molten
