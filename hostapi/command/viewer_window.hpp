// A window with a picture, and rectangles and text over it.
#pragma once

#include <SDL.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "letters.hpp"
#include "record.hpp"

namespace breve::command {

struct Ink {
  std::uint8_t red = 255, green = 255, blue = 255, alpha = 255;
};

class Window {
 public:
  /// @throws std::runtime_error if there is no screen or no font
  Window(const std::string& title, int width, int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  bool is(std::uint32_t id) const { return SDL_GetWindowID(window_.get()) == id; }
  int width() const { return width_; }
  int height() const { return height_; }
  void resize(int width, int height);
  void ask_for(int width, int height) { SDL_SetWindowSize(window_.get(), width, height); }  // an event follows
  void title(const std::string& text) { SDL_SetWindowTitle(window_.get(), text.c_str()); }

  void show(const Frame& picture);  // over the whole window
  void rectangle(int x, int y, int width, int height, Ink ink);
  /// @param y  of the upper end of its line. Characters beyond Latin-1 are shown as '?'
  void text(int x, int y, std::string_view words, Ink ink);
  int width_of(std::string_view words) const;
  static constexpr int kLine = 18;  // pixels from one line of text to the next
  void present() { SDL_RenderPresent(renderer_.get()); }
  /// The lines of text over the picture, in the order in which they were drawn.
  const std::vector<std::string>& texts() const { return texts_; }
  /// What the window shows now, before it is presented.
  Frame pixels() const;

 private:
  void load_font();

  struct Quit {
    void operator()(const int*) const { SDL_Quit(); }
  };
  struct Destroy {
    void operator()(SDL_Window* window) const { SDL_DestroyWindow(window); }
    void operator()(SDL_Renderer* renderer) const { SDL_DestroyRenderer(renderer); }
    void operator()(SDL_Texture* texture) const { SDL_DestroyTexture(texture); }
  };
  int running_ = 0;
  std::unique_ptr<const int, Quit> sdl_;
  std::unique_ptr<SDL_Window, Destroy> window_;
  std::unique_ptr<SDL_Renderer, Destroy> renderer_;
  std::unique_ptr<SDL_Texture, Destroy> picture_, letters_;
  Letters font_;
  int width_, height_;
  std::vector<std::string> texts_;
};

}  // namespace breve::command
