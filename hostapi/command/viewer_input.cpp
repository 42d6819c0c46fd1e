// Mouse and keys. The viewer's own keys are function keys, so that all others are the program's.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "viewer_state.hpp"

namespace breve::command {

namespace {

constexpr int kDrag = 4;  // pixels that the mouse goes before a click becomes a drag

/// A key as breve_world_queue_key names it; "" for one that programs do not get.
std::string name_of(SDL_Keycode key, bool shift) {
  switch (key) {
    case SDLK_UP: return "up";
    case SDLK_DOWN: return "down";
    case SDLK_LEFT: return "left";
    case SDLK_RIGHT: return "right";
    default: break;
  }
  if (key <= 0 || key > 127) return {};
  const char letter = static_cast<char>(key);
  const bool upper = shift && letter >= 'a' && letter <= 'z';
  return std::string(1, upper ? static_cast<char>(letter - 'a' + 'A') : letter);
}

}  // namespace

void Viewer::handle(const SDL_Event& event) {
  switch (event.type) {
    case SDL_QUIT: left_ = true; break;
    case SDL_WINDOWEVENT:
      // With a hidden window beside it, the last visible one ends the program itself.
      if (event.window.event == SDL_WINDOWEVENT_CLOSE) left_ = true;
      if (event.window.event != SDL_WINDOWEVENT_SIZE_CHANGED || !window_->is(event.window.windowID)) break;
      end_movie();  // its pictures are all of one size
      window_->resize(std::max(1, event.window.data1), std::max(1, event.window.data2));
      view_.reset();
      break;
    case SDL_KEYDOWN: press(event.key.keysym.sym, (event.key.keysym.mod & KMOD_SHIFT) != 0, true); break;
    case SDL_KEYUP: press(event.key.keysym.sym, (event.key.keysym.mod & KMOD_SHIFT) != 0, false); break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP: button(event.button); break;
    case SDL_MOUSEMOTION:
      if (down_ == 0) break;
      dragged_ = dragged_ || std::abs(event.motion.x - down_x_) + std::abs(event.motion.y - down_y_) > kDrag;
      if (!dragged_) break;
      if (down_ == SDL_BUTTON_LEFT)
        camera_.orbit(event.motion.xrel, event.motion.yrel, window_->height());
      else
        camera_.pan(event.motion.xrel, event.motion.yrel, window_->height());
      break;
    case SDL_MOUSEWHEEL: camera_.zoom(event.wheel.preciseY); break;
    default: break;
  }
  if (camera_.moved() && view_) {
    breve_view_set_camera(view_.get(), &camera_.camera());
    changed_ = true;
    since_drawn_ = 1;  // the mouse does not wait
  }
}

void Viewer::press(SDL_Keycode key, bool shift, bool down) {
  if (key == SDLK_ESCAPE || (key >= SDLK_F1 && key <= SDLK_F12) || key == SDLK_HOME || key == SDLK_PAUSE) {
    if (down) press_own(key);
    return;
  }
  if (const std::string name = name_of(key, shift); !name.empty())
    breve_world_queue_key(world_.get(), name.c_str(), down);
}

bool Viewer::press_own(SDL_Keycode key) {
  switch (key) {
    case SDLK_ESCAPE: left_ = true; break;
    case SDLK_F1: show_help_ = !show_help_; break;
    case SDLK_F2: show_effects_ = !show_effects_; break;
    case SDLK_F3: show_menu_ = !show_menu_; break;
    case SDLK_F4: show_status_ = !show_status_; break;
    case SDLK_PAUSE:
    case SDLK_F5: paused_ = !paused_; break;
    case SDLK_F6:
      paused_ = true;
      step();
      break;
    case SDLK_F7: speed_ /= 2; break;
    case SDLK_F8: speed_ *= 2; break;
    case SDLK_F9: take_picture(); break;
    case SDLK_F10: toggle_record(); break;
    case SDLK_F11: next_arrows(); break;
    case SDLK_HOME:
      camera_.let_go();
      if (view_) breve_view_set_camera(view_.get(), nullptr);
      changed_ = true;
      break;
    default: return false;
  }
  return true;
}

/// "breve-0001.png" in the current directory, or the first number after it that is free.
std::string Viewer::free_name(const std::string& ending) const {
  std::string name;
  for (int number = 1; name.empty() || std::filesystem::exists(name); ++number)
    name = fmt::format("breve-{:04}{}", number, ending);
  return name;
}

void Viewer::take_picture() {
  const std::string name = free_name(".png");
  const bool written = try_to_write([&] { write_png(picture_, name); });
  if (written) say("written: " + name);
}

void Viewer::toggle_record() {
  if (movie_) return end_movie();
  constexpr double kFps = 25;
  movie_name_ = free_name(".mp4");
  const MovieSize size{picture_.width, picture_.height, kFps};
  if (!try_to_write([&] { movie_ = open_movie(session_.runtime(), movie_name_, size, output_); })) return;
  next_movie_frame_ = breve_world_time(world_.get());
  record_frame();
}

void Viewer::end_movie() {
  if (!movie_) return;
  const auto movie = std::move(movie_);
  if (try_to_write([&] { movie->finish(); })) say("written: " + movie_name_);
}

/// A disk that is full ends no run: the window says so.
bool Viewer::try_to_write(const std::function<void()>& write) {
  try {
    write();
    return true;
  } catch (const std::runtime_error& error) {
    output_.complain(fmt::format("breve: {}\n", error.what()));
    return false;
  }
}

/// Contacts, then forces with them, then velocities with both, then joints with all, then none.
void Viewer::next_arrows() {
  constexpr std::uint32_t kAll =
      BREVE_ARROWS_CONTACTS | BREVE_ARROWS_FORCES | BREVE_ARROWS_VELOCITIES | BREVE_ARROWS_JOINTS;
  arrows_ = arrows_ == kAll ? std::uint32_t{BREVE_ARROWS_NONE} : (2 * arrows_ + 1) & kAll;
  if (view_) breve_view_set_arrows(view_.get(), arrows_, 1);
  say(arrows_ == 0   ? "no arrows"
      : arrows_ == 1 ? "arrows: contacts"
      : arrows_ == 3 ? "arrows: contacts, forces"
      : arrows_ == 7 ? "arrows: contacts, forces, velocities"
                     : "arrows: contacts, forces, velocities, joints");
  changed_ = true;
}

void Viewer::button(const SDL_MouseButtonEvent& event) {
  if (event.state == SDL_PRESSED) {
    down_ = event.button;
    down_x_ = event.x;
    down_y_ = event.y;
    dragged_ = false;
    return;
  }
  if (down_ == SDL_BUTTON_LEFT && !dragged_) click(event.x, event.y);
  down_ = 0;
}

/// An entry of the menu is chosen, or else what is there in the world is selected, and the program gets the click.
void Viewer::click(int x, int y) {
  if (choose(x, y)) return;
  double start[3], way[3];
  camera_.ray(x, y, window_->width(), window_->height(), start, way);
  breve_hit hit{};
  bool found = false;
  if (camera_.camera().orthographic) {
    constexpr double kNear = 4;  // pixels from what is meant
    const double point[3] = {start[0], start[1], 0};
    breve_world_closest(world_.get(), point, kNear * camera_.pixel(window_->height()), nullptr, &found, &hit);
  } else {
    breve_world_ray_first(world_.get(), start, way, nullptr, &found, &hit);
  }
  selected_ = found ? hit.object : breve_object{};
  breve_world_queue_click(world_.get(), selected_);
}

bool Viewer::choose(int x, int y) {
  if (!show_menu_) return false;
  for (const Row& row : rows_)
    if (x >= row.x && x < row.x + row.width && y >= row.y && y < row.y + Window::kLine) {
      breve_world_queue_choice(world_.get(), row.item);
      return true;
    }
  return false;
}

}  // namespace breve::command
