// Movies without a codec: animated GIF, and numbered PNGs for any program that makes movies of them. The others are in
// movie_codec.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "gif.hpp"
#include "movie_codec.hpp"
#include "record.hpp"

namespace breve::command {

namespace {

class GifMovie final : public MovieWriter {
 public:
  GifMovie(std::string path, double fps) : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
    if (!file_) fail();
    // The unit is a hundredth of a second, and what is shorter than two of them is shown slowly.
    delay_ = static_cast<std::uint16_t>(std::clamp(std::lround(100 / fps), 2L, 60000L));
  }
  ~GifMovie() override {
    if (file_) std::fclose(file_);
  }
  GifMovie(const GifMovie&) = delete;
  GifMovie& operator=(const GifMovie&) = delete;

  void add(const Frame& frame) override {
    bytes_.clear();
    if (!gif_) gif_.emplace(frame.width, frame.height, delay_, bytes_);
    gif_->add(frame.rgba, bytes_);
    write();
  }
  void finish() override {
    bytes_.clear();
    if (gif_) gif_->end(bytes_);
    write();
    std::FILE* file = file_;
    file_ = nullptr;
    if (std::fclose(file) != 0) fail();
  }

 private:
  void write() {
    if (std::fwrite(bytes_.data(), 1, bytes_.size(), file_) != bytes_.size()) fail();
  }
  [[noreturn]] void fail() const {
    throw std::runtime_error(fmt::format("cannot write {}: {}", path_, std::strerror(errno)));
  }

  std::string path_;
  std::FILE* file_;
  std::uint16_t delay_ = 4;
  std::optional<GifEncoder> gif_;
  std::vector<std::uint8_t> bytes_;
};

class Frames final : public MovieWriter {
 public:
  explicit Frames(std::string directory) : directory_(std::move(directory)) {
    std::error_code error;
    std::filesystem::create_directories(directory_, error);
    if (error) throw std::runtime_error(fmt::format("cannot make {}: {}", directory_, error.message()));
  }
  void add(const Frame& frame) override { write_png(frame, fmt::format("{}/frame_{:05}.png", directory_, number_++)); }
  void finish() override {}

 private:
  std::string directory_;
  int number_ = 0;
};

}  // namespace

std::unique_ptr<MovieWriter> open_movie(const std::string& path, double fps, Output& output) {
  if (path.ends_with(".gif")) return std::make_unique<GifMovie>(path, fps);
  if (path.ends_with("/")) return std::make_unique<Frames>(path.substr(0, path.size() - 1));
  std::string why;
  if (auto movie = open_codec_movie(path, fps, why)) return movie;
  const std::string directory = path + ".frames";
  output.complain(
      fmt::format("breve: {3}, so the frames go to {0} as numbered pictures.\n"
                  "       To pack them: ffmpeg -framerate {1} -i {0}/frame_%05d.png {2}\n",
                  directory, fps, path, why));
  return std::make_unique<Frames>(directory);
}

}  // namespace breve::command
