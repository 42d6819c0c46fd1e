// Movies: pictures one after the other, packed into a file.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "runtime/movie/output.hpp"

namespace breve::movie {

struct Settings {
  std::string format;  // the ending of a file's name, without the dot: "mp4", "mkv", "webm", "avi", "mpeg", "gif"
  int width = 0, height = 0;  // pixels, 1 to kMostSide. Codecs round them down to even numbers
  double fps = 25;            // pictures in a second, as they are added
};

constexpr int kMostSide = 16384;
constexpr double kLeastFps = 0.01, kMostFps = 1000;

class Movie {
 public:
  virtual ~Movie() = default;
  /// @param rgba  rows from the top, 4 bytes a pixel; alpha does not count
  /// @throws Error{File}
  virtual void add(std::span<const std::uint8_t> rgba) = 0;
  /// Writes what is left. Nothing is added afterwards. @throws Error{File}
  virtual void finish() = 0;
};

/// @throws Error{Argument} for a size, a rate or a format that does not exist; Error{Unsupported} if the libraries of
/// ffmpeg, or the codec, are missing here
std::unique_ptr<Movie> open(const Settings& settings, Output& output);

/// Whether a movie of this format can be made at all, wherever it goes. @param why  says why not
bool has_format(const std::string& format, std::string& why);

}  // namespace breve::movie
