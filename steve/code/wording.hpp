// How messages write methods: the same words at compile time and at run time.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "steve/code/bytecode.hpp"
#include "steve/code/program.hpp"

namespace breve::steve {

/// "float", "Bird object", ...
std::string type_words(const ParameterInfo& parameter, const SymbolTable& symbols);
/// "at (vector), with-power (float, may be left out)"; "no keywords" if there are none.
std::string keyword_words(const MethodInfo& method, const SymbolTable& symbols);
/// "at" and "at and with-power" and "at, over and with-power".
std::string joined(const std::vector<std::string>& words);
/// The error in a call that a method of that name does not accept.
struct CallFault {
  enum class Kind { UnknownKeyword, RepeatedKeyword, MissingKeyword } kind;
  std::string message, help;
  Span span;  // of the keyword, if one is written
};
/// @param call  the source of the call, from its receiver on; "" if it is not known
CallFault call_fault(const CallSite& site, const MethodInfo& method, const SymbolTable& symbols, const Sources& sources,
                     const Span& call);
/// The help for a name that a class does not answer to: a near name, a variable of that name, the classes that do.
/// @param start  the class that is asked, null for a root class's parent
std::string unknown_method_help(std::string_view name, const ClassInfo* start, const Program& program);

}  // namespace breve::steve
