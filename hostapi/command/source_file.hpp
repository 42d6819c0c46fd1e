// Reading a source file: plain or compressed by gzip.
#pragma once

#include <filesystem>
#include <string>

namespace breve::command {

/// The text of a file; one that starts with gzip's magic number is unpacked.
/// @throws std::runtime_error that says what is wrong: cannot be read, a directory, cut off, too large
std::string read_source(const std::filesystem::path& path);

}  // namespace breve::command
