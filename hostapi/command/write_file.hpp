// A file of bytes that is written as a whole.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace breve::command {

/// Replaces the contents of the file. A file that cannot be written to its end is removed, unless it is a device.
/// @throws std::runtime_error  with the path and the system's reason
void write_file(const std::string& path, std::span<const std::uint8_t> bytes);

}  // namespace breve::command
