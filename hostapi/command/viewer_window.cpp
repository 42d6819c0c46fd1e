// SDL2 for the window, stb_truetype for letters.
#include "viewer_window.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

namespace breve::command {

namespace {

constexpr const char* kFonts[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                  "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                                  "/usr/share/fonts/TTF/DejaVuSans.ttf"};
constexpr int kAtlasWidth = 512, kAtlasHeight = 256, kBaseline = 14;
constexpr float kSize = 14;  // pixels

[[noreturn]] void fail() { throw std::runtime_error(fmt::format("cannot open a window: {}", SDL_GetError())); }

/// The next character of UTF-8; malformed bytes are '?'.
std::uint32_t next_character(std::string_view& words) {
  const auto first = static_cast<unsigned char>(words.front());
  words.remove_prefix(1);
  if (first < 0x80) return first;
  const std::size_t more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : 1;
  std::uint32_t character = first & (0x3fU >> more);
  for (std::size_t i = 0; i < more; ++i) {
    if (words.empty() || (static_cast<unsigned char>(words.front()) & 0xc0U) != 0x80U) return '?';
    character = character << 6 | (static_cast<unsigned char>(words.front()) & 0x3fU);
    words.remove_prefix(1);
  }
  return character;
}

}  // namespace

Window::Window(const std::string& title, int width, int height) : width_(width), height_(height) {
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
  std::string file;
  for (const char* name : kFonts)
    if (std::ifstream in(name, std::ios::binary); file.empty() && in)
      file.assign(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  if (file.empty()) throw std::runtime_error("the font DejaVu Sans is not installed (Debian: fonts-dejavu-core)");
  std::vector<unsigned char> cover(std::size_t{kAtlasWidth} * kAtlasHeight);
  std::vector<stbtt_bakedchar> baked(kCount);
  stbtt_BakeFontBitmap(reinterpret_cast<const unsigned char*>(file.data()), 0, kSize, cover.data(), kAtlasWidth,
                       kAtlasHeight, kFirst, kCount, baked.data());
  for (std::size_t i = 0; i < kCount; ++i) {
    const stbtt_bakedchar& one = baked[i];
    glyphs_[i] = {{one.x0, one.y0, one.x1 - one.x0, one.y1 - one.y0}, one.xoff, one.yoff, one.xadvance};
  }
  std::vector<std::uint8_t> rgba;
  for (const unsigned char part : cover) rgba.insert(rgba.end(), {255, 255, 255, part});
  letters_.reset(
      SDL_CreateTexture(renderer_.get(), SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STATIC, kAtlasWidth, kAtlasHeight));
  if (!letters_ || SDL_UpdateTexture(letters_.get(), nullptr, rgba.data(), 4 * kAtlasWidth) != 0) fail();
  SDL_SetTextureBlendMode(letters_.get(), SDL_BLENDMODE_BLEND);
}

void Window::resize(int width, int height) {
  width_ = width;
  height_ = height;
  picture_.reset();
}

void Window::show(const Frame& picture) {
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

const Window::Glyph& Window::glyph(std::uint32_t character) const {
  return glyphs_[character >= kFirst && character < kFirst + kCount ? character - kFirst : '?' - kFirst];
}

void Window::text(int x, int y, std::string_view words, Ink ink) {
  SDL_SetTextureColorMod(letters_.get(), ink.red, ink.green, ink.blue);
  SDL_SetTextureAlphaMod(letters_.get(), ink.alpha);
  auto at = static_cast<float>(x);
  while (!words.empty()) {
    const Glyph& one = glyph(next_character(words));
    const SDL_Rect area{static_cast<int>(std::lround(at + one.left)), y + kBaseline + static_cast<int>(one.top),
                        one.source.w, one.source.h};
    SDL_RenderCopy(renderer_.get(), letters_.get(), &one.source, &area);
    at += one.advance;
  }
}

int Window::width_of(std::string_view words) const {
  float width = 0;
  while (!words.empty()) width += glyph(next_character(words)).advance;
  return static_cast<int>(std::ceil(width));
}

Frame Window::pixels() const {
  Frame frame{static_cast<std::uint32_t>(width_), static_cast<std::uint32_t>(height_), {}};
  frame.rgba.resize(std::size_t{4} * frame.width * frame.height);
  if (SDL_RenderReadPixels(renderer_.get(), nullptr, SDL_PIXELFORMAT_RGBA32, frame.rgba.data(), 4 * width_) != 0)
    fail();
  for (std::size_t i = 3; i < frame.rgba.size(); i += 4) frame.rgba[i] = 255;
  return frame;
}

}  // namespace breve::command
