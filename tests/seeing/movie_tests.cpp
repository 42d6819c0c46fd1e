// Movies of programs and of hosts are files that players can read. What the boxes of an MP4 file hold is read here.
#include <breve/view.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace breve::seeing {
namespace {

// --- what is in a file -----------------------------------------------------------------------------------------------

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return number;
}

/// Where the content of a box of an MP4 file begins ("moov", "trak" ... from the outside in); 0 if there is none.
std::size_t box(const std::string& bytes, const std::vector<std::string>& path) {
  std::size_t begin = 0, end = bytes.size();
  for (const std::string& name : path) {
    bool found = false;
    for (std::size_t at = begin; !found && at + 8 <= end; at += std::max<std::size_t>(8, number_at(bytes, at)))
      if (bytes.compare(at + 4, 4, name) == 0) {
        found = true;
        begin = at + 8;
        end = at + number_at(bytes, at);
        break;
      }
    if (!found) return 0;
  }
  return begin;
}

std::uint32_t pictures_in_mp4(const std::string& bytes) {
  const std::size_t sizes = box(bytes, {"moov", "trak", "mdia", "minf", "stbl", "stsz"});
  return sizes == 0 ? 0 : number_at(bytes, sizes + 8);
}

/// s, of the first track.
double seconds_of_mp4(const std::string& bytes) {
  const std::size_t header = box(bytes, {"moov", "trak", "mdia", "mdhd"});
  return header == 0 ? 0 : static_cast<double>(number_at(bytes, header + 16)) / number_at(bytes, header + 12);
}

// --- a world whose files are kept here -------------------------------------------------------------------------------

struct Disk {
  std::map<std::string, std::string> files;  // those that were kept
  int writes = 0;
  bool full = false;
};
struct OpenFile {
  Disk& disk;
  std::string name, bytes;
};

bool open_for_writing(void* user, breve_world*, const char* name, bool, breve_file* file, breve_write_fn reason,
                      void* sink) {
  if (std::string(name).starts_with("forbidden")) {
    constexpr std::string_view kWhy = "this test forbids it";
    reason(sink, kWhy.data(), kWhy.size());
    return false;
  }
  file->handle = new OpenFile{*static_cast<Disk*>(user), name, {}};
  file->write = [](void* handle, const void* bytes, std::size_t size) {
    auto& open = *static_cast<OpenFile*>(handle);
    ++open.disk.writes;
    if (open.disk.full) return false;
    open.bytes.append(static_cast<const char*>(bytes), size);
    return true;
  };
  file->close = [](void* handle, bool keep) {
    const std::unique_ptr<OpenFile> open(static_cast<OpenFile*>(handle));
    if (keep) open->disk.files[open->name] = open->bytes;
    return true;
  };
  return true;
}

class MovieOfAProgram : public testing::Test {
 protected:
  MovieOfAProgram() {
    breve_runtime_config config = breve_runtime_config_default();
    config.user = &said_;
    config.print = [](void* user, breve_world*, breve_channel, const char* text, std::size_t size) {
      static_cast<std::string*>(user)->append(text, size);
    };
    config.files.user = &disk_;
    config.files.open_for_writing = open_for_writing;
    EXPECT_EQ(breve_runtime_create(&config, &runtime_), BREVE_OK);
  }
  ~MovieOfAProgram() override {
    destroy_world();
    breve_program_destroy(program_);
    breve_runtime_destroy(runtime_);
  }
  MovieOfAProgram(const MovieOfAProgram&) = delete;
  MovieOfAProgram& operator=(const MovieOfAProgram&) = delete;

