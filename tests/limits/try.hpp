// One call of a host in a part: goes on if it works, and notes where it stood if not.
#pragma once

#define TRY(call_of_host)                     \
  do {                                        \
    run.status = (call_of_host);              \
    run.call = #call_of_host;                 \
    run.file = __FILE__;                      \
    run.line = __LINE__;                      \
    if (run.status != BREVE_OK) return false; \
  } while (false)
