// Movies with a codec: MP4 and what else ffmpeg's libraries write.
#pragma once

#include "runtime/movie/movie.hpp"

namespace breve::movie {

/// As `open`, which has checked the numbers.
std::unique_ptr<Movie> open_codec(const Settings& settings, Output& output);

}  // namespace breve::movie