  /// A world that records from its beginning.
  void open(const std::string& name) {
    const std::string text =
        "@use Control. @use Mobile. @use Shape. @use Movie.\nController Show.\nControl : Show {\n"
        "  + variables: movie, thing (object). began (int).\n  + to init:\n    thing = new Mobile. thing set-shape to "
        "((new Sphere) init-with radius 2).\n    thing set-velocity to (20, 0, 0).\n    movie = new Movie. began = "
        "((movie record to \"" +
        name + "\") != 0).\n  + to end-it: movie close.\n  + to count: return (movie get-frame-count).\n}\n";
    ASSERT_EQ(breve_program_compile(runtime_, "show.tz", text.data(), text.size(), &program_), BREVE_OK);
    ASSERT_EQ(breve_world_create(runtime_, program_, nullptr, &world_), BREVE_OK);
  }
  void step(int count) {
    for (int i = 0; i < count; ++i) ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  }
  int call(const char* method) {
    breve_value value{};
    EXPECT_EQ(breve_object_call(world_, breve_world_controller(world_), method, nullptr, 0, &value), BREVE_OK);
    return value.type == BREVE_TYPE_INT ? value.as.integer : 0;
  }
  int began() {
    breve_value value{};
    EXPECT_EQ(breve_object_get(world_, breve_world_controller(world_), "began", &value), BREVE_OK);
    return value.as.integer;
  }
  void destroy_world() {
    EXPECT_EQ(breve_world_destroy(world_), BREVE_OK);
    world_ = nullptr;
  }
  bool said(const char* text) const { return said_.find(text) != std::string::npos; }
  /// Whether ffmpeg's libraries are here.
  bool packs() {
    breve_movie_config config = breve_movie_config_default();
    breve_movie* movie = nullptr;
    config.format = "mp4";
    config.write = [](void*, const void*, std::size_t) { return true; };
    const breve_status status = breve_movie_create(runtime_, &config, &movie);
    breve_movie_destroy(movie);
    return status == BREVE_OK;
  }

  Disk disk_;
  std::string said_;
  breve_runtime* runtime_ = nullptr;
  breve_program* program_ = nullptr;
  breve_world* world_ = nullptr;
};

TEST_F(MovieOfAProgram, IsAnMp4FileWithAPictureForEachIterationAtThePaceOfSimulatedTime) {
  if (!packs()) GTEST_SKIP() << "ffmpeg's libraries are not installed";
  open("walk.mp4");
  EXPECT_EQ(began(), 1);
  step(10);
  EXPECT_EQ(call("count"), 10);
  EXPECT_TRUE(disk_.files.empty());
  call("end-it");
  step(2);
  ASSERT_EQ(disk_.files.size(), 1U);
  EXPECT_EQ(disk_.writes, 1);
  const std::string& bytes = disk_.files["walk.mp4"];
  EXPECT_EQ(pictures_in_mp4(bytes), 10U);
  EXPECT_NEAR(seconds_of_mp4(bytes), breve_world_time(world_) * 10 / 12, 1e-3);
  EXPECT_LT(box(bytes, {"moov"}), box(bytes, {"mdat"}));
  EXPECT_EQ(said_, "");
}

TEST_F(MovieOfAProgram, HasTheFormatThatItsNameSays) {
  if (!packs()) GTEST_SKIP() << "ffmpeg's libraries are not installed";
  const std::map<std::string, std::string> beginnings{{"a.mpeg", std::string("\0\0\1\xba", 4)},
                                                      {"a.MPG", std::string("\0\0\1\xba", 4)},
                                                      {"a.avi", "RIFF"},
                                                      {"a.mkv", "\x1a\x45\xdf\xa3"},
                                                      {"a.gif", "GIF89a"}};
  for (const auto& [name, beginning] : beginnings) {
    open(name);
    step(3);
    call("end-it");
    destroy_world();
    breve_program_destroy(program_);
    EXPECT_EQ(disk_.files[name].substr(0, beginning.size()), beginning) << name;
    EXPECT_GT(disk_.files[name].size(), 1000U) << name;
  }
  EXPECT_EQ(said_, "");
  program_ = nullptr;
}

TEST_F(MovieOfAProgram, IsWrittenWhereTheWorldEndsBeforeIt) {
  open("walk.gif");
  step(3);
  destroy_world();
  EXPECT_EQ(disk_.files["walk.gif"].substr(0, 6), "GIF89a");
  EXPECT_EQ(disk_.files["walk.gif"].back(), ';');
}

