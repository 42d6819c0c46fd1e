// A comment that goes on over
// two lines and is no sentence.
#pragma once

inline const char* message() { return "the value is no number"; }  // as F27 says (F27)
