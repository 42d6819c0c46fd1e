// The programs that run for each vertex and pixel, and how their inputs are named.
#pragma once

#include <compare>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/render/gl.hpp"
#include "runtime/scene/camera_math.hpp"

namespace breve::render {

/// A linked program. Uniforms that it does not use are ignored.
class Program {
 public:
  /// @param macros  lines of `#define`, and functions, for both
  /// @throws Error{Internal} with the compiler's words
  Program(const Gl& gl, const char* vertex, const char* fragment, const std::string& macros = {});
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

/// What one program for bodies computes.
struct BodyKind {
  bool disc = false;  // small spheres, as squares
  bool textured = false, holes = false, shadows = false, mirror = false;
  int mode = 0;  // 0: plain colours, 1: lights, 2: studio
  auto operator<=>(const BodyKind&) const = default;
};

/// A colour of a script as a number of light.
Vector3f linear(const Vector3f& color);

/// @param fog  null: none
void set_fog(const Program& program, const SceneFog* fog, const Lens& lens);

struct Shaders {
  explicit Shaders(const Gl& gl);
  /// Made when it is used first.
  const Program& body(const BodyKind& kind);
  Program depth, holes, backdrop, line, sprite, plain, sheet, text;

 private:
  const Gl& gl_;
  std::map<BodyKind, std::unique_ptr<Program>> bodies_;
};

}  // namespace breve::render
