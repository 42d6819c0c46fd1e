// Assertions about our own code. They hold in every build, and one that fails never stops the host's process.
#pragma once

namespace breve {

/// @throws Error{Internal}: `what` is not as the code around it needs, and `file` says where
[[noreturn]] void fail_invariant(const char* what, const char* file, int line);

/// What only a mistake of ours makes false; for what input makes false there are other errors. A host gets
/// BREVE_ERROR_INTERNAL. Not for functions that may not throw: destructors, and what is noexcept.
inline void invariant(bool holds, const char* what, const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  if (!holds) [[unlikely]]
    fail_invariant(what, file, line);
}

}  // namespace breve
