# Writes version.h with the version and the commit, touching it only when they change.
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD OUTPUT_VARIABLE COMMIT ERROR_QUIET
                OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT COMMIT)
  set(COMMIT "unknown")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[#pragma once
#define MOLTEN_VERSION "@VERSION@"
#define MOLTEN_COMMIT "@COMMIT@"
#define MOLTEN_FLAGS "@FLAGS@"
]] @ONLY)