TEST_F(MovieOfAProgram, IsNumberedPicturesUnderAnyOtherName) {
  open("walk");
  step(2);
  call("end-it");
  EXPECT_EQ(disk_.files.size(), 2U);
  EXPECT_EQ(disk_.files["walk_00001.png"].substr(1, 3), "PNG");
  EXPECT_EQ(said_, "");
}

TEST_F(MovieOfAProgram, EndsWithAWarningWhereTheDiskIsFullAndTheWorldGoesOn) {
  open("walk.gif");
  disk_.full = true;
  step(2);
  call("end-it");
  step(1);
  EXPECT_TRUE(disk_.files.empty());
  EXPECT_TRUE(said("movie 'walk.gif' not written")) << said_;
}

TEST_F(MovieOfAProgram, IsRefusedWhereTheHostRefusesTheFile) {
  open("forbidden.gif");
  EXPECT_EQ(began(), 0);
  step(2);
  EXPECT_EQ(call("count"), 0);
  EXPECT_TRUE(said("this test forbids it")) << said_;
}

TEST_F(MovieOfAProgram, EndsWhereTheWorldGoesBack) {
  open("walk.gif");
  step(2);
  std::size_t size = 0;
  ASSERT_EQ(breve_world_snapshot(world_, nullptr, 0, &size), BREVE_OK);
  std::vector<std::uint8_t> image(size);
  ASSERT_EQ(breve_world_snapshot(world_, image.data(), size, &size), BREVE_OK);
  step(3);
  ASSERT_EQ(breve_world_restore(world_, image.data(), size), BREVE_OK);
  step(2);
  EXPECT_TRUE(said("this movie has ended")) << said_;
  EXPECT_EQ(disk_.files["walk.gif"].substr(0, 6), "GIF89a");
}

// --- movies of hosts -------------------------------------------------------------------------------------------------

class MovieOfAHost : public testing::Test {
 protected:
  MovieOfAHost() {
    EXPECT_EQ(breve_runtime_create(nullptr, &runtime_), BREVE_OK);
    config_.width = 64;
    config_.height = 48;
    config_.format = "gif";
    config_.user = &bytes_;
    config_.write = [](void* user, const void* bytes, std::size_t size) {
      static_cast<std::string*>(user)->append(static_cast<const char*>(bytes), size);
      return true;
    };
  }
  ~MovieOfAHost() override {
    breve_movie_destroy(movie_);
    breve_runtime_destroy(runtime_);
  }
  MovieOfAHost(const MovieOfAHost&) = delete;
  MovieOfAHost& operator=(const MovieOfAHost&) = delete;

  std::string why() const {
    const breve_error* error = breve_runtime_last_error(runtime_);
    return error ? error->message : "";
  }
  void refuse(breve_status status, const char* text) {
    EXPECT_EQ(breve_movie_create(runtime_, &config_, &movie_), status);
    EXPECT_NE(why().find(text), std::string::npos) << why();
    breve_movie_destroy(movie_);
    movie_ = nullptr;
  }

  breve_runtime* runtime_ = nullptr;
  breve_movie_config config_ = breve_movie_config_default();
  breve_movie* movie_ = nullptr;
  std::string bytes_;
  std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(std::size_t{4} * 100 * 48, 128);
};

TEST_F(MovieOfAHost, IsRefusedWithSizesRatesAndFormatsThatThereAreNot) {
  for (const std::uint32_t side : {0U, 1'000'000U, std::numeric_limits<std::uint32_t>::max()}) {
    config_.width = side;
    refuse(BREVE_ERROR_ARGUMENT, "each side must be from 1 to 16384");
    config_.width = 64;
    config_.height = side;
    refuse(BREVE_ERROR_ARGUMENT, "each side must be from 1 to 16384");
    config_.height = 48;
  }
  for (const double fps : {0.0, -1.0, 1e6, std::nan("")}) {
    config_.fps = fps;
    refuse(BREVE_ERROR_ARGUMENT, "fps is");
  }
  config_.fps = 25;
  config_.write = nullptr;
  refuse(BREVE_ERROR_ARGUMENT, "neither a path nor a function");
}

