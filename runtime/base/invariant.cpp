// The text of a failed assertion: what, and in which file, by its name alone.
#include "runtime/base/invariant.hpp"

#include <fmt/format.h>

#include <string_view>

#include "runtime/base/error.hpp"

namespace breve {

void fail_invariant(const char* what, const char* file, int line) {
  const std::string_view path(file);
  throw Error(ErrorCode::Internal, fmt::format("{} ({}:{}): this is a defect of breve; please report it", what,
                                               path.substr(path.rfind('/') + 1), line));
}

}  // namespace breve
