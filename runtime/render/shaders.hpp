// The programs that run for each vertex and pixel, and how their inputs are named.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "runtime/render/gl.hpp"
#include "runtime/scene/camera_math.hpp"

namespace breve::render {

/// A linked program. Uniforms that it does not use are ignored.
class Program {
 public:
  /// @throws Error{Internal} with the compiler's words
  Program(const Gl& gl, const char* vertex, const char* fragment);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const { gl_.UseProgram(program_); }
  void set(const char* name, float value) const { gl_.Uniform1f(at(name), value); }
  void set(const char* name, int value) const { gl_.Uniform1i(at(name), value); }
  void set(const char* name, float x, float y) const { gl_.Uniform2f(at(name), x, y); }
  void set(const char* name, const Vector3f& value) const { gl_.Uniform3fv(at(name), 1, value.data()); }
  void set(const char* name, const Vector4f& value) const { gl_.Uniform4fv(at(name), 1, value.data()); }
  void set(const char* name, const Matrix4f& value) const { gl_.UniformMatrix4fv(at(name), 1, GL_FALSE, value.data()); }

 private:
  int at(const char* name) const;
  const Gl& gl_;
  unsigned program_ = 0;
  mutable std::map<std::string, int, std::less<>> locations_;
};

struct Shaders {
  explicit Shaders(const Gl& gl);
  Program body, depth, backdrop, line, sprite, plain, sheet, text;
};

}  // namespace breve::render
