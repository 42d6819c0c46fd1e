// Which writer a format has; animated GIF.
#include "runtime/movie/movie.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "runtime/base/error.hpp"
#include "runtime/movie/codec.hpp"
#include "runtime/movie/gif.hpp"

namespace breve::movie {

namespace {

class GifMovie final : public Movie {
 public:
  GifMovie(const Settings& settings, Output& output) : settings_(settings), output_(output) {
    // The unit is a hundredth of a second, and players show slowly what is shorter than two of them.
    delay_ = static_cast<std::uint16_t>(std::clamp(std::lround(100 / settings.fps), 2L, 60000L));
  }
  void add(std::span<const std::uint8_t> rgba) override {
    bytes_.clear();
    begin();
    gif_->add(rgba, bytes_);
    write();
  }
  void finish() override {
    bytes_.clear();
    begin();
    GifEncoder::end(bytes_);
    write();
  }

 private:
  void begin() {
    if (!gif_)
      gif_.emplace(static_cast<std::uint32_t>(settings_.width), static_cast<std::uint32_t>(settings_.height), delay_,
                   bytes_);
  }
  void write() { output_.write(output_.size(), bytes_); }

  Settings settings_;
  Output& output_;
  std::uint16_t delay_ = 4;
  std::optional<GifEncoder> gif_;
  std::vector<std::uint8_t> bytes_;
};

void check(const Settings& settings) {
  if (settings.width < 1 || settings.height < 1 || settings.width > kMostSide || settings.height > kMostSide)
    throw Error(ErrorCode::Argument,
                fmt::format("a movie of {} x {} pixels cannot be made: each side must be from 1 to {}", settings.width,
                            settings.height, kMostSide));
  if (!(settings.fps >= kLeastFps && settings.fps <= kMostFps))
    throw Error(ErrorCode::Argument,
                fmt::format("fps is {} (must be from {} to {})", settings.fps, kLeastFps, kMostFps));
}

}  // namespace

std::unique_ptr<Movie> open(const Settings& settings, Output& output) {
  check(settings);
  if (settings.format == "gif") return std::make_unique<GifMovie>(settings, output);
  return open_codec(settings, output);
}

bool has_format(const std::string& format, std::string& why) {
  try {
    MemoryOutput nowhere;
    open({format, 16, 16, 25}, nowhere);
    return true;
  } catch (const Error& error) {
    why = error.what();
    return false;
  }
}

}  // namespace breve::movie
