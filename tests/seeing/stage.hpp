// Small pictures of small worlds, for tests of what is drawn.
#pragma once

#include <breve/view.h>

#include <cstdint>
#include <string>
#include <vector>

namespace breve::seeing {

struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // rows from the top
};

/// One runtime and one view for many worlds. Everything that fails is a failure of the running test, with the text of
/// the library's error; what it then returns is empty.
class Stage {
 public:
  static constexpr int kWidth = 160, kHeight = 120;

  explicit Stage(std::uint32_t look = BREVE_LOOK_FULL, int width = kWidth, int height = kHeight);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// A controller with the method `setup`, which its init runs, and the method `later`. The statements may use the
  /// variables and the class Thing of `kPrologue` (stage.cpp).
  breve_program* compile(const std::string& setup, const std::string& later = "", int dimension = 3,
                         const char* parent = nullptr);
  breve_world* open(breve_program* program);
  void show_arrows(std::uint32_t arrows) { arrows_ = arrows; }  // of breve_arrows
  Pixels draw(breve_world* world);
  breve_view_counters counts() const;  // of the last picture
  void call(breve_world* world, const char* method);
  void step(breve_world* world, int iterations);
  breve_runtime* runtime() const { return runtime_; }

 private:
  void fail(const breve_error* error, const char* what) const;
  breve_view_config config_;
  breve_runtime* runtime_ = nullptr;
  breve_view* view_ = nullptr;
  std::uint32_t arrows_ = 0;
  std::vector<breve_program*> programs_;
  std::vector<breve_world*> worlds_;
};

Pixels read_png(const std::string& path);
void write_png(const Pixels& pixels, const std::string& path);

/// How two pictures of one size differ to the eye: squares of four by four pixels are averaged in linear light and
/// compared in CIE L*a*b* (1976), where a difference of 1 is the least that is seen.
struct Difference {
  double mean = 0;  // over all squares
  double most = 0;  // of a square
};
Difference difference(const Pixels& a, const Pixels& b);

/// How many pixels differ by more than 12 of 255 in a channel.
int pixels_that_differ(const Pixels& a, const Pixels& b);

}  // namespace breve::seeing
