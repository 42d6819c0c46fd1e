// Pictures of a world that its own scripts ask for.
#pragma once

#include <string>
#include <string_view>

#include "steve/machine/machine.hpp"

namespace breve::steve {

/// Write the view as a PNG file, "NAME_00012.png" for 12. False with a warning that names `selector` if nothing draws
/// this world, or the file cannot be written.
bool write_frame(Machine& machine, std::string_view name, std::int64_t number, std::string_view selector);

}  // namespace breve::steve
