// In place of sound_file.cpp where breve is built without sound files.
#include <fmt/format.h>

#include "runtime/base/error.hpp"
#include "runtime/store/sound.hpp"

namespace breve {

Samples Samples::parse(std::string_view, const std::string& name, std::pmr::memory_resource*, const Poll&) {
  throw Error(ErrorCode::File,
              fmt::format("cannot read sound file '{}': sound files are not a part of this breve: it was built with "
                          "BREVE_WITH_SOUND_FILES=OFF",
                          name));
}

}  // namespace breve
