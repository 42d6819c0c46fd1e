#include "stage.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

#include "runtime/store/image.hpp"

namespace breve::seeing {

namespace {

// Things stand where their maker says. Pictures that the library paints itself need no files.
constexpr const char* kPrologue = R"(
@use PhysicalControl. @use PlanarControl. @use Mobile. @use Stationary. @use Shape. @use MeshShape. @use Image.
@use MatrixImage. @use Camera. @use Drawing. @use Terrain. @use PatchGrid. @use Spring. @use Link. @use MultiBody.
@use Joint. @use Line. @use Graph.
Mobile : Thing {
  + to become from shape (object) at place = (0, 0, 0) (vector) in color = (1, .5, .1) (vector):
    self set-shape to shape. self move to place. self set-color to color. return self.
}
Controller Show.
)";

constexpr const char* kController = R"( : Show {
  + variables:
    ball, box, thing, other, picture, eye, pen, land, cells, shape, tie, body, graph, field, chemical (object).
    n (int).
  + to picture of name (string): return ((new Image) load from "images/$name.png").
  + to floor:
    land = new Stationary.
    land register with-shape ((new Cube) init-with size (40, 2, 40)) at-location (0, -3, 0).
    land set-texture-image to 0. land set-color to (.5, .7, .5).
    return land.
  + to init:
    ball = ((new Sphere) init-with radius 2).
    box = ((new Cube) init-with size (3, 3, 3)).
    self setup.
)";

}  // namespace

Stage::Stage(std::uint32_t look, int width, int height) : config_(breve_view_config_default()) {
  config_.width = static_cast<std::uint32_t>(width);
  config_.height = static_cast<std::uint32_t>(height);
  config_.look = look;
  breve_runtime_config config = breve_runtime_config_default();
  config.print = [](void*, breve_world*, breve_channel channel, const char* text, std::size_t) {
    if (channel != BREVE_CHANNEL_PRINT) ADD_FAILURE() << text;
  };
  EXPECT_EQ(breve_files_add_directory(BREVE_MESHES, false, 0, &config.files), BREVE_OK);
  EXPECT_EQ(breve_runtime_create(&config, &runtime_), BREVE_OK);
  breve_files_release(&config.files);
}

Stage::~Stage() {
  breve_view_destroy(view_);
  for (breve_world* world : worlds_) breve_world_destroy(world);
  for (breve_program* program : programs_) breve_program_destroy(program);
  breve_runtime_destroy(runtime_);
}

void Stage::fail(const breve_error* error, const char* what) const {
  ADD_FAILURE() << what << ": " << (error ? error->text : "no reason");
}

breve_program* Stage::compile(const std::string& setup, const std::string& later, int dimension, const char* parent) {
  const std::string controller = parent ? parent : dimension == 2 ? "PlanarControl" : "Control";
  const std::string text = std::string(kPrologue) + controller + kController + "  + to setup:\n    n = 0.\n    " +
                           setup + "\n  + to later:\n    n = 0.\n    " + later + "\n}\n";
  breve_program* program = nullptr;
  if (breve_program_compile(runtime_, "show.tz", text.data(), text.size(), &program) == BREVE_OK) {
    programs_.push_back(program);
    return program;
  }
  for (std::size_t i = 0; i < breve_runtime_diagnostic_count(runtime_); ++i) {
    breve_diagnostic d;
    if (breve_runtime_diagnostic(runtime_, i, &d) == BREVE_OK) ADD_FAILURE() << d.text;
  }
  return nullptr;
}

breve_world* Stage::open(breve_program* program) {
  breve_world* world = nullptr;
  if (!program) return nullptr;
  if (breve_world_create(runtime_, program, nullptr, &world) != BREVE_OK)
    fail(breve_runtime_last_error(runtime_), "world");
  else
    worlds_.push_back(world);
  return world;
}

