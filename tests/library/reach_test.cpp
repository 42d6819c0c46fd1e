// What scripts can reach outside their world: the table of docs/sandbox.md is made of the natives, and no source
// reaches out but those that are known here.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "steve/library/library.hpp"
#include "steve/machine/native.hpp"

namespace breve::steve {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string table() {
  const std::pair<Reach, const char*> rows[] = {
      {Reach::Reads,
       "reads files | `breve_runtime_config.files.open_for_reading` | current directory, the program's own, `--path`, "
       "`--allow-read`"},
      {Reach::Writes,
       "writes files | `breve_runtime_config.files.open_for_writing` | current directory, `--allow-write`"},
      {Reach::Sleeps, "blocks the thread | `BREVE_RIGHT_SLEEP` | yes"},
      {Reach::RealTime, "reads the real-time clock | `BREVE_RIGHT_REAL_TIME` | yes"},
      {Reach::Entropy, "draws a seed from the operating system | `BREVE_RIGHT_ENTROPY` | yes"},
      {Reach::Commands, "runs commands | `breve_runtime_config.system` | with `--allow-system`"},
      {Reach::Network, "uses the network | `breve_runtime_config.network` | with `--allow-network`"}};
  std::map<Reach, std::set<std::string>> names;
  for (const auto natives : {functions(), library_natives()})
    for (const Native& native : natives) names[native.reach].insert(std::string(native.name));
  std::ostringstream out;
  out << "| right | granted by the host with | with `breve run` | used by |\n| --- | --- | --- | --- |\n";
  for (const auto& [reach, text] : rows) {
    out << "| " << text << " |";
    for (const std::string& name : names[reach]) out << (name == *names[reach].begin() ? " `" : ", `") << name << "`";
    out << " |\n";
  }
  return out.str();
}

TEST(Reach, TheTableOfTheDocumentationIsThatOfTheNatives) {
  const std::string page = read(fs::path(BREVE_SOURCES) / "docs/sandbox.md");
  EXPECT_NE(page.find(table()), std::string::npos) << "docs/sandbox.md is to have this table:\n" << table();
}

/// Words by which a source reaches out, and the only files that may have them.
TEST(Reach, NothingElseReachesOut) {
  const std::regex words(
      R"(\b(fopen|freopen|ifstream|ofstream|fstream|popen|getenv|random_device|sleep_for|sleep_until)"
      R"(|system_clock|openat|stbi_load|stbi_write_png|ReadFile)\b|(^|[^A-Za-z0-9_>])::open\(|std::system|<filesystem>)");
  const std::set<std::string> known = {
      "hostapi/src/files_within.cpp",       // files below directories that the host names
      "runtime/movie/output.cpp",           // a movie of the host, which names the file
      "runtime/scene/letters.cpp",          // the font of plots
      "runtime/render/text.cpp",            // the font of a view, which the host names
      "steve/machine/functions_math.cpp",   // a seed from the operating system
      "steve/machine/functions_world.cpp",  // sleep and the clock on the wall
  };
  std::set<std::string> found;
  for (const char* room : {"runtime", "steve", "hostapi/src"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(BREVE_SOURCES) / room)) {
      const std::string extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".hpp") continue;
      std::istringstream lines(read(entry.path()));
      for (std::string line; std::getline(lines, line);)
        if (std::regex_search(line.substr(0, line.find("//")), words))
          found.insert(fs::relative(entry.path(), BREVE_SOURCES).string());
    }
  EXPECT_EQ(found, known);
}

/// A host may set a locale that writes 1,5: no source has functions that follow it.
TEST(Reach, NothingFollowsTheLocale) {
  const std::regex words(
      R"(\b(strto[dfl]\w*|ato[fil]|sto[dfil]+|s?n?printf|v?sscanf|[io]?stringstream|setlocale|std::locale)\s*[\(<])"
      R"(|\b(isalpha|isalnum|isspace|ispunct|tolower|toupper|strcoll)\()");
  const char* const parts[] = {"strto", "ato", "sto", "printf",  "scanf",   "stringstream", "locale",
                               "isal",  "iss", "isp", "tolower", "toupper", "strcoll"};  // expressions take their time
  for (const char* room : {"runtime", "steve", "hostapi/src"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(BREVE_SOURCES) / room)) {
      const std::string extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".hpp") continue;
      std::istringstream lines(read(entry.path()));
      for (std::string line; std::getline(lines, line);) {
        const auto has = [&](const char* part) { return line.find(part) != std::string::npos; };
        if (std::none_of(std::begin(parts), std::end(parts), has)) continue;
        EXPECT_FALSE(std::regex_search(line.substr(0, line.find("//")), words))
            << entry.path() << " has a function that follows the locale: " << line;
      }
    }
}

}  // namespace
}  // namespace breve::steve
