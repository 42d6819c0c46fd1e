// The OpenGL of this machine, for the viewer's pictures.
#pragma once

#include <SDL.h>
#include <breve/view.h>

#include <memory>

namespace breve::command {

/// A context in a hidden window. Use it while SDL runs, in one thread.
class MachineGl {
 public:
  /// Null where there is no OpenGL 3.3.
  static std::unique_ptr<MachineGl> open();
  const breve_gl* functions() const { return &functions_; }

 private:
  struct Destroy {
    void operator()(SDL_Window* window) const { SDL_DestroyWindow(window); }
    void operator()(void* context) const { SDL_GL_DeleteContext(context); }
  };
  MachineGl(SDL_Window* window, SDL_GLContext context);

  std::unique_ptr<SDL_Window, Destroy> window_;
  std::unique_ptr<void, Destroy> context_;
  breve_gl functions_;
};

}  // namespace breve::command
