// SIGINT and SIGTERM: the first asks the run to stop cleanly, the second ends the program at once.
#pragma once

namespace molten {

void catch_stop_signals();
bool stop_requested();

}  // namespace molten
