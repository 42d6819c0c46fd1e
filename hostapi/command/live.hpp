// `breve run --live`: the world from above in blocks of colour on the terminal, and the plotted values.
#pragma once

#include <breve/view.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "output.hpp"
#include "plot.hpp"

namespace breve::command {

class LiveView {
 public:
  /// @throws std::runtime_error if nothing can be drawn
  LiveView(breve_runtime* runtime, bool plain, Output& output);
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// Draws, if the last time is a tenth of a second ago.
  /// @param series  what is plotted; may be null
  void look(breve_world* world, const Series* series);
  /// Draws the last moment, which stays on the terminal.
  void finish(breve_world* world, const Series* series);

 private:
  void draw(breve_world* world, const Series* series);
  void fit(std::size_t plots);
  void look_from_above(breve_world* world);
  std::string blocks() const;

  struct ViewDeleter {
    void operator()(breve_view* view) const { breve_view_destroy(view); }
  };
  breve_runtime* runtime_;
  bool plain_;
  Output& output_;
  breve_scene* scene_ = nullptr;
  std::unique_ptr<breve_view, ViewDeleter> view_;
  std::uint32_t columns_ = 0, rows_ = 0;  // characters; each shows two pixels, one above the other
  std::vector<std::uint8_t> rgba_;
  std::chrono::steady_clock::time_point next_;
};

/// A number's course as a line of blocks, the last values of a column: "▁▂▅█".
std::string sparkline(const std::vector<double>& column, std::size_t width);

}  // namespace breve::command
