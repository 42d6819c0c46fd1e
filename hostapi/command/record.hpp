// Pictures of a run: the last moment, a sheet of moments, a movie.
#pragma once

#include <breve/view.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "output.hpp"

namespace breve::command {

struct RecordOptions {
  std::string snapshot, contact_sheet, movie;  // files; "" for none
  std::string size;                            // "WIDTHxHEIGHT", "" for the default
  std::optional<double> fps;
  bool plain = false;
  std::vector<std::string> arrows;  // "contacts", "forces", "velocities", "joints"
  bool any() const { return !snapshot.empty() || !contact_sheet.empty() || !movie.empty(); }
};

struct Frame {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

/// Writes a picture as PNG. @throws std::runtime_error if the file cannot be written
void write_png(const Frame& frame, const std::string& path);

/// Takes the frames of a movie one after the other.
class MovieWriter {
 public:
  virtual ~MovieWriter() = default;
  virtual void add(const Frame& frame) = 0;  // std::runtime_error
  virtual void finish() = 0;                 // std::runtime_error
};
struct MovieSize {
  std::uint32_t width, height;  // pixels
  double fps;
};
/// A movie of the format that its name ends with, or numbered PNGs in a directory. @throws std::runtime_error
std::unique_ptr<MovieWriter> open_movie(breve_runtime* runtime, const std::string& path, const MovieSize& size,
                                        Output& output);

/// What breve_view_set_arrows takes. @throws std::runtime_error for any other name
std::uint32_t arrows_of(const std::vector<std::string>& names);

class Recorder {
 public:
  /// Makes a view of the runtime. @throws std::runtime_error with what the user should know
  Recorder(breve_runtime* runtime, const RecordOptions& options, Output& output);
  ~Recorder();

  /// The world has gone one iteration on, or is at its beginning.
  void look(breve_world* world);
  /// The run is over: what was asked for is written.
  void finish(breve_world* world);

 private:
  struct ViewDeleter {
    void operator()(breve_view* view) const { breve_view_destroy(view); }
  };
  using View = std::unique_ptr<breve_view, ViewDeleter>;
  View make_view(breve_runtime* runtime, std::uint32_t width, std::uint32_t height) const;
  static Frame draw(breve_view* view, breve_world* world, std::uint32_t width, std::uint32_t height);
  void keep_moment(breve_world* world);
  void write_sheet() const;

  RecordOptions options_;
  std::uint32_t width_ = 960, height_ = 600;
  double fps_ = 25;
  View view_, small_;
  std::unique_ptr<MovieWriter> movie_;
  double next_frame_ = 0;                 // simulated s
  std::vector<Frame> moments_;            // of the sheet, evenly apart
  std::uint64_t apart_ = 1, looked_ = 0;  // iterations
};

}  // namespace breve::command
