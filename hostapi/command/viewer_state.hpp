// What the viewer is made of. Behind viewer.hpp.
#pragma once

#include <breve/space.h>

#include <chrono>
#include <deque>
#include <functional>

#include "interventions.hpp"
#include "repl_names.hpp"
#include "viewer.hpp"
#include "viewer_camera.hpp"
#include "viewer_gl.hpp"
#include "viewer_play.hpp"
#include "viewer_window.hpp"
#include "watch.hpp"

namespace breve::command {

class Viewer {
 public:
  /// @throws std::runtime_error with what the user should know
  Viewer(const ViewOptions& options, Output& output);
  ~Viewer();
  /// Until the window is closed. @return  the exit status
  int run();

 private:
  using Clock = std::chrono::steady_clock;

  // viewer.cpp
  ExitStatus open();
  void advance(double seconds);
  bool step();
  void watch_files();
  bool may_wait();
  void render();
  void make_view();
  breve_status create_view(const breve_view_config& config);
  void record_frame();
  void frame(double seconds, int number);
  void act(const std::vector<PlayedAction>& actions);
  void measure();
  void say(std::string_view text);
  std::string status_line() const;

  // viewer_input.cpp
  void handle(const SDL_Event& event);
  void press(SDL_Keycode key, bool shift, bool down);
  bool press_own(SDL_Keycode key);
  void button(const SDL_MouseButtonEvent& event);
  void click(int x, int y);
  bool choose(int x, int y);
  void take_picture();
  void toggle_record();
  void end_movie();
  bool try_to_write(const std::function<void()>& write);
  void next_arrows();
  std::string free_name(const std::string& ending) const;

  // viewer_panels.cpp
  void draw_panels();
  void draw_lines(int x, int y, const std::vector<std::string>& lines, Ink ink);
  void draw_menu();
  void draw_inspector();
  void draw_messages();
  std::vector<std::string> about(breve_object object);
  std::vector<std::string> effect_lines() const;

  struct ViewDeleter {
    void operator()(breve_view* view) const { breve_view_destroy(view); }
  };
  struct SceneDeleter {
    void operator()(breve_scene* scene) const { breve_scene_destroy(scene); }
  };
  struct Row {
    int x, y, width;
    breve_object item;
  };

  ViewOptions options_;
  Output& output_;
  std::optional<Play> play_;
  Session session_;
  ProgramHandle program_;
  ProgramNames names_;
  WorldHandle world_;
  std::optional<Reloader> reloader_;
  Interventions guard_;
  std::unique_ptr<Window> window_;
  std::unique_ptr<MachineGl> gl_;  // null: pictures are drawn in main memory
  std::unique_ptr<breve_view, ViewDeleter> view_;
  std::unique_ptr<breve_scene, SceneDeleter> scene_;  // read for what the program wants of the window
  double since_drawn_ = 0;                            // s
  Frame picture_;
  ViewerCamera camera_;
  std::unique_ptr<MovieWriter> movie_;
  std::string movie_name_;
  double next_movie_frame_ = 0;  // simulated s
  std::uint32_t arrows_ = BREVE_ARROWS_NONE;

  bool paused_ = false, failed_ = false, left_ = false, changed_ = true;
  double speed_ = 1, due_ = 0;  // simulated seconds that are still to be computed
  bool show_help_ = false, show_effects_ = false, show_menu_ = false, show_status_ = true;
  breve_object selected_{};
  std::vector<Row> rows_;  // of the menu, as it was drawn last
  std::deque<std::string> messages_;
  int down_x_ = 0, down_y_ = 0;
  std::uint8_t down_ = 0;  // the mouse button that is held, 0 for none
  bool dragged_ = false;

  Clock::time_point measured_ = Clock::now();
  int frames_ = 0;
  double measured_time_ = 0;
  double frames_per_second_ = 0, pace_ = 0;
};

}  // namespace breve::command
