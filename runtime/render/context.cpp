// OSMesa, found at run time, and contexts of hosts.
#include "runtime/render/context.hpp"

#include <dlfcn.h>

#include <string>

#include "runtime/base/error.hpp"
#include "runtime/render/renderer.hpp"

namespace breve::render {

class Context::Source {
 public:
  virtual ~Source() = default;
  virtual const char* name() const = 0;
  virtual bool make_current() = 0;
  virtual void release() = 0;
  virtual GlFunction address(const char* name) = 0;
};

namespace {

// Of GL/osmesa.h, which brings an older gl.h that cannot stand beside glcorearb.h.
constexpr int kRgba = 0x1908, kFormat = 0x22, kDepthBits = 0x30, kProfile = 0x33, kCoreProfile = 0x34;
constexpr int kMajorVersion = 0x36, kMinorVersion = 0x37;
constexpr const char* kNames[] = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};

[[noreturn]] void refuse(const std::string& why) {
  throw Error(ErrorCode::Unsupported, "nothing can be drawn: " + why);
}

template <class Function>
Function symbol(void* library, const char* name) {
  return reinterpret_cast<Function>(dlsym(library, name));
}

struct Library {
  void* handle = nullptr;
  void* (*create)(const int* attributes, void* shared) = nullptr;
  void (*destroy)(void* context) = nullptr;
  unsigned char (*make_current)(void* context, void* buffer, unsigned type, int width, int height) = nullptr;
  GlFunction (*address)(const char* name) = nullptr;

  Library() {
    for (const char* name : kNames)
      if (!handle) handle = dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!handle) refuse("OSMesa is not installed (Debian: libosmesa6)");
    create = symbol<decltype(create)>(handle, "OSMesaCreateContextAttribs");
    destroy = symbol<decltype(destroy)>(handle, "OSMesaDestroyContext");
    make_current = symbol<decltype(make_current)>(handle, "OSMesaMakeCurrent");
    address = symbol<decltype(address)>(handle, "OSMesaGetProcAddress");
    if (!create || !destroy || !make_current || !address) refuse("this OSMesa is too old");
  }
  ~Library() {
    if (handle) dlclose(handle);
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

class MainMemory final : public Context::Source {
 public:
  MainMemory() {
    constexpr int kAttributes[] = {kFormat,       kRgba, kDepthBits,    24, kProfile, kCoreProfile,
                                   kMajorVersion, 3,     kMinorVersion, 3,  0};
    context_ = library_.create(kAttributes, nullptr);
    if (!context_) refuse("this OSMesa has no OpenGL 3.3");
  }
  ~MainMemory() override { library_.destroy(context_); }
  MainMemory(const MainMemory&) = delete;
  MainMemory& operator=(const MainMemory&) = delete;

  const char* name() const override { return "this OSMesa"; }
  bool make_current() override { return library_.make_current(context_, corner_, GL_UNSIGNED_BYTE, kSide, kSide) != 0; }
  void release() override { library_.make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
  GlFunction address(const char* name) override { return library_.address(name); }

 private:
  static constexpr int kSide = 16;  // pixels
  Library library_;
  void* context_ = nullptr;
  unsigned char corner_[kSide * kSide * 4] = {};  // what OSMesa wants to draw into; pictures go elsewhere
};

class Foreign final : public Context::Source {
 public:
  explicit Foreign(const ForeignContext& given) : given_(given) {}
  const char* name() const override { return "the given context"; }
  bool make_current() override { return given_.make_current(true); }
  void release() override { given_.make_current(false); }
  GlFunction address(const char* name) override { return given_.address(name); }

 private:
  ForeignContext given_;
};

std::unique_ptr<Context::Source> source_of(const ForeignContext* given) {
  if (given) return std::make_unique<Foreign>(*given);
  return std::make_unique<MainMemory>();
}

}  // namespace

Context::Context(const ForeignContext* given) : source_(source_of(given)) {
  const Use use(*this);
  const std::string name = source_->name();
#define BREVE_GL_LOAD(type, function)                                      \
  gl_.function = reinterpret_cast<type>(source_->address("gl" #function)); \
  if (!gl_.function) refuse(name + " has no function gl" #function);
  BREVE_GL_FUNCTIONS(BREVE_GL_LOAD)
#undef BREVE_GL_LOAD
  int major = 0, minor = 0;  // unchanged by what is older than 3.0
  gl_.GetIntegerv(GL_MAJOR_VERSION, &major);
  gl_.GetIntegerv(GL_MINOR_VERSION, &minor);
  if (major < 3 || (major == 3 && minor < 3)) refuse(name + " has no OpenGL 3.3");
}

Context::~Context() = default;

void Context::abandon() {
  gl_.DeleteBuffers = [](int, const unsigned*) {};
  gl_.DeleteFramebuffers = [](int, const unsigned*) {};
  gl_.DeleteRenderbuffers = [](int, const unsigned*) {};
  gl_.DeleteTextures = [](int, const unsigned*) {};
  gl_.DeleteVertexArrays = [](int, const unsigned*) {};
  gl_.DeleteProgram = [](unsigned) {};
  gl_.DeleteShader = [](unsigned) {};
}

Context::Use::Use(Context& context) : context_(context) {
  if (!context.source_->make_current()) refuse(std::string(context.source_->name()) + " cannot be made current");
}

Context::Use::~Use() { context_.source_->release(); }

}  // namespace breve::render
