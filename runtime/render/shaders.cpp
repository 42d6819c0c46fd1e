// The shaders. All light is computed in linear space; what is written becomes sRGB in the frame buffer.
#include "runtime/render/shaders.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/render/shader_texts.hpp"

namespace breve::render {

namespace {

// KEEP IN STEP: the numbers of attributes in buffers.cpp and marks.cpp.
constexpr const char* kAttributes[] = {"position", "normal", "uv", "tint", "row0", "row1", "row2", "color", "extra"};

unsigned compile(const Gl& gl, unsigned kind, const char* text, const std::string& macros) {
  const unsigned shader = gl.CreateShader(kind);
  const char* texts[] = {"#version 330 core\n", macros.c_str(), text};
  gl.ShaderSource(shader, 3, texts, nullptr);
  gl.CompileShader(shader);
  int good = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  char words[2000] = "";
  gl.GetShaderInfoLog(shader, sizeof words, nullptr, words);
  gl.DeleteShader(shader);
  throw Error(ErrorCode::Internal, std::string("a shader does not compile: ") + words);
}

}  // namespace

Program::Program(const Gl& gl, const char* vertex, const char* fragment, const std::string& macros) : gl_(gl) {
  const unsigned first = compile(gl, GL_VERTEX_SHADER, vertex, macros);
  const unsigned second = compile(gl, GL_FRAGMENT_SHADER, fragment, macros);
  program_ = gl.CreateProgram();
  gl.AttachShader(program_, first);
  gl.AttachShader(program_, second);
  for (unsigned i = 0; i < std::size(kAttributes); ++i) gl.BindAttribLocation(program_, i, kAttributes[i]);
  gl.LinkProgram(program_);
  gl.DeleteShader(first);
  gl.DeleteShader(second);
  int good = 0;
  gl.GetProgramiv(program_, GL_LINK_STATUS, &good);
  if (good) return;
  char words[2000] = "";
  gl.GetProgramInfoLog(program_, sizeof words, nullptr, words);
  throw Error(ErrorCode::Internal, std::string("shaders do not fit together: ") + words);
}

Program::~Program() {
  if (program_ != 0) gl_.DeleteProgram(program_);
}

int Program::at(const char* name) const {
  const auto known = locations_.find(std::string_view(name));
  if (known != locations_.end()) return known->second;
  return locations_[name] = gl_.GetUniformLocation(program_, name);
}

Vector3f linear(const Vector3f& color) {
  const auto part = [](float c) { return c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F); };
  return {part(color.x()), part(color.y()), part(color.z())};
}

void set_fog(const Program& program, const SceneFog* fog, const Lens& lens) {
  const bool on = fog && fog->enabled;
  program.set("fog_power", on ? 10 * std::max(fog->intensity, 0.0F) : 0.0F);
  if (!on) return;
  program.set("fog_start", fog->start);
  program.set("fog_end", fog->end);
  program.set("fog_color", linear(fog->color));
  program.set("eye", lens.eye);
  program.set("sight", lens.orthographic ? Vector3f(-lens.back) : Vector3f(0, 0, 0));
}

Shaders::Shaders(const Gl& gl)
    : depth(gl, kDepthVertex, kDepthFragment),
      holes(gl, kHolesVertex, kHolesFragment, kTiles),
      backdrop(gl, kBackdropVertex, kBackdropFragment),
      line(gl, kLineVertex, kLineFragment, std::string(kLinear) + kFog),
      sprite(gl, kSpriteVertex, kSpriteFragment, std::string(kLinear) + kFog),
      plain(gl, kPlainVertex, kPlainFragment, std::string(kLinear) + kFog),
      sheet(gl, kSheetVertex, kSheetFragment, kFog),
      text(gl, kTextVertex, kTextFragment, kLinear),
      gl_(gl) {}

const Program& Shaders::body(const BodyKind& kind) {
  std::unique_ptr<Program>& kept = bodies_[kind];
  if (!kept) {
    std::string macros;
    const std::pair<const char*, bool> switches[] = {{"disc", kind.disc},
                                                     {"textured", kind.textured},
                                                     {"holes", kind.holes},
                                                     {"shadows", kind.shadows},
                                                     {"mirror", kind.mirror}};
    for (const auto& [name, on] : switches) macros += std::string("#define ") + name + (on ? " 1.0\n" : " 0.0\n");
    macros += "#define mode " + std::to_string(kind.mode) + "\n";
    for (const char* part : {kTiles, kLinear, kFog}) macros += part;
    kept = std::make_unique<Program>(gl_, kBodyVertex, kBodyFragment, macros);
  }
  return *kept;
}

}  // namespace breve::render
