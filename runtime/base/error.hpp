// The one exception of the library. The C API turns it into a status and a text; nothing else is thrown on purpose.
#pragma once

#include <stdexcept>
#include <string>

namespace breve {

enum class ErrorCode {
  Argument,  // a value that the callee cannot accept: NaN, negative mass, wrong size
  Stale,     // an id that names nothing any more
  Busy,      // a call that may not be made from where it was made
  Memory,    // the memory limit is reached
  Script,    // a run-time error in a script
  Compile,   // a program that does not compile
  Budget,    // a call that used up its budget
  Depth,     // calls nested too deeply
  Image,     // a damaged or foreign snapshot image
  File,      // a file that cannot be read or written
  Unsupported,
  Interrupted,  // a call that the host asked to stop
  Reload,       // a program that cannot take the place of the running one
  Internal,     // something that only a defect of this library makes happen: see invariant.hpp
  Numeric,      // an equation without a usable solution: a singular inertia, a step size that shrinks to nothing
};

class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& what) : std::runtime_error(what), code_(code) {}
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace breve