Pixels Stage::draw(breve_world* world) {
  Pixels pixels{static_cast<int>(config_.width), static_cast<int>(config_.height), {}};
  pixels.rgba.resize(std::size_t{4} * config_.width * config_.height);
  if (!world) return pixels;
  if (!view_ && breve_view_create(runtime_, &config_, &view_) != BREVE_OK)
    fail(breve_runtime_last_error(runtime_), "view");
  if (view_ && breve_view_set_arrows(view_, arrows_, 1) != BREVE_OK) ADD_FAILURE() << "arrows";
  if (view_ && breve_view_render(view_, world, pixels.rgba.data(), 0) != BREVE_OK)
    fail(breve_world_last_error(world), "render");
  return pixels;
}

breve_view_counters Stage::counts() const {
  breve_view_counters counters = breve_view_counters_default();
  if (!view_ || breve_view_counts(view_, &counters) != BREVE_OK) ADD_FAILURE() << "counts";
  return counters;
}

void Stage::call(breve_world* world, const char* method) {
  if (world && breve_object_call(world, breve_world_controller(world), method, nullptr, 0, nullptr) != BREVE_OK)
    fail(breve_world_last_error(world), method);
}

void Stage::step(breve_world* world, int iterations) {
  for (int i = 0; world && i < iterations; ++i)
    if (breve_world_step(world) != BREVE_OK) return fail(breve_world_last_error(world), "step");
}

Pixels read_png(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (bytes.empty()) return {};
  const Image image = Image::parse(bytes, path);
  return {image.width(), image.height(), {image.bytes().begin(), image.bytes().end()}};
}

void write_png(const Pixels& pixels, const std::string& path) {
  std::size_t size = 0;
  const auto width = static_cast<std::uint32_t>(pixels.width), height = static_cast<std::uint32_t>(pixels.height);
  ASSERT_EQ(breve_png(width, height, pixels.rgba.data(), 0, nullptr, 0, &size), BREVE_OK);
  std::vector<std::uint8_t> bytes(size);
  ASSERT_EQ(breve_png(width, height, pixels.rgba.data(), 0, bytes.data(), size, &size), BREVE_OK);
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(size));
  ASSERT_TRUE(out.good()) << path;
}

namespace {

constexpr int kSquare = 4;  // pixels

double linear(std::uint8_t byte) {
  const double c = byte / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

using Color = std::array<double, 3>;

/// From linear sRGB (IEC 61966-2-1) to CIE L*a*b* of the white D65.
Color lab(const Color& c) {
  const double x = (0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.9505;
  const double y = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
  const double z = (0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.089;
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  return {116 * f(y) - 16, 500 * (f(x) - f(y)), 200 * (f(y) - f(z))};
}

Color square_at(const Pixels& p, int left, int top) {
  Color sum{};
  int count = 0;
  for (int y = top; y < std::min(top + kSquare, p.height); ++y)
    for (int x = left; x < std::min(left + kSquare, p.width); ++x, ++count)
      for (std::size_t k = 0; k < 3; ++k) sum[k] += linear(p.rgba[4 * static_cast<std::size_t>(y * p.width + x) + k]);
  for (double& part : sum) part /= count;
  return lab(sum);
}

}  // namespace

Difference difference(const Pixels& a, const Pixels& b) {
  Difference all;
  if (a.width != b.width || a.height != b.height) return {100, 100};
  int count = 0;
  for (int y = 0; y < a.height; y += kSquare)
    for (int x = 0; x < a.width; x += kSquare, ++count) {
      const Color one = square_at(a, x, y), two = square_at(b, x, y);
      const double away = std::hypot(one[0] - two[0], one[1] - two[1], one[2] - two[2]);
      all.mean += away;
      all.most = std::max(all.most, away);
    }
  all.mean /= std::max(1, count);
  return all;
}

int pixels_that_differ(const Pixels& a, const Pixels& b) {
  int count = 0;
  for (std::size_t i = 0; i + 3 < a.rgba.size() && i + 3 < b.rgba.size(); i += 4)
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(a.rgba[i + k] - b.rgba[i + k]) > 12) {
        ++count;
        break;
      }
  return count;
}

}  // namespace breve::seeing
