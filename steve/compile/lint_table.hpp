// The warnings that can be turned off, each with its code. Codes are stable: programs, editors and hosts name them.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>

#include "steve/syntax/diagnostic.hpp"

namespace breve::steve {

struct Lint {
  std::string_view code;
  Severity severity;         // Warning: most likely a mistake; Note: only worth a look
  std::string_view summary;  // one line: what it finds
};

/// All of them, in order of their codes.
std::span<const Lint> lints();
const Lint* find_lint(std::string_view code);  // null if there is none

using AllowedLints = std::set<std::string, std::less<>>;

/// What the compiler has to say, as people read it: in order of files and places; without the lints that are turned
/// off by `allowed` or by a comment `# allow: CODE, CODE` on their line, on a line of its own before it, or, for the
/// whole file, before anything else in it. Says so where such a comment names no lint.
Diagnostics finished(const Diagnostics& all, const Sources& sources, const AllowedLints& allowed);

}  // namespace breve::steve
