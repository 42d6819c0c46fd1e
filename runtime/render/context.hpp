// The OpenGL context of a renderer: one in main memory, or a given one. The library for the first is loaded when it is
// needed: a program that draws nothing loads nothing.
#pragma once

#include <memory>

#include "runtime/render/gl.hpp"

namespace breve::render {

struct ForeignContext;

class Context {
 public:
  /// @param given  draw with it; null: with OSMesa
  /// @throws Error{Unsupported} where OSMesa is not installed, or where there is no OpenGL 3.3
  explicit Context(const ForeignContext* given);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const Gl& gl() const { return gl_; }
  /// The context cannot be made current any more: deleting what was made in it does nothing from now on.
  void abandon();

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

  /// Where a context comes from.
  class Source;

 private:
  std::unique_ptr<Source> source_;
  Gl gl_;
};

}  // namespace breve::render