TEST_F(MovieOfAHost, IsRefusedWithAFormatThatThereIsNot) {
  for (const char* format : {"xyz", "", "png", "jpg", "wav", "mp4\n"}) {
    config_.format = format;
    const breve_status status = breve_movie_create(runtime_, &config_, &movie_);
    EXPECT_TRUE(status == BREVE_ERROR_ARGUMENT || status == BREVE_ERROR_UNSUPPORTED) << format;
    EXPECT_NE(why(), "") << format;
  }
}

TEST_F(MovieOfAHost, GoesToItsFunctionOnceWithTheRowsOfItsPictures) {
  ASSERT_EQ(breve_movie_create(runtime_, &config_, &movie_), BREVE_OK);
  EXPECT_EQ(breve_movie_add(movie_, pixels_.data(), 4 * 63), BREVE_ERROR_ARGUMENT);
  EXPECT_EQ(breve_movie_add(movie_, pixels_.data(), 0), BREVE_OK);
  EXPECT_EQ(breve_movie_add(movie_, pixels_.data(), 4 * 100), BREVE_OK);
  EXPECT_EQ(bytes_, "");
  EXPECT_EQ(breve_movie_finish(movie_), BREVE_OK);
  EXPECT_EQ(bytes_.substr(0, 6), "GIF89a");
  EXPECT_EQ(static_cast<unsigned char>(bytes_[6]), 64);
  EXPECT_EQ(static_cast<unsigned char>(bytes_[8]), 48);
  EXPECT_EQ(breve_movie_add(movie_, pixels_.data(), 0), BREVE_ERROR_NOT_FOUND);
  EXPECT_EQ(breve_movie_finish(movie_), BREVE_ERROR_NOT_FOUND);
}

TEST_F(MovieOfAHost, IsAFileThatIsRemovedIfItIsNotFinished) {
  const std::string path = testing::TempDir() + "unfinished.gif";
  config_.path = path.c_str();
  config_.format = nullptr;
  ASSERT_EQ(breve_movie_create(runtime_, &config_, &movie_), BREVE_OK);
  EXPECT_EQ(breve_movie_add(movie_, pixels_.data(), 0), BREVE_OK);
  EXPECT_TRUE(std::filesystem::exists(path));
  breve_movie_destroy(movie_);
  movie_ = nullptr;
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(MovieOfAHost, SaysThatTheDiskIsFullAndEnds) {
  config_.path = "/dev/full";  // not a regular file: it stays
  ASSERT_EQ(breve_movie_create(runtime_, &config_, &movie_), BREVE_OK);
  breve_status status = BREVE_OK;
  for (int i = 0; i < 100 && status == BREVE_OK; ++i) status = breve_movie_add(movie_, pixels_.data(), 0);
  if (status == BREVE_OK) status = breve_movie_finish(movie_);
  EXPECT_EQ(status, BREVE_ERROR_FILE);
  EXPECT_NE(why().find("No space left on device"), std::string::npos) << why();
  EXPECT_EQ(breve_movie_add(movie_, pixels_.data(), 0), BREVE_ERROR_NOT_FOUND);
}

TEST_F(MovieOfAHost, SaysThatItsFunctionDidNotKeepIt) {
  config_.write = [](void*, const void*, std::size_t) { return false; };
  ASSERT_EQ(breve_movie_create(runtime_, &config_, &movie_), BREVE_OK);
  EXPECT_EQ(breve_movie_add(movie_, pixels_.data(), 0), BREVE_OK);
  EXPECT_EQ(breve_movie_finish(movie_), BREVE_ERROR_FILE);
  EXPECT_NE(why().find("did not keep"), std::string::npos) << why();
}

}  // namespace
}  // namespace breve::seeing
