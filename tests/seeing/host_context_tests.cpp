// A view that draws with a context of the host. OSMesa plays the host's part here.
#include <breve/view.h>
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "stage.hpp"

namespace breve::seeing {
namespace {

constexpr int kWidth = 160, kHeight = 120;

/// Counts what a view does with its context.
class HostContext {
 public:
  HostContext() : library_(dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE)) {
    load(create_, "OSMesaCreateContextAttribs");
    load(destroy_, "OSMesaDestroyContext");
    load(make_current_, "OSMesaMakeCurrent");
    load(address_, "OSMesaGetProcAddress");
    // RGBA, 24 bits of depth, core profile, OpenGL 3.3.
    constexpr int kAttributes[] = {0x22, 0x1908, 0x30, 24, 0x33, 0x34, 0x36, 3, 0x37, 3, 0};
    context_ = create_(kAttributes, nullptr);
  }
  ~HostContext() {
    destroy_(context_);
    dlclose(library_);
  }
  HostContext(const HostContext&) = delete;
  HostContext& operator=(const HostContext&) = delete;

  breve_gl functions() {
    breve_gl gl;
    gl.user = this;
    gl.make_current = [](void* user, bool current) { return static_cast<HostContext*>(user)->use(current); };
    gl.address = [](void* user, const char* name) { return static_cast<HostContext*>(user)->find(name); };
    return gl;
  }
  bool works() const { return context_ != nullptr; }

  int held = 0, uses = 0;  // how often it is current now, and was made so
  bool refuses = false;    // to be made current
  std::string lacks;       // the name of a function
  bool old = false;        // is of version 2.1

 private:
  template <class Function>
  void load(Function& function, const char* name) {
    function = reinterpret_cast<Function>(dlsym(library_, name));
  }
  bool use(bool current) {
    if (refuses) return false;
    held += current ? 1 : -1;
    if (current) ++uses;
    return make_current_(current ? context_ : nullptr, current ? corner_ : nullptr, 0x1401, current ? 16 : 0,
                         current ? 16 : 0) != 0;
  }
  breve_gl_function find(const char* name) {
    if (name == lacks) return nullptr;
    constexpr auto kNoNumbers = [](unsigned, int*) {};  // OpenGL 2.1 does not know the names of the version's parts
    if (old && std::strcmp(name, "glGetIntegerv") == 0)
      return reinterpret_cast<breve_gl_function>(static_cast<void (*)(unsigned, int*)>(kNoNumbers));
    return address_(name);
  }

  void* library_;
  void* (*create_)(const int*, void*) = nullptr;
  void (*destroy_)(void*) = nullptr;
  unsigned char (*make_current_)(void*, void*, unsigned, int, int) = nullptr;
  breve_gl_function (*address_)(const char*) = nullptr;
  void* context_ = nullptr;
  unsigned char corner_[16 * 16 * 4] = {};
};

class HostContexts : public testing::Test {
 protected:
  HostContexts() {
    config_.width = kWidth;
    config_.height = kHeight;
    config_.gl = &functions_;
  }
  void SetUp() override { ASSERT_TRUE(context_.works()); }
  void expect_refusal(breve_status status, const std::string& why) {
    breve_view* view = nullptr;
    EXPECT_EQ(breve_view_create(stage_.runtime(), &config_, &view), status);
    EXPECT_EQ(view, nullptr);
    const breve_error* error = breve_runtime_last_error(stage_.runtime());
    ASSERT_NE(error, nullptr);
    EXPECT_NE(std::string(error->text).find(why), std::string::npos) << error->text;
    EXPECT_EQ(context_.held, 0);
  }

  Stage stage_{BREVE_LOOK_FULL, kWidth, kHeight};
  HostContext context_;
  breve_gl functions_ = context_.functions();
  breve_view_config config_ = breve_view_config_default();
};

TEST_F(HostContexts, DrawTheSamePictures) {
  breve_world* world =
      stage_.open(stage_.compile("self floor. land catch-shadows. self enable-shadows. self move-light to (8, 20, 2). "
                                 "thing = ((new Thing) become from ball). "));
  const Pixels wanted = stage_.draw(world);
  breve_view* view = nullptr;
  ASSERT_EQ(breve_view_create(stage_.runtime(), &config_, &view), BREVE_OK);
  functions_ = {};  // was copied
  Pixels seen{kWidth, kHeight, std::vector<std::uint8_t>(wanted.rgba.size())};
  for (int picture = 0; picture < 3; ++picture) {
    const int before = context_.uses;
    ASSERT_EQ(breve_view_render(view, world, seen.rgba.data(), 0), BREVE_OK);
    EXPECT_EQ(context_.uses, before + 1);
    EXPECT_EQ(context_.held, 0);
    EXPECT_EQ(pixels_that_differ(wanted, seen), 0);
  }
  std::vector<float> depth(wanted.rgba.size() / 4);
  EXPECT_EQ(breve_view_depth(view, depth.data(), 0), BREVE_OK);
  breve_view_destroy(view);
  EXPECT_EQ(context_.held, 0);
}

TEST_F(HostContexts, ThatCannotBeUsedAreRefused) {
  context_.refuses = true;
  expect_refusal(BREVE_ERROR_UNSUPPORTED, "the given context cannot be made current");
  context_.refuses = false;
  context_.lacks = "glDrawElementsInstanced";
  expect_refusal(BREVE_ERROR_UNSUPPORTED, "the given context has no function glDrawElementsInstanced");
  context_.lacks.clear();
  context_.old = true;
  expect_refusal(BREVE_ERROR_UNSUPPORTED, "the given context has no OpenGL 3.3");
  functions_.make_current = nullptr;
  expect_refusal(BREVE_ERROR_ARGUMENT, "breve_gl.make_current and .address must be given");
}

TEST_F(HostContexts, ThatFailLaterFailThePictureAndNotTheWorld) {
  breve_world* world = stage_.open(stage_.compile("thing = ((new Thing) become from ball). "));
  breve_view* view = nullptr;
  ASSERT_EQ(breve_view_create(stage_.runtime(), &config_, &view), BREVE_OK);
  std::vector<std::uint8_t> rgba(std::size_t{4} * kWidth * kHeight);
  context_.refuses = true;
  EXPECT_EQ(breve_view_render(view, world, rgba.data(), 0), BREVE_ERROR_UNSUPPORTED);
  context_.refuses = false;
  EXPECT_EQ(breve_view_render(view, world, rgba.data(), 0), BREVE_OK);
  EXPECT_EQ(breve_world_step(world), BREVE_OK);
  context_.refuses = true;
  breve_view_destroy(view);
  EXPECT_EQ(context_.held, 0);
}

}  // namespace
}  // namespace breve::seeing
