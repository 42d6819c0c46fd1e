// SDL2.
#include "viewer_window.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace breve::command {

namespace {

constexpr int kBaseline = 14;
constexpr float kSize = 14;  // pixels

[[noreturn]] void fail() { throw std::runtime_error(fmt::format("cannot open a window: {}", SDL_GetError())); }

}  // namespace

Window::Window(const std::string& title, int width, int height) : font_(kSize), width_(width), height_(height) {
  if (SDL_Init(SDL_INIT_VIDEO) != 0) fail();
  sdl_.reset(&running_);
  window_.reset(SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, width, height,
                                 SDL_WINDOW_RESIZABLE));
  if (!window_) fail();
  renderer_.reset(SDL_CreateRenderer(window_.get(), -1, 0));
  if (!renderer_) fail();
  SDL_SetRenderDrawBlendMode(renderer_.get(), SDL_BLENDMODE_BLEND);
  load_font();
}

Window::~Window() = default;

void Window::load_font() {
  std::vector<std::uint8_t> rgba;
  for (const unsigned char part : font_.cover()) rgba.insert(rgba.end(), {255, 255, 255, part});
  letters_.reset(SDL_CreateTexture(renderer_.get(), SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STATIC, Letters::kWidth,
                                   Letters::kHeight));
  if (!letters_ || SDL_UpdateTexture(letters_.get(), nullptr, rgba.data(), 4 * Letters::kWidth) != 0) fail();
  SDL_SetTextureBlendMode(letters_.get(), SDL_BLENDMODE_BLEND);
}

void Window::resize(int width, int height) {
  width_ = width;
  height_ = height;
  picture_.reset();
}

void Window::show(const Frame& picture) {
  texts_.clear();
  const auto width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
  if (!picture_)
    picture_.reset(
        SDL_CreateTexture(renderer_.get(), SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STREAMING, width, height));
  if (!picture_ || SDL_UpdateTexture(picture_.get(), nullptr, picture.rgba.data(), 4 * width) != 0) fail();
  SDL_RenderCopy(renderer_.get(), picture_.get(), nullptr, nullptr);
}

void Window::rectangle(int x, int y, int width, int height, Ink ink) {
  SDL_SetRenderDrawColor(renderer_.get(), ink.red, ink.green, ink.blue, ink.alpha);
  const SDL_Rect area{x, y, width, height};
  SDL_RenderFillRect(renderer_.get(), &area);
}

void Window::text(int x, int y, std::string_view words, Ink ink) {
  texts_.emplace_back(words);
  SDL_SetTextureColorMod(letters_.get(), ink.red, ink.green, ink.blue);
  SDL_SetTextureAlphaMod(letters_.get(), ink.alpha);
  auto at = static_cast<float>(x);
  while (!words.empty()) {
    const Letters::Glyph& one = font_.glyph(next_character(words));
    const SDL_Rect source{one.x, one.y, one.width, one.height};
    const SDL_Rect area{static_cast<int>(std::lround(at + one.left)), y + kBaseline + static_cast<int>(one.top),
                        one.width, one.height};
    SDL_RenderCopy(renderer_.get(), letters_.get(), &source, &area);
    at += one.advance;
  }
}

int Window::width_of(std::string_view words) const { return static_cast<int>(std::ceil(font_.width_of(words))); }

Frame Window::pixels() const {
  Frame frame{static_cast<std::uint32_t>(width_), static_cast<std::uint32_t>(height_), {}};
  frame.rgba.resize(std::size_t{4} * frame.width * frame.height);
  if (SDL_RenderReadPixels(renderer_.get(), nullptr, SDL_PIXELFORMAT_RGBA32, frame.rgba.data(), 4 * width_) != 0)
    fail();
  for (std::size_t i = 3; i < frame.rgba.size(); i += 4) frame.rgba[i] = 255;
  return frame;
}

}  // namespace breve::command
