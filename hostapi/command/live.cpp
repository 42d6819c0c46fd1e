// Two pixels a character: the upper half block in the colour of one on the colour of the other.
#include "live.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <string_view>

namespace breve::command {

namespace {

constexpr std::uint32_t kMostColumns = 100, kMostRows = 30;
constexpr auto kEvery = std::chrono::milliseconds(100);

bool has_true_color() {
  const char* term = std::getenv("COLORTERM");
  return term && (std::string_view(term) == "truecolor" || std::string_view(term) == "24bit");
}

/// "38;2;R;G;B", or the nearest of the 6 x 6 x 6 colours that every terminal has.
std::string color(int ground, const std::uint8_t* rgb, bool full) {
  if (full) return fmt::format("{};2;{};{};{}", ground, rgb[0], rgb[1], rgb[2]);
  const auto step = [](int part) { return (part * 5 + 127) / 255; };
  return fmt::format("{};5;{}", ground, 16 + 36 * step(rgb[0]) + 6 * step(rgb[1]) + step(rgb[2]));
}

}  // namespace

std::string sparkline(const std::vector<double>& column, std::size_t width) {
  static constexpr const char* kBlocks[] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  const std::size_t first = column.size() > width ? column.size() - width : 0;
  double low = INFINITY, high = -INFINITY;
  for (std::size_t i = first; i < column.size(); ++i) {
    if (!std::isfinite(column[i])) continue;
    low = std::min(low, column[i]);
    high = std::max(high, column[i]);
  }
  std::string line;
  for (std::size_t i = first; i < column.size(); ++i) {
    const double part = high > low ? (column[i] - low) / (high - low) : 0;
    line += std::isfinite(column[i]) ? kBlocks[static_cast<std::size_t>(std::lround(7 * part))] : " ";
  }
  return line;
}

LiveView::LiveView(breve_runtime* runtime, bool plain, Output& output)
    : runtime_(runtime), plain_(plain), output_(output) {
  if (breve_scene_create(&scene_) != BREVE_OK) throw std::runtime_error("--live: there is no memory for a scene");
}

LiveView::~LiveView() { breve_scene_destroy(scene_); }

/// A view as large as the terminal has room for below a line about time and a line for each plotted column.
void LiveView::fit(std::size_t plots) {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) {
    size.ws_col = 80;
    size.ws_row = 24;
  }
  const std::uint32_t columns = std::clamp<std::uint32_t>(size.ws_col, 2, kMostColumns);
  const auto others = static_cast<std::uint32_t>(plots) + 3;
  const std::uint32_t rows = std::clamp<std::uint32_t>(size.ws_row > others ? size.ws_row - others : 1, 1, kMostRows);
  if (view_ && columns == columns_ && rows == rows_) return;
  columns_ = columns;
  rows_ = rows;
  breve_view_config config = breve_view_config_default();
  config.width = columns;
  config.height = 2 * rows;
  config.look = plain_ ? BREVE_LOOK_PLAIN : BREVE_LOOK_FULL;
  breve_view* view = nullptr;
  if (breve_view_create(runtime_, &config, &view) != BREVE_OK) {
    const breve_error* error = breve_runtime_last_error(runtime_);
    throw std::runtime_error(error ? error->message : "nothing can be drawn");
  }
  view_.reset(view);
  rgba_.resize(std::size_t{4} * config.width * config.height);
}

/// A world in space is seen along -y, with north (-z) up; a flat one as it is.
void LiveView::look_from_above(breve_world* world) {
  breve_camera camera;
  breve_backdrop backdrop = breve_backdrop_default();
  if (breve_scene_read(scene_, world) != BREVE_OK || breve_scene_backdrop(scene_, &backdrop) != BREVE_OK ||
      breve_scene_camera(scene_, columns_, 2 * rows_, &camera) != BREVE_OK || backdrop.dimension == 2)
    return;
  const double away = std::hypot(camera.offset[0], camera.offset[1], camera.offset[2]);
  breve_rows bodies{};
  if (breve_scene_rows(scene_, BREVE_SCENE_INSTANCES, &bodies) != BREVE_OK || bodies.count == 0) return;
  camera.pitch = -std::numbers::pi / 2;
  camera.yaw = 0;
  camera.offset[0] = camera.offset[2] = 0;
  camera.offset[1] = away;
  camera.automatic = 0;
  breve_view_set_camera(view_.get(), &camera);
}

std::string LiveView::blocks() const {
  const bool full = has_true_color();
  std::string text;
  for (std::uint32_t row = 0; row < rows_; ++row) {
    std::string before;
    for (std::uint32_t column = 0; column < columns_; ++column) {
      const std::uint8_t* upper = rgba_.data() + std::size_t{4} * (std::size_t{2} * row * columns_ + column);
      const std::string codes = color(38, upper, full) + ';' + color(48, upper + std::size_t{4} * columns_, full);
      if (codes != before) text += "\x1b[" + codes + "m";
      before = codes;
      text += "▀";
    }
    text += "\x1b[0m\n";
  }
  return text;
}

void LiveView::draw(breve_world* world, const Series* series) {
  fit(series ? series->names.size() : 0);
  look_from_above(world);
  if (breve_view_render(view_.get(), world, rgba_.data(), 0) != BREVE_OK) {
    const breve_error* error = breve_world_last_error(world);
    throw std::runtime_error(error ? error->message : "nothing can be drawn");
  }
  std::string text = blocks();
  text += fmt::format("{:.2f} s  iteration {}", breve_world_time(world), breve_world_iteration(world));
  for (std::size_t i = 0; series && i < series->names.size(); ++i) {
    const std::vector<double>& column = series->columns[i];
    text += fmt::format("\n{} {:.5g}  {}", series->names[i], column.empty() ? 0.0 : column.back(),
                        sparkline(column, std::min<std::size_t>(40, columns_ / 2)));
  }
  output_.progress(text);
}

void LiveView::look(breve_world* world, const Series* series) {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_ || !output_.shows_progress()) return;
  draw(world, series);
  next_ = std::chrono::steady_clock::now() + kEvery;
}

void LiveView::finish(breve_world* world, const Series* series) {
  if (!output_.shows_progress()) return;
  draw(world, series);
  output_.keep_progress();
}

}  // namespace breve::command
