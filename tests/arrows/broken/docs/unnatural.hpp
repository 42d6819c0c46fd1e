// A comment that goes on over
// two lines and is no sentence.
#pragma once

inline const char* message() { return "the value is no number"; }  // as F27 says (F27)
constexpr int kOfBolt = 4;                                         // turns: it is drawn tight
constexpr int kOfNut = 5;                                          // as long as four turns of a loop
