// Movies of hosts.
#include "runtime/movie/movie.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "breve/view.h"
#include "internal.hpp"

using namespace breve::host;

namespace {

using breve::movie::FileOutput;
using breve::movie::MemoryOutput;
using breve::movie::Settings;

/// "mp4" of "walk.mp4"; "" of a name without an ending.
std::string ending_of(const std::string& path) {
  const std::size_t dot = path.find_last_of("./");
  return dot == std::string::npos || path[dot] == '/' ? "" : path.substr(dot + 1);
}

Settings settings_of(const breve_movie_config& config) {
  constexpr auto kMost = static_cast<std::uint32_t>(breve::movie::kMostSide);
  Settings settings;
  settings.format = config.format ? config.format : config.path ? ending_of(config.path) : "";
  settings.width = static_cast<int>(std::min(config.width, kMost + 1));
  settings.height = static_cast<int>(std::min(config.height, kMost + 1));
  settings.fps = config.fps;
  return settings;
}

}  // namespace

struct breve_movie {
  breve_runtime& runtime;
  breve_movie_config config;
  std::string path;
  Settings settings;
  std::optional<FileOutput> file;
  MemoryOutput memory;
  std::unique_ptr<breve::movie::Movie> movie;  // null once it is finished or has failed
  std::vector<std::uint8_t> pixels;            // of a picture whose rows are not contiguous

  breve_movie(breve_runtime& with, const breve_movie_config& given)
      : runtime(with), config(given), path(given.path ? given.path : ""), settings(settings_of(given)) {
    config.path = config.format = nullptr;  // the host's
    // A refusal comes before there is a file.
    MemoryOutput nowhere;
    breve::movie::open(settings, nowhere);
    if (given.path) file.emplace(path);
    movie = breve::movie::open(settings, output());
  }
  breve::movie::Output& output() {
    if (file) return *file;
    return memory;
  }
  void add(const std::uint8_t* rgba, std::size_t step) {
    const std::size_t row = 4 * static_cast<std::size_t>(settings.width);
    const auto rows = static_cast<std::size_t>(settings.height);
    if (step == row) return movie->add({rgba, row * rows});
    pixels.resize(row * rows);
    for (std::size_t y = 0; y < rows; ++y)
      std::copy_n(rgba + y * step, row, pixels.begin() + static_cast<std::ptrdiff_t>(y * row));
    movie->add(pixels);
  }
  void finish() {
    movie->finish();
    if (file) return file->close();
    const std::string_view bytes = memory.bytes();
    if (!config.write(config.user, bytes.data(), bytes.size()))
      fail(BREVE_ERROR_FILE, "the host's function `write` did not keep the movie");
  }
  void need_open() const {
    if (!movie) fail(BREVE_ERROR_NOT_FOUND, "the movie is finished, or an earlier call has failed");
  }
  /// After a failure nothing more is written.
  template <class Work>
  breve_status run(Work work) {
    return guard(runtime.error, [&] {
      try {
        work();
      } catch (const breve::Error& error) {
        if (error.code() == breve::ErrorCode::File) movie.reset();
        throw;
      }
    });
  }
};

breve_status breve_movie_create(breve_runtime* runtime, const breve_movie_config* config, breve_movie** movie) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  return guard(runtime->error, [&] {
    need(config, "config");
    need(movie, "movie");
    const breve_movie_config all = read_config(config, breve_movie_config_default(), "breve_movie_config");
    if (!all.path && !all.write)
      fail(BREVE_ERROR_ARGUMENT, "breve_movie_config has neither a path nor a function `write`");
    *movie = std::make_unique<breve_movie>(*runtime, all).release();
  });
}

void breve_movie_destroy(breve_movie* movie) { delete movie; }

breve_status breve_movie_add(breve_movie* movie, const uint8_t* rgba, size_t stride) {
  if (!movie) return BREVE_ERROR_ARGUMENT;
  return movie->run([&] {
    need(rgba, "rgba");
    const std::size_t row = 4 * static_cast<std::size_t>(movie->settings.width);
    if (stride != 0 && stride < row) fail(BREVE_ERROR_ARGUMENT, "stride is less than a row of the picture");
    movie->need_open();
    movie->add(rgba, stride != 0 ? stride : row);
  });
}

breve_status breve_movie_finish(breve_movie* movie) {
  if (!movie) return BREVE_ERROR_ARGUMENT;
  return movie->run([&] {
    movie->need_open();
    movie->finish();
    movie->movie.reset();
  });
}
