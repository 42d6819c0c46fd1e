// Damaged and huge meshes and fonts give a clear error, and the world goes on and is drawn.
#include <breve/view.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace breve::seeing {
namespace {

// --- meshes ----------------------------------------------------------------------------------------------------------

/// A file whose content is repeated up to a size, and a reader of it.
struct MeshFile {
  std::string name, bytes;
  std::uint64_t size = 0;
};
struct Reading {
  const MeshFile& file;
  std::uint64_t at = 0;
};

bool open_mesh(void* user, breve_world*, const char* name, breve_file* file, breve_write_fn, void*) {
  const auto& mesh = *static_cast<const MeshFile*>(user);
  if (mesh.name != name) return false;
  file->handle = new Reading{mesh};
  file->read = [](void* handle, void* bytes, std::size_t size, std::size_t* got) {
    auto& reading = *static_cast<Reading*>(handle);
    *got = static_cast<std::size_t>(std::min<std::uint64_t>(size, reading.file.size - reading.at));
    for (std::size_t i = 0; i < *got; ++i, ++reading.at)
      static_cast<char*>(bytes)[i] = reading.file.bytes[reading.at % reading.file.bytes.size()];
    return true;
  };
  file->close = [](void* handle, bool) {
    delete static_cast<Reading*>(handle);
    return true;
  };
  return true;
}

class MeshOfAFile : public testing::Test {
 protected:
  MeshOfAFile() {
    breve_runtime_config config = breve_runtime_config_default();
    config.files.user = &file_;
    config.files.open_for_reading = open_mesh;
    EXPECT_EQ(breve_runtime_create(&config, &runtime_), BREVE_OK);
    const std::string text =
        "@use Control. @use Mobile. @use Shape. @use MeshShape.\nController Show.\nControl : Show {\n"
        "  + variables: thing (object).\n"
        "  + to try-obj: self show one (new MeshShape load-from-obj file \"mesh.obj\").\n"
        "  + to try-3ds: self show one (new MeshShape load-from-3ds file \"mesh.3ds\").\n"
        "  + to try-hull: self show one (new MeshShape load-hull file \"mesh.obj\").\n"
        "  + to show one shape (object): thing = new Mobile. thing set-shape to shape.\n}\n";
    EXPECT_EQ(breve_program_compile(runtime_, "show.tz", text.data(), text.size(), &program_), BREVE_OK);
    breve_world_config world = breve_world_config_default();
    world.memory_limit = std::size_t{20} << 20;
    EXPECT_EQ(breve_world_create(runtime_, program_, &world, &world_), BREVE_OK);
    breve_view_config view = breve_view_config_default();
    view.width = view.height = 32;
    EXPECT_EQ(breve_view_create(runtime_, &view, &view_), BREVE_OK);
  }
  ~MeshOfAFile() override {
    breve_view_destroy(view_);
    breve_world_destroy(world_);
    breve_program_destroy(program_);
    breve_runtime_destroy(runtime_);
  }
  MeshOfAFile(const MeshOfAFile&) = delete;
  MeshOfAFile& operator=(const MeshOfAFile&) = delete;

  breve_status load(const char* method, const std::string& bytes, std::uint64_t size) {
    file_ = {std::string(method) == "try-3ds" ? "mesh.3ds" : "mesh.obj", bytes, size};
    return breve_object_call(world_, breve_world_controller(world_), method, nullptr, 0, nullptr);
  }
  void expect_error(const char* method, const std::string& bytes, std::uint64_t size) {
    SCOPED_TRACE(std::string(method) + ": " + bytes.substr(0, 60));
    EXPECT_EQ(load(method, bytes, size), BREVE_ERROR_SCRIPT);
    const breve_error* error = breve_world_last_error(world_);
    ASSERT_NE(error, nullptr);
    EXPECT_NE(std::string(error->text).find("show.tz:"), std::string::npos) << error->text;
    EXPECT_NE(std::string(error->message).find(file_.name), std::string::npos) << error->message;
    expect_life();
  }
  void expect_life() {
    EXPECT_EQ(breve_world_step(world_), BREVE_OK);
    EXPECT_EQ(breve_view_render(view_, world_, pixels_, 0), BREVE_OK);
  }

