// OSMesa, found at run time.
#include "runtime/render/context.hpp"

#include <dlfcn.h>

#include <string>

#include "runtime/base/error.hpp"

namespace breve::render {

namespace {

// Of GL/osmesa.h, which brings an older gl.h that cannot stand beside glcorearb.h.
constexpr int kRgba = 0x1908, kFormat = 0x22, kDepthBits = 0x30, kProfile = 0x33, kCoreProfile = 0x34;
constexpr int kMajorVersion = 0x36, kMinorVersion = 0x37;
constexpr const char* kNames[] = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};

template <class Function>
Function symbol(void* library, const char* name) {
  return reinterpret_cast<Function>(dlsym(library, name));
}

}  // namespace

struct Context::Library {
  void* handle = nullptr;
  void* (*create)(const int* attributes, void* shared) = nullptr;
  void (*destroy)(void* context) = nullptr;
  unsigned char (*make_current)(void* context, void* buffer, unsigned type, int width, int height) = nullptr;
  void (*(*address)(const char* name))() = nullptr;

  Library() {
    for (const char* name : kNames)
      if (!handle) handle = dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!handle)
      throw Error(ErrorCode::Unsupported, "nothing can be drawn: OSMesa is not installed (Debian: libosmesa6)");
    create = symbol<decltype(create)>(handle, "OSMesaCreateContextAttribs");
    destroy = symbol<decltype(destroy)>(handle, "OSMesaDestroyContext");
    make_current = symbol<decltype(make_current)>(handle, "OSMesaMakeCurrent");
    address = symbol<decltype(address)>(handle, "OSMesaGetProcAddress");
    if (!create || !destroy || !make_current || !address)
      throw Error(ErrorCode::Unsupported, "nothing can be drawn: this OSMesa is too old");
  }
  ~Library() {
    if (handle) dlclose(handle);
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

Context::Context() : library_(std::make_unique<Library>()) {
  constexpr int kAttributes[] = {kFormat,       kRgba, kDepthBits,    24, kProfile, kCoreProfile,
                                 kMajorVersion, 3,     kMinorVersion, 3,  0};
  context_ = library_->create(kAttributes, nullptr);
  if (!context_) throw Error(ErrorCode::Unsupported, "nothing can be drawn: this OSMesa has no OpenGL 3.3");
  const Use use(*this);
#define BREVE_GL_LOAD(type, name)                                   \
  gl_.name = reinterpret_cast<type>(library_->address("gl" #name)); \
  if (!gl_.name) throw Error(ErrorCode::Unsupported, "this OSMesa has no function gl" #name);
  BREVE_GL_FUNCTIONS(BREVE_GL_LOAD)
#undef BREVE_GL_LOAD
}

Context::~Context() {
  if (context_) library_->destroy(context_);
}

Context::Use::Use(Context& context) : context_(context) {
  if (!context.library_->make_current(context.context_, context.corner_, GL_UNSIGNED_BYTE, 16, 16))
    throw Error(ErrorCode::Unsupported, "nothing can be drawn: OSMesa cannot use its context");
}

Context::Use::~Use() { context_.library_->make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }

}  // namespace breve::render
