// The machine form of messages, read by a JSON parser; and that every lint is documented and has a golden text.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "breve/breve.h"

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Answer {
  std::string out;
  int status = -1;
};

/// `breve check` with these words, run in the folder of the golden texts.
Answer check(const std::string& words) {
  const std::string line = std::string("cd '") + MESSAGES_FOLDER + "' && '" + BREVE_COMMAND + "' check " + words;
  Answer answer;
  std::FILE* pipe = popen(line.c_str(), "r");
  if (pipe == nullptr) return answer;
  std::array<char, 4096> chunk;
  while (const std::size_t size = std::fread(chunk.data(), 1, chunk.size(), pipe))
    answer.out.append(chunk.data(), size);
  const int status = pclose(pipe);
  answer.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return answer;
}

std::string read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class ProgramFile {
 public:
  explicit ProgramFile(const std::string& text) {
    std::string pattern = (fs::temp_directory_path() / "breve-messages-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot create a directory");
    folder_ = pattern;
    std::ofstream(path(), std::ios::binary) << text;
  }
  ~ProgramFile() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  ProgramFile(const ProgramFile&) = delete;
  ProgramFile& operator=(const ProgramFile&) = delete;
  fs::path path() const { return folder_ / "program.tz"; }

 private:
  fs::path folder_;
};

TEST(MachineForm, HoldsPlaceLengthCodeMessageAndHelp) {
  const Answer answer = check("--json names/misspelt_variable.tz");
  EXPECT_EQ(answer.status, 1);
  const Json list = Json::parse(answer.out);
  ASSERT_EQ(list.size(), 1U);
  const Json expected = {{"file", "names/misspelt_variable.tz"},
                         {"line", 10},
                         {"column", 9},
                         {"length", 7},
                         {"severity", "error"},
                         {"code", "unknown-variable"},
                         {"message", "unknown variable 'velocty'"},
                         {"help", "did you mean 'velocity'?"}};
  EXPECT_EQ(list[0], expected);
}

TEST(MachineForm, OfAGoodProgramIsAnEmptyArray) {
  const ProgramFile file("@use Control.\nController A.\nControl : A {\n\t+ to init:\n\t\tprint 1.\n}\n");
  const Answer answer = check("--json " + file.path().string());
  EXPECT_EQ(answer.status, 0);
  EXPECT_EQ(Json::parse(answer.out), Json::array());
}

TEST(MachineForm, OfSeveralFilesIsOneArray) {
  const Json list = Json::parse(check("--json names/misspelt_variable.tz names/misspelt_function.tz").out);
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[1]["file"], "names/misspelt_function.tz");
}

TEST(MachineForm, IsJsonWhateverBytesTheProgramHolds) {
  const ProgramFile file(
      "@use Control.\nController A.\nControl : A {\n\t+ to init:\n\t\tprint \xE9\x80 \"\xFF$x\".\n}\n");
  const Answer answer = check("--json " + file.path().string());
  EXPECT_EQ(answer.status, 1);
  EXPECT_GE(Json::parse(answer.out).size(), 1U);
}

TEST(Lints, CanBeAllowedOneByOne) {
  EXPECT_EQ(Json::parse(check("--json lints/precedence.tz").out).size(), 1U);
  EXPECT_EQ(Json::parse(check("--json lints/precedence.tz --allow lint-precedence").out).size(), 0U);
  EXPECT_EQ(Json::parse(check("--json lints/precedence.tz --allow lint-shadow").out).size(), 1U);
  EXPECT_EQ(check("lints/precedence.tz --allow lint-precedense 2>&1").status, 2);
}

TEST(Lints, AreDocumentedAndHaveAGoldenText) {
  std::string expected;
  for (const auto& entry : fs::recursive_directory_iterator(MESSAGES_FOLDER))
    if (entry.path().extension() == ".expected") expected += read(entry.path());
  const std::string page = read(fs::path(DOCS_FOLDER) / "messages.md");
  for (std::size_t i = 0; i < breve_lint_count(); ++i) {
    breve_lint_info lint;
    ASSERT_EQ(breve_lint(i, &lint), BREVE_OK);
    const std::string code = lint.code;
    EXPECT_NE(page.find("| `" + code + "` | "), std::string::npos) << code << " is not in docs/messages.md";
    EXPECT_NE(expected.find("[" + code + "]"), std::string::npos) << code << " has no golden text";
  }
}

}  // namespace
