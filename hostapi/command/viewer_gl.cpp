// A hidden window that owns an OpenGL context, by SDL2.
#include "viewer_gl.hpp"

namespace breve::command {

std::unique_ptr<MachineGl> MachineGl::open() {
  SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
  SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, 3);
  SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_CORE);
  constexpr int kSide = 16;  // pixels; pictures are drawn into frame buffers
  SDL_Window* window = SDL_CreateWindow("", SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, kSide, kSide,
                                        SDL_WINDOW_OPENGL | SDL_WINDOW_HIDDEN);
  const SDL_GLContext context = window ? SDL_GL_CreateContext(window) : nullptr;
  SDL_GL_ResetAttributes();
  if (context) {
    SDL_GL_MakeCurrent(window, nullptr);
    return std::unique_ptr<MachineGl>(new MachineGl(window, context));
  }
  if (window) SDL_DestroyWindow(window);
  return nullptr;
}

MachineGl::MachineGl(SDL_Window* window, SDL_GLContext context) : window_(window), context_(context) {
  functions_.user = this;
  functions_.make_current = [](void* user, bool current) {
    const auto& self = *static_cast<const MachineGl*>(user);
    return SDL_GL_MakeCurrent(self.window_.get(), current ? self.context_.get() : nullptr) == 0;
  };
  functions_.address = [](void*, const char* name) {
    return reinterpret_cast<breve_gl_function>(SDL_GL_GetProcAddress(name));
  };
}

}  // namespace breve::command
