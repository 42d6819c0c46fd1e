// When pictures are taken, and how they are put together.
#include "record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <stdexcept>

#include "write_file.hpp"

namespace breve::command {

namespace {

constexpr std::uint32_t kColumns = 4, kRows = 3, kGap = 6;  // of the sheet; pixels between its pictures
constexpr std::size_t kMoments = std::size_t{kColumns} * kRows;

/// "800x600"
void read_size(const std::string& text, std::uint32_t& width, std::uint32_t& height) {
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, width);
  const bool good = first.ec == std::errc() && first.ptr != end && *first.ptr == 'x';
  const auto second = good ? std::from_chars(first.ptr + 1, end, height) : first;
  if (!good || second.ec != std::errc() || second.ptr != end)
    throw std::runtime_error(fmt::format("--size: '{}' is not a WIDTHxHEIGHT such as 800x600", text));
}

[[noreturn]] void fail(const breve_error* error) {
  throw std::runtime_error(error ? error->message : "no picture can be drawn");
}

}  // namespace

void write_png(const Frame& frame, const std::string& path) {
  std::size_t size = 0;
  std::vector<std::uint8_t> bytes;
  breve_png(frame.width, frame.height, frame.rgba.data(), 0, nullptr, 0, &size);
  bytes.resize(size);
  if (breve_png(frame.width, frame.height, frame.rgba.data(), 0, bytes.data(), bytes.size(), &size) != BREVE_OK)
    throw std::runtime_error(fmt::format("{}: the picture cannot be packed", path));
  write_file(path, bytes);
}

/// A picture is a PNG whatever its name says.
void need_png(const char* option, const std::string& path) {
  const std::filesystem::path name(path);
  if (name.extension().empty() || name.extension() == ".png" || name.extension() == ".PNG") return;
  throw std::runtime_error(fmt::format("{}: pictures are written as PNG; name it '{}' instead of '{}'", option,
                                       std::filesystem::path(name).replace_extension(".png").string(), path));
}

std::uint32_t arrows_of(const std::vector<std::string>& names) {
  std::uint32_t arrows = BREVE_ARROWS_NONE;
  for (const std::string& name : names) {
    if (name == "contacts")
      arrows |= BREVE_ARROWS_CONTACTS;
    else if (name == "forces")
      arrows |= BREVE_ARROWS_FORCES;
    else if (name == "velocities")
      arrows |= BREVE_ARROWS_VELOCITIES;
    else if (name == "joints")
      arrows |= BREVE_ARROWS_JOINTS;
    else
      throw std::runtime_error(fmt::format("--arrows: '{}' is not one of contacts, forces, velocities, joints", name));
  }
  return arrows;
}

Recorder::Recorder(breve_runtime* runtime, const RecordOptions& options, Output& output) : options_(options) {
  need_png("--snapshot", options.snapshot);
  need_png("--contact-sheet", options.contact_sheet);
  if (!options.size.empty()) read_size(options.size, width_, height_);
  if (options.fps) fps_ = *options.fps;
  if (!options.snapshot.empty() || !options.movie.empty()) view_ = make_view(runtime, width_, height_);
  if (!options.contact_sheet.empty()) small_ = make_view(runtime, std::max(1U, width_ / 3), std::max(1U, height_ / 3));
  if (!options.movie.empty()) movie_ = open_movie(runtime, options.movie, {width_, height_, fps_}, output);
}

Recorder::~Recorder() = default;

Recorder::View Recorder::make_view(breve_runtime* runtime, std::uint32_t width, std::uint32_t height) const {
  breve_view_config config = breve_view_config_default();
  config.width = width;
  config.height = height;
  config.look = options_.plain ? BREVE_LOOK_PLAIN : BREVE_LOOK_FULL;
  breve_view* view = nullptr;
  if (breve_view_create(runtime, &config, &view) != BREVE_OK) fail(breve_runtime_last_error(runtime));
  breve_view_set_arrows(view, arrows_of(options_.arrows), 1);
  return View(view);
}

Frame Recorder::draw(breve_view* view, breve_world* world, std::uint32_t width, std::uint32_t height) {
  Frame frame{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height)};
  if (breve_view_render(view, world, frame.rgba.data(), 0) != BREVE_OK) fail(breve_world_last_error(world));
  return frame;
}

/// The length of the run is not known: of twice as many moments as the sheet has every other one goes.
void Recorder::keep_moment(breve_world* world) {
  if (looked_++ % apart_ != 0) return;
  if (moments_.size() == 2 * kMoments) {
    for (std::size_t i = 1; i < kMoments; ++i) moments_[i] = std::move(moments_[2 * i]);
    moments_.resize(kMoments);
    apart_ *= 2;
    if ((looked_ - 1) % apart_ != 0) return;
  }
  moments_.push_back(draw(small_.get(), world, std::max(1U, width_ / 3), std::max(1U, height_ / 3)));
}

void Recorder::look(breve_world* world) {
  if (small_) keep_moment(world);
  if (!movie_ || breve_world_time(world) < next_frame_ - 1e-9) return;
  const Frame frame = draw(view_.get(), world, width_, height_);
  // A world whose iterations are longer than a frame stands still for some of them: the movie runs at its own pace.
  for (; next_frame_ <= breve_world_time(world) + 1e-9; next_frame_ += 1 / fps_) movie_->add(frame);
}

void Recorder::write_sheet() const {
  const std::size_t count = std::min(kMoments, moments_.size());
  if (count == 0) return;
  const std::uint32_t width = moments_[0].width, height = moments_[0].height;
  const auto columns = std::min(kColumns, static_cast<std::uint32_t>(count));
  const auto rows = static_cast<std::uint32_t>((count + columns - 1) / columns);
  Frame sheet{columns * (width + kGap) + kGap, rows * (height + kGap) + kGap, {}};
  sheet.rgba.assign(std::size_t{4} * sheet.width * sheet.height, 255);
  for (std::size_t i = 0; i < count; ++i) {
    // Evenly over all that was kept, the first and the last among them.
    const Frame& one = moments_[count > 1 ? i * (moments_.size() - 1) / (count - 1) : 0];
    const std::size_t left = kGap + i % columns * (width + kGap), top = kGap + i / columns * (height + kGap);
    for (std::size_t y = 0; y < height; ++y)
      std::copy_n(one.rgba.data() + 4 * y * width, 4 * std::size_t{width},
                  sheet.rgba.data() + 4 * ((top + y) * sheet.width + left));
  }
  write_png(sheet, options_.contact_sheet);
}

void Recorder::finish(breve_world* world) {
  if (!options_.snapshot.empty()) write_png(draw(view_.get(), world, width_, height_), options_.snapshot);
  if (small_) write_sheet();
  if (movie_) movie_->finish();
}

}  // namespace breve::command
