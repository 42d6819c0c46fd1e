// Movies with a codec: MP4 and what else ffmpeg's libraries write.
#pragma once

#include "record.hpp"

namespace breve::command {

/// A movie in the format that the ending of its name says.
/// @return  null if ffmpeg's libraries are missing here or were at build time; `why` says so then
/// @throws  std::runtime_error if there is no such format, no codec for it, or the file cannot be written
std::unique_ptr<MovieWriter> open_codec_movie(const std::string& path, double fps, std::string& why);

}  // namespace breve::command
