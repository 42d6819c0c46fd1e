// Movies of the command: by breve_movie, and numbered PNGs for any program that makes movies of them.
#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "record.hpp"

namespace breve::command {

namespace {

class PackedMovie final : public MovieWriter {
 public:
  PackedMovie(breve_runtime* runtime, std::string path, double fps, std::uint32_t width, std::uint32_t height)
      : runtime_(runtime) {
    breve_movie_config config = breve_movie_config_default();
    config.width = width;
    config.height = height;
    config.fps = fps;
    config.path = path.c_str();
    status_ = breve_movie_create(runtime, &config, &movie_);
  }
  ~PackedMovie() override { breve_movie_destroy(movie_); }
  PackedMovie(const PackedMovie&) = delete;
  PackedMovie& operator=(const PackedMovie&) = delete;

  breve_status status() const { return status_; }
  std::string why() const {
    const breve_error* const error = breve_runtime_last_error(runtime_);
    return error ? error->message : breve_status_name(status_);
  }
  void add(const Frame& frame) override { need(breve_movie_add(movie_, frame.rgba.data(), 0)); }
  void finish() override { need(breve_movie_finish(movie_)); }

 private:
  void need(breve_status status) {
    status_ = status;
    if (status != BREVE_OK) throw std::runtime_error(why());
  }
  breve_runtime* runtime_;
  breve_movie* movie_ = nullptr;
  breve_status status_;
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

std::unique_ptr<MovieWriter> open_movie(breve_runtime* runtime, const std::string& path, const MovieSize& size,
                                        Output& output) {
  if (path.ends_with("/")) return std::make_unique<Frames>(path.substr(0, path.size() - 1));
  auto movie = std::make_unique<PackedMovie>(runtime, path, size.fps, size.width, size.height);
  if (movie->status() == BREVE_OK) return movie;
  if (movie->status() != BREVE_ERROR_UNSUPPORTED)
    throw std::runtime_error(movie->status() == BREVE_ERROR_ARGUMENT ? fmt::format("--movie {}: {}", path, movie->why())
                                                                     : movie->why());
  const std::string directory = path + ".frames";
  output.complain(
      fmt::format("breve: {3}, so the frames go to {0} as numbered pictures.\n"
                  "       To pack them: ffmpeg -framerate {1} -i {0}/frame_%05d.png {2}\n",
                  directory, size.fps, path, movie->why()));
  return std::make_unique<Frames>(directory);
}

}  // namespace breve::command