  MeshFile file_;
  breve_runtime* runtime_ = nullptr;
  breve_program* program_ = nullptr;
  breve_world* world_ = nullptr;
  breve_view* view_ = nullptr;
  std::uint8_t pixels_[4 * 32 * 32] = {};
};

const std::string kSolid = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TEST_F(MeshOfAFile, IsLoadedIfItIsWhole) {
  for (const char* method : {"try-obj", "try-hull"}) {
    EXPECT_EQ(load(method, kSolid, kSolid.size()), BREVE_OK);
    expect_life();
  }
}

TEST_F(MeshOfAFile, IsAnErrorWithItsNameAndPlaceIfItIsDamaged) {
  const std::string damaged[] = {"",
                                 "not a mesh",
                                 "v 0 0 0\nv 1 0 0\nv 0 1 0\n",
                                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99\n",
                                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -99\n",
                                 "v nan 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n",
                                 "v 1e39 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n",
                                 "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n",
                                 std::string("\0\1\2\3\xff\xfe", 6)};
  for (const std::string& bytes : damaged)
    for (const char* method : {"try-obj", "try-hull", "try-3ds"}) expect_error(method, bytes, bytes.size());
}

TEST_F(MeshOfAFile, IsAnErrorOr3dsAtEveryCut) {
  // A chunk that says that it is longer than the file, and one that is longer than there is memory.
  const std::string head("\x4d\x4d\x10\0\0\0\x3d\x3d\x0a\0\0\0", 12),
      long_chunk("\x4d\x4d\xff\xff\xff\x7f\x3d\x3d\xf0\xff\xff\x7f", 12);
  for (const std::string& bytes : {head, long_chunk})
    for (std::size_t size = 1; size <= bytes.size(); ++size) expect_error("try-3ds", bytes, size);
}

TEST_F(MeshOfAFile, IsAnErrorIfItIsHuge) {
  EXPECT_EQ(load("try-obj", "v 0 0 0\n", std::uint64_t{1} << 40), BREVE_ERROR_MEMORY);
  EXPECT_NE(std::string(breve_world_last_error(world_)->text).find("show.tz:"), std::string::npos);
  expect_life();
  std::string many;
  for (int i = 0; i < 200'000; ++i) many += "v " + std::to_string(i % 97) + " " + std::to_string(i % 89) + " 1\n";
  const breve_status status = load("try-hull", many, 24 * many.size());
  EXPECT_NE(status, BREVE_OK);
  expect_life();
}

TEST_F(MeshOfAFile, IsAnErrorOrAShapeWhateverABitDoes) {
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    std::string bytes = kSolid;
    for (int k = 0; k < 3; ++k)
      bytes[random() % bytes.size()] = static_cast<char>(k == 0 ? random() % 256 : "0123456789-.e /\n"[random() % 16]);
    const breve_status status = load(i % 2 == 0 ? "try-obj" : "try-hull", bytes, bytes.size());
    EXPECT_TRUE(status == BREVE_OK || status == BREVE_ERROR_SCRIPT) << bytes;
    expect_life();
  }
}

// --- fonts -----------------------------------------------------------------------------------------------------------

std::string whole_font() {
  std::ifstream in("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

class FontOfAView : public testing::Test {
 protected:
  FontOfAView() {
    EXPECT_EQ(breve_runtime_create(nullptr, &runtime_), BREVE_OK);
    const std::string text =
        "@use Control.\nController Show.\nControl : Show {\n  + to init: self set-display-text to \"\xC3\xA4 text "
        "\\n\" at-x -.9.\n}\n";
    EXPECT_EQ(breve_program_compile(runtime_, "show.tz", text.data(), text.size(), &program_), BREVE_OK);
    EXPECT_EQ(breve_world_create(runtime_, program_, nullptr, &world_), BREVE_OK);
  }
  ~FontOfAView() override {
    breve_world_destroy(world_);
    breve_program_destroy(program_);
    breve_runtime_destroy(runtime_);
    std::filesystem::remove(path_);
  }
  FontOfAView(const FontOfAView&) = delete;
  FontOfAView& operator=(const FontOfAView&) = delete;

  /// The status of making a view with these bytes as its font; if that succeeds, it draws.
  breve_status use(const std::string& bytes) {
    std::ofstream(path_, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return use_file(path_);
  }
  breve_status use_file(const std::string& path) {
    breve_view_config config = breve_view_config_default();
    config.width = config.height = 32;
    config.font = path.c_str();
    breve_view* view = nullptr;
    const breve_status status = breve_view_create(runtime_, &config, &view);
    std::vector<std::uint8_t> pixels(std::size_t{4} * 32 * 32);
    if (status == BREVE_OK) {
      EXPECT_EQ(breve_view_render(view, world_, pixels.data(), 0), BREVE_OK);
    }
    breve_view_destroy(view);
    return status;
  }
  std::string why() const { return breve_runtime_last_error(runtime_)->message; }

  // Each test has its own file: tests run at the same time.
  const std::string path_ = testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name() + ".ttf";
  breve_runtime* runtime_ = nullptr;
  breve_program* program_ = nullptr;
  breve_world* world_ = nullptr;
};

TEST_F(FontOfAView, IsAnErrorWithItsNameIfItIsNone) {
  for (const std::string& bytes : {std::string(), std::string("not a font"), std::string(100'000, '\0'),
                                   whole_font().substr(0, 12), std::string("\0\1\0\0\xff\xff", 6)}) {
    EXPECT_EQ(use(bytes), BREVE_ERROR_FILE);
    EXPECT_NE(why().find(path_), std::string::npos) << why();
  }
  for (const char* file : {"/", "nowhere.ttf", ""}) {
    const breve_status status = use_file(file);
    EXPECT_EQ(status, *file ? BREVE_ERROR_FILE : BREVE_OK) << file;  // "" is the default
  }
}

TEST_F(FontOfAView, IsAnErrorOrDrawsWhereItIsCutOffOrDamaged) {
  const std::string whole = whole_font();
  if (whole.empty()) GTEST_SKIP() << "DejaVu Sans is not installed";
  ASSERT_EQ(use(whole), BREVE_OK);
  for (const std::size_t part : {2, 3, 5, 10}) {
    const breve_status status = use(whole.substr(0, whole.size() / part));
    EXPECT_TRUE(status == BREVE_OK || status == BREVE_ERROR_FILE) << part;
  }
  std::mt19937 random(1);
  for (int i = 0; i < 10; ++i) {
    std::string bytes = whole;
    for (int k = 0; k < 200; ++k) bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
    const breve_status status = use(bytes);
    EXPECT_TRUE(status == BREVE_OK || status == BREVE_ERROR_FILE) << i;
  }
}

TEST_F(FontOfAView, IsAnErrorIfItIsHuge) {
  std::ofstream(path_, std::ios::binary).put('x');
  std::filesystem::resize_file(path_, std::uintmax_t{1} << 33);  // holes
  EXPECT_EQ(use_file(path_), BREVE_ERROR_FILE);
}

}  // namespace
}  // namespace breve::seeing
