// Panels over the picture: status, menu, the selected object, effects and guard, messages, keys.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "report.hpp"
#include "viewer_state.hpp"

namespace breve::command {

namespace {

constexpr int kMargin = 8;
constexpr std::size_t kWidestValue = 40;  // bytes
constexpr Ink kPlate{16, 20, 26, 215}, kText{236, 240, 244, 255}, kFaint{150, 160, 170, 255},
    kError{255, 150, 130, 255};

const std::vector<std::string> kHelp{"F1  these keys",
                                     "F2  effects, their cost, and the guard",
                                     "F3  menus",
                                     "F4  this line at the top",
                                     "F5  pause, go on",
                                     "F6  one iteration",
                                     "F7  half the speed       F8  twice the speed",
                                     "F9  screenshot           F10  record a movie",
                                     "F11 arrows for contacts, forces, velocities, joints",
                                     "Home  the program's camera",
                                     "Esc  leave",
                                     "left button: rotate; right button: move; wheel: zoom",
                                     "click: select an object. All other keys go to the program"};

std::string shortened(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (text.size() <= kWidestValue) return text;
  std::size_t end = kWidestValue;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U) --end;
  return text.substr(0, end) + "...";
}

}  // namespace

void Viewer::draw_lines(int x, int y, const std::vector<std::string>& lines, Ink ink) {
  int width = 0;
  for (const std::string& line : lines) width = std::max(width, window_->width_of(line));
  window_->rectangle(x, y, width + 2 * kMargin, Window::kLine * static_cast<int>(lines.size()) + kMargin, kPlate);
  for (const std::string& line : lines) {
    window_->text(x + kMargin, y + kMargin / 2, line, ink);
    y += Window::kLine;
  }
}

std::vector<std::string> Viewer::about(breve_object object) {
  const auto text_of = [&](const breve_value& value) {
    const char* text = nullptr;
    return breve_value_text(world_.get(), &value, &text) == BREVE_OK ? shortened(text) : std::string("?");
  };
  std::vector<std::string> lines{text_of(breve_value_object(object))};
  breve_pose pose;
  if (breve_object_pose(world_.get(), object, &pose) == BREVE_OK)
    lines.push_back(fmt::format("at ({:.3f}, {:.3f}, {:.3f})", pose.location[0], pose.location[1], pose.location[2]));
  const auto most = static_cast<std::size_t>(std::max(4, window_->height() / Window::kLine - 10));
  for (const auto& cls : names_.line_of(breve_object_class(world_.get(), object)))
    for (const auto& name : names_.variables(cls)) {
      breve_value held;
      if (lines.size() >= most) return lines;
      if (breve_object_get(world_.get(), object, name.c_str(), &held) == BREVE_OK)
        lines.push_back(fmt::format("{} = {}", name, text_of(held)));
    }
  return lines;
}

void Viewer::draw_inspector() {
  if (!breve_object_alive(world_.get(), selected_)) return;
  const std::vector<std::string> lines = about(selected_);
  int width = 0;
  for (const std::string& line : lines) width = std::max(width, window_->width_of(line));
  draw_lines(window_->width() - width - 3 * kMargin, 2 * kMargin + Window::kLine + kMargin, lines, kText);
  // Where it is in the picture.
  breve_pose pose;
  double seen[3];
  if (breve_object_pose(world_.get(), selected_, &pose) == BREVE_OK &&
      breve_camera_project(&camera_.camera(), static_cast<std::uint32_t>(window_->width()),
                           static_cast<std::uint32_t>(window_->height()), pose.location, seen) == BREVE_OK) {
    const int x = static_cast<int>(seen[0]), y = static_cast<int>(seen[1]);
    constexpr int kArm = 12, kGap = 5;
    for (const int side : {-1, 1}) {
      window_->rectangle(side < 0 ? x - kArm : x + kGap, y, kArm - kGap, 2, kError);
      window_->rectangle(x, side < 0 ? y - kArm : y + kGap, 2, kArm - kGap, kError);
    }
  }
}

/// The menu of the controller, and that of the selected object.
void Viewer::draw_menu() {
  rows_.clear();
  std::size_t count = 0;
  if (breve_world_menu_items(world_.get(), nullptr, 0, &count) != BREVE_OK) return;
  std::vector<breve_menu_item> items(count);
  if (breve_world_menu_items(world_.get(), items.data(), count, &count) != BREVE_OK) return;
  const breve_object controller = breve_world_controller(world_.get());
  const auto same = [](breve_object a, breve_object b) { return a.index == b.index && a.generation == b.generation; };
  int y = kMargin + (show_status_ ? Window::kLine + kMargin : 0);
  constexpr int kWidth = 220;
  for (const breve_menu_item& one : items) {
    if (!same(one.owner, controller) && !same(one.owner, selected_)) continue;
    window_->rectangle(kMargin, y, kWidth, Window::kLine, kPlate);
    if (one.separator)
      window_->rectangle(2 * kMargin, y + Window::kLine / 2, kWidth - 2 * kMargin, 1, kFaint);
    else
      window_->text(2 * kMargin, y, fmt::format("{}{}", one.checked ? "* " : "", one.title),
                    one.enabled ? kText : kFaint);
    if (!one.separator && one.enabled) rows_.push_back({kMargin, y, kWidth, one.item});
    y += Window::kLine;
  }
}

std::vector<std::string> Viewer::effect_lines() const {
  std::vector<std::string> lines;
  std::size_t count = 0;
  breve_world_effects(world_.get(), nullptr, 0, &count);
  std::vector<breve_effect> effects(count);
  breve_world_effects(world_.get(), effects.data(), count, &count);
  double sum = 0;
  for (const breve_effect& one : effects) {
    if (!one.active) continue;
    sum += one.seconds;
    lines.push_back(fmt::format("{}: {} items, {:.0f} us", one.name, one.items, one.seconds * 1e6));
  }
  lines.push_back(fmt::format("effects together: {:.0f} us an iteration", sum * 1e6));
  breve_view_counters counters = breve_view_counters_default();
  if (breve_view_counts(view_.get(), &counters) == BREVE_OK)
    lines.push_back(fmt::format("picture: {} draw calls, {} triangles, drawn {}", counters.draw_calls,
                                counters.triangles, gl_ ? "by this machine's OpenGL" : "in main memory"));
  std::istringstream guard(guard_.count() == 0 ? "the guard did not act\n" : guard_.summary());
  for (std::string line; std::getline(guard, line);) lines.push_back(line);
  return lines;
}

/// Messages at the lower edge, and effects above them.
void Viewer::draw_messages() {
  int bottom = window_->height() - kMargin;
  const auto draw_above = [&](const std::vector<std::string>& lines, Ink ink) {
    bottom -= Window::kLine * static_cast<int>(lines.size()) + 2 * kMargin;
    draw_lines(kMargin, bottom, lines, ink);
  };
  if (!messages_.empty()) draw_above({messages_.begin(), messages_.end()}, failed_ ? kError : kText);
  if (show_effects_) draw_above(effect_lines(), kText);
}

void Viewer::draw_panels() {
  if (show_status_)
    draw_lines(
        kMargin, kMargin,
        {fmt::format("{}  {:.0f} frames/s  {:.2f} x real time  F1: keys", status_line(), frames_per_second_, pace_)},
        kText);
  if (show_menu_) draw_menu();
  draw_inspector();
  draw_messages();
  if (show_help_) draw_lines(window_->width() / 2 - 200, window_->height() / 2 - 110, kHelp, kText);
}

}  // namespace breve::command
