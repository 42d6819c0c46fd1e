// An OpenGL context in main memory. The library that has it is loaded with the first one: a program that draws nothing
// loads nothing.
#pragma once

#include <memory>

#include "runtime/render/gl.hpp"

namespace breve::render {

class Context {
 public:
  /// @throws Error{Unsupported} where OSMesa is not installed, or has no OpenGL 3.3
  Context();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const Gl& gl() const { return gl_; }

  /// While it stands the calling thread draws with this context; before and after, any other may.
  class Use {
   public:
    explicit Use(Context& context);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    Context& context_;
  };

 private:
  struct Library;
  std::unique_ptr<Library> library_;
  void* context_ = nullptr;
  Gl gl_;
  unsigned char corner_[16 * 16 * 4] = {};  // what OSMesa wants to draw into; pictures go elsewhere
};

}  // namespace breve::render
