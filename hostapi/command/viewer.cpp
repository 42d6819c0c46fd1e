// The loop of `breve view`: input, as many iterations as time has passed, a picture, panels.
#include "viewer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "viewer_state.hpp"

namespace breve::command {

namespace {

constexpr int kWidth = 960, kHeight = 600;
constexpr double kMostSeconds = 0.1;                   // of a frame that are made up for: a slow world runs slowly
constexpr auto kBusy = std::chrono::milliseconds(60);  // what iterations may take before a picture is drawn
constexpr double kPlayedFrame = 1.0 / 30;              // s, of input from a file
constexpr std::size_t kMostMessages = 6;

void read_size(const std::string& text, int& width, int& height) {
  if (std::sscanf(text.c_str(), "%dx%d", &width, &height) != 2 || width < 64 || height < 64 || width > 8192 ||
      height > 8192)
    throw std::runtime_error(fmt::format("--size: '{}' is not a WIDTHxHEIGHT from 64x64 to 8192x8192", text));
}

}  // namespace

Viewer::Viewer(const ViewOptions& options, Output& output)
    : options_(options),
      output_(output),
      session_(output, options.run.paths, options.run.quiet, options.run.strict, &options.run.access),
      names_(session_.runtime()) {
  output_.listen([this](std::string_view text) { say(text); });
  paused_ = options.paused;
  speed_ = options.speed.value_or(1);
  if (!options.play.empty()) play_.emplace(options.play);
}

Viewer::~Viewer() { output_.listen({}); }

ExitStatus Viewer::open() {
  if (const ExitStatus loaded = session_.load(options_.run.file, program_); loaded != kEndedWell) return loaded;
  breve_status status = BREVE_OK;
  world_ = make_world(session_, program_.get(), options_.run, options_.run.seed.value_or(1), nullptr, status);
  if (!world_) {
    const breve_error* error = breve_runtime_last_error(session_.runtime());
    output_.complain(error ? error->text : "breve: cannot make the world\n");
    return exit_status(status);
  }
  names_.use(options_.run.file, nullptr, world_.get());
  if (options_.run.watch) reloader_.emplace(session_, output_, options_.run.file);
  return kEndedWell;
}

void Viewer::say(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (const auto line = text.substr(0, end); !line.empty()) messages_.emplace_back(line);
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  while (messages_.size() > kMostMessages) messages_.pop_front();
}

/// False if the world cannot go on: it has ended, or failed.
bool Viewer::step() {
  if (failed_ || breve_world_ended(world_.get())) return false;
  const breve_status status = breve_world_step(world_.get());
  guard_.take(world_.get(), options_.run.verbose ? &output_ : nullptr);
  changed_ = true;
  if (status == BREVE_OK) return true;
  if (const breve_error* error = breve_world_last_error(world_.get())) output_.complain(error->text);
  failed_ = true;
  return false;
}

void Viewer::advance(double seconds) {
  if (paused_) return;
  due_ = std::min(due_ + speed_ * seconds, speed_ * kMostSeconds + breve_world_iteration_step(world_.get()));
  const auto begin = Clock::now();
  while (due_ >= breve_world_iteration_step(world_.get()) && Clock::now() - begin < kBusy) {
    const double before = breve_world_time(world_.get());
    if (!step()) return;
    due_ -= std::max(breve_world_time(world_.get()) - before, 1e-9);
    record_frame();
  }
}

void Viewer::watch_files() {
  if (!reloader_ || !reloader_->look(world_.get())) return;
  names_.use(options_.run.file, nullptr, world_.get());
  failed_ = false;
  changed_ = true;
}

breve_status Viewer::create_view(const breve_view_config& config) {
  breve_view_config with = config;
  if (gl_) with.gl = gl_->functions();
  breve_view* view = nullptr;
  const breve_status status = breve_view_create(session_.runtime(), &with, &view);
  view_.reset(view);
  return status;
}

void Viewer::make_view() {
  breve_view_config config = breve_view_config_default();
  config.width = static_cast<std::uint32_t>(window_->width());
  config.height = static_cast<std::uint32_t>(window_->height());
  config.look = options_.run.record.plain ? BREVE_LOOK_PLAIN : BREVE_LOOK_FULL;
  breve_status created = create_view(config);
  const auto reason = [&] {
    const breve_error* error = breve_runtime_last_error(session_.runtime());
    return std::string(error ? error->message : "nothing can be drawn");
  };
  if (created != BREVE_OK && gl_) {
    output_.complain(fmt::format("breve: drawing in main memory, without this machine's OpenGL: {}\n", reason()));
    gl_.reset();
    created = create_view(config);
  }
  if (created != BREVE_OK) throw std::runtime_error(reason());
  breve_view_set_arrows(view_.get(), arrows_, 1);
  picture_ = {config.width, config.height, std::vector<std::uint8_t>(std::size_t{4} * config.width * config.height)};
  if (camera_.moved()) breve_view_set_camera(view_.get(), &camera_.camera());
  changed_ = true;
  since_drawn_ = 1;  // there is no picture to wait with
}

/// A program that switched drawing of every frame off has two pictures in a second while it runs.
bool Viewer::may_wait() {
  constexpr double kRarely = 0.5;  // s
  breve_scene* scene = scene_.get();
  if (!scene && breve_scene_create(&scene) == BREVE_OK) scene_.reset(scene);
  breve_backdrop backdrop = breve_backdrop_default();
  if (paused_ || movie_ || since_drawn_ > kRarely || !scene_) return false;
  return breve_scene_read(scene, world_.get()) == BREVE_OK && breve_scene_backdrop(scene, &backdrop) == BREVE_OK &&
         backdrop.every_frame == 0;
}

void Viewer::render() {
  if (!view_) make_view();
  if (!changed_ || may_wait()) return;
  if (breve_view_render(view_.get(), world_.get(), picture_.rgba.data(), 0) != BREVE_OK) {
    const breve_error* error = breve_world_last_error(world_.get());
    throw std::runtime_error(error ? error->message : "nothing can be drawn");
  }
  breve_camera seen;
  if (breve_view_camera(view_.get(), &seen) == BREVE_OK) camera_.follow(seen);
  changed_ = false;
  since_drawn_ = 0;
}

/// The movie has the pace of simulated time, as that of `breve run`.
void Viewer::record_frame() {
  if (!movie_ || breve_world_time(world_.get()) < next_movie_frame_) return;
  render();
  constexpr double kFps = 25;
  if (!try_to_write([&] { movie_->add(picture_); })) movie_.reset();
  next_movie_frame_ = std::max(next_movie_frame_ + 1 / kFps, breve_world_time(world_.get()) - 1 / kFps);
  changed_ = true;
}

void Viewer::measure() {
  ++frames_;
  const double seconds = std::chrono::duration<double>(Clock::now() - measured_).count();
  if (seconds < 0.5) return;
  frames_per_second_ = frames_ / seconds;
  pace_ = (breve_world_time(world_.get()) - measured_time_) / seconds;
  measured_time_ = breve_world_time(world_.get());
  frames_ = 0;
  measured_ = Clock::now();
}

std::string Viewer::status_line() const {
  breve_stats stats = breve_stats_default();
  breve_world_stats(world_.get(), &stats);
  const char* state = failed_                           ? "  [stopped by an error]"
                      : breve_world_ended(world_.get()) ? "  [ended]"
                      : paused_                         ? "  [paused]"
                                                        : "";
  return fmt::format("{:.2f} s  iteration {}  {} objects  speed {:g}{}{}", stats.time, stats.iterations, stats.objects,
                     speed_, state, movie_ ? "  [records]" : "");
}

void Viewer::frame(double seconds, int number) {
  std::vector<PlayedAction> actions;
  if (play_) actions = play_->begin_frame(number);
  SDL_Event event;
  while (SDL_PollEvent(&event) != 0) handle(event);
  watch_files();
  advance(seconds);
  since_drawn_ += seconds;
  render();
  window_->show(picture_);
  measure();
  draw_panels();
  act(actions);
  window_->present();
  output_.flush_sometimes();
}

/// Played actions that are not input.
void Viewer::act(const std::vector<PlayedAction>& actions) {
  for (const PlayedAction& one : actions) {
    if (one.action == "shot") write_png(window_->pixels(), one.arguments[0]);
    if (one.action == "say")
      output_.print(fmt::format("{}: {}{}\n", fmt::join(one.arguments, " "), status_line(),
                                breve_object_alive(world_.get(), selected_) ? "  selected" : ""));
    if (one.action == "read") {
      const breve_camera& camera = camera_.camera();
      output_.print(fmt::format("camera: {:.3f} {:.3f} {:.3f} from ({:.3f}, {:.3f}, {:.3f})\n", camera.target[0],
                                camera.target[1], camera.target[2], camera.offset[0], camera.offset[1],
                                camera.offset[2]));
      for (const std::string& text : window_->texts()) output_.print("window: " + text + "\n");
    }
    if (one.action == "resize") window_->ask_for(std::stoi(one.arguments[0]), std::stoi(one.arguments[1]));
    if (one.action == "quit") left_ = true;
  }
}

int Viewer::run() {
  if (const ExitStatus opened = open(); opened != kEndedWell) return opened;
  int width = kWidth, height = kHeight;
  if (!options_.run.record.size.empty()) read_size(options_.run.record.size, width, height);
  window_ = std::make_unique<Window>("breve: " + options_.run.file, width, height);
  if (!options_.software) gl_ = MachineGl::open();
  arrows_ = arrows_of(options_.run.record.arrows);
  auto last = Clock::now();
  constexpr auto kFrame = std::chrono::microseconds(16'667);  // a screen shows no more
  for (int number = 0; !left_ && output_.open(); ++number) {
    const auto now = Clock::now();
    frame(play_ ? kPlayedFrame : std::chrono::duration<double>(now - last).count(), number);
    last = now;
    std::this_thread::sleep_until(now + kFrame);
  }
  end_movie();
  if (!options_.run.quiet) output_.complain(guard_.summary());
  output_.flush();
  return failed_ ? kFailed : kEndedWell;
}

int view(const ViewOptions& options, Output& output) {
  try {
    return Viewer(options, output).run();
  } catch (const std::exception& error) {
    output.complain(fmt::format("breve: {}\n", error.what()));
    return kFailed;
  }
}

}  // namespace breve::command
