// The house of docs/architecture.md, checked from the sources themselves: who includes whom, how long files are, that
// each folder and file says what it is, and the inside of files (inside.hpp). Prints every offence; exits 1 if there is
// one. Usage: house SOURCE_DIR; house --lots SOURCE_DIR BUILD_DIR looks for names that meet in a lot of the build.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "inside.hpp"
#include "twins.hpp"

namespace fs = std::filesystem;

namespace {

/// A part of the house: a folder, and which others it may include. Everything may include itself.
struct Part {
  std::string_view folder;
  std::set<std::string_view> may_include;
};

// KEEP IN STEP: docs/architecture.md, "Arrows".
const std::vector<Part> kParts = {
    {"runtime/base", {}},
    {"runtime/solid", {"runtime/base"}},
    {"runtime/kinematics", {"runtime/base"}},
    {"runtime/space", {"runtime/base"}},
    {"runtime/articulated", {"runtime/base"}},
    {"runtime/contact", {"runtime/base", "runtime/kinematics", "runtime/solid", "runtime/space"}},
    {"runtime/mechanics", {"runtime/base", "runtime/kinematics", "runtime/solid", "runtime/articulated"}},
    {"runtime/dynamics",
     {"runtime/base", "runtime/kinematics", "runtime/solid", "runtime/space", "runtime/articulated", "runtime/contact",
      "runtime/mechanics"}},
    {"runtime/planar", {"runtime/base", "runtime/kinematics", "runtime/solid", "runtime/contact", "runtime/mechanics"}},
    {"runtime/patches", {"runtime/base"}},
    {"runtime/learn", {"runtime/base"}},
    {"runtime/scene", {"runtime/base", "runtime/solid"}},
    {"runtime/render", {"runtime/base", "runtime/scene"}},
    {"runtime/store", {"runtime/base"}},
    {"runtime/movie", {"runtime/base"}},
    {"runtime/world",
     {"runtime/base", "runtime/solid", "runtime/kinematics", "runtime/space", "runtime/planar", "runtime/articulated",
      "runtime/contact", "runtime/mechanics", "runtime/dynamics", "runtime/patches", "runtime/learn", "runtime/scene",
      "runtime/store"}},
    {"steve/syntax", {"runtime/base"}},
    {"steve/code", {"runtime/base", "steve/syntax"}},
    {"steve/compile", {"runtime/base", "steve/syntax", "steve/code"}},
    {"steve/machine", {"runtime/base", "runtime/world", "steve/syntax", "steve/code", "steve/compile"}},
    {"steve/library",
     {"runtime/base", "runtime/world", "runtime/kinematics", "runtime/solid", "runtime/mechanics", "runtime/patches",
      "runtime/learn", "runtime/scene", "runtime/store", "runtime/movie", "steve/code", "steve/machine"}},
    {"steve/analysis",
     {"runtime/base", "steve/syntax", "steve/code", "steve/compile", "steve/machine", "steve/library"}},
    {"hostapi/include", {}},
    {"hostapi/src",
     {"hostapi/include", "steve/analysis", "steve/library", "steve/machine", "steve/compile", "steve/code",
      "steve/syntax", "runtime/base", "runtime/world", "runtime/kinematics", "runtime/solid", "runtime/mechanics",
      "runtime/scene", "runtime/render", "runtime/store", "runtime/movie"}},
    {"hostapi/lua", {"hostapi/include"}},
    {"hostapi/command", {"hostapi/include"}},
    {"hostapi/api", {}},
    {"samples/hosts", {"hostapi/include"}},
};

/// Headers that are words shared within a floor of the house, and the floor. docs/architecture.md says why each is one.
const std::map<std::string_view, std::string_view> kVocabulary = {
    {"runtime/solid/shape.hpp", "runtime/"},
    {"runtime/world/resource.hpp", "runtime/"},
};

/// The classes that step an island, as runtime/dynamics/README.md lists them: each knows those before it. A line has
/// the files of one class, without "runtime/dynamics/island_".
const std::vector<std::vector<std::string_view>> kIslandClasses = {
    {"result"},
    {"state", "poses"},
    {"energy"},
    {"arrays"},
    {"balance"},
    {"handlers"},
    {"contacts"},
    {"springs"},
    {"networks"},
    {"smooth"},
    {"rows", "row_results"},
    {"momentum"},
    {"books"},
    {"predict"},
    {"rebound"},
    {"solve"},
    {"positions"},
    {"loops"},
    {"overlaps"},
    {"sub_step"},
    {"impacts", "collide"},
    {"step"},
    {"watch"},
    {"guard"},
};

/// The position of a file in kIslandClasses; behind the last one if it is not there.
std::size_t island_class_of(const std::string& file) {
  constexpr std::string_view kPrefix = "runtime/dynamics/island_";
  if (file.rfind(kPrefix, 0) != 0) return kIslandClasses.size();
  const std::string name = file.substr(kPrefix.size(), file.rfind('.') - kPrefix.size());
  const auto has = [&name](const std::vector<std::string_view>& files) {
    return std::find(files.begin(), files.end(), name) != files.end();
  };
  return static_cast<std::size_t>(std::find_if(kIslandClasses.begin(), kIslandClasses.end(), has) -
                                  kIslandClasses.begin());
}

/// Which of the libraries we stand on may be seen where. A library that is not listed is not restricted.
const std::map<std::string_view, std::vector<std::string_view>> kLibraries = {
    {"bullet/", {}},  // a peer of benchmarks, and nothing that the library links
    {"btBullet", {}},
    {"BulletCollision/", {}},
    {"LinearMath/", {}},
    {"assimp/", {"runtime/store"}},
    {"sndfile", {"runtime/store"}},
    {"gdal", {"runtime/store"}},
    {"httplib", {"hostapi/src"}},
    {"tbb/", {"runtime/base"}},
    {"box2d/", {"runtime/planar"}},
    {"pugixml", {"steve/library"}},
    {"expat", {"steve/library"}},
    {"GL/", {"runtime/render"}},
    {"freetype/", {"runtime/render"}},
    {"libav", {"runtime/movie"}},
    {"libswscale/", {"runtime/movie"}},
    {"lua", {"hostapi/lua"}},
    {"CLI/", {"hostapi/command"}},
    {"readline/", {"hostapi/command"}},
    {"SDL", {"hostapi/command", "samples/hosts"}},
    {"nlohmann/", {"hostapi/command", "hostapi/api"}},
    {"stb/", {"runtime/store", "runtime/scene", "hostapi/command"}},
    {"zlib", {"runtime/store", "hostapi/command"}},
    {"breve/", {"hostapi/include", "hostapi/src", "hostapi/lua", "hostapi/command", "samples/hosts"}},
};

constexpr std::size_t kLongest = 500;

/// Files that may be longer, each with its reason.
const std::map<std::string_view, std::string_view> kMayBeLonger = {
    {"steve/machine/interpreter.cpp", "the interpreter's loop is one function, alone in its file"},
    {"hostapi/include/breve/breve.h", "the header is the manual of the library"},
    {"hostapi/include/breve/breve.hpp", "one header for hosts in C++, with a wrapper of each function"},
    {"steve/library/Control.tz", "one class, with a hundred and twenty selectors"},
    {"steve/library/GeneticAlgorithm.tz", "one class, with seventy selectors"},
};

class House {
 public:
  explicit House(fs::path root) : root_(std::move(root)), inside_(root_) {}

  int check() {
    for (const char* top : {"runtime", "steve", "hostapi", "samples"})
      if (fs::exists(root_ / top))
        for (const auto& entry : fs::recursive_directory_iterator(root_ / top))
          if (entry.is_regular_file() && is_source(entry.path())) check_file(entry.path());
    if (fs::exists(root_ / "tests"))
      for (const auto& entry : fs::recursive_directory_iterator(root_ / "tests"))
        if (is_source(entry.path()) && entry.path().extension() != ".tz") inside_.add(relative(entry.path()));
    for (const breve::house::Offence& found : inside_.offences()) offend(found.file, found.line, found.what);
    check_readmes();
    check_effects();
    check_names();
    for (const std::string& offence : offences_) std::cout << offence << '\n';
    std::cout << files_ << " files, " << includes_ << " includes, " << offences_.size() << " offences\n";
    if (files_ == 0) std::cout << "no sources under " << root_ << ": wrong folder?\n";
    return offences_.empty() && files_ > 0 ? 0 : 1;
  }

 private:
  static bool is_source(const fs::path& path) {
    static const std::set<std::string> kExtensions = {".h", ".hpp", ".c", ".cpp", ".tz"};
    return kExtensions.count(path.extension().string()) > 0;
  }

  std::string relative(const fs::path& path) const { return fs::relative(path, root_).generic_string(); }

  static const Part* part_of(std::string_view file) {
    const Part* best = nullptr;
    for (const Part& part : kParts)
      if (file.size() > part.folder.size() && file.substr(0, part.folder.size()) == part.folder &&
          file[part.folder.size()] == '/' && (!best || part.folder.size() > best->folder.size()))
        best = &part;
    return best;
  }

  void offend(const std::string& file, std::size_t line, const std::string& what) {
    offences_.insert(file + ":" + std::to_string(line) + ": " + what);
  }

  void check_file(const fs::path& path) {
    const std::string file = relative(path);
    const bool code = path.extension() != ".tz";
    ++files_;
    if (code) inside_.add(file);
    if (code) note_name(path, file);
    std::ifstream in(path);
    std::string line;
    std::size_t number = 0;
    while (std::getline(in, line)) {
      ++number;
      if (number == 1) check_first_line(file, line);
      if (code) check_include(file, number, line);
    }
    if (number > kLongest && kMayBeLonger.find(file) == kMayBeLonger.end())
      offend(file, number,
             "longer than " + std::to_string(kLongest) + " lines; split it, or give a reason in house.cpp");
  }

  void check_first_line(const std::string& file, const std::string& line) {
    const bool says =
        line.rfind("//", 0) == 0 || line.rfind("/*", 0) == 0 || line.rfind("%", 0) == 0 || line.rfind("#", 0) == 0;
    if (!says || line.rfind("#include", 0) == 0 || line.rfind("#pragma", 0) == 0)
      offend(file, 1, "the first line does not say what the file is");
  }

  void check_include(const std::string& file, std::size_t number, const std::string& line) {
    std::istringstream words(line);
    std::string word, name;
    words >> word;
    if (word != "#include") return;
    words >> name;
    if (name.size() < 3) return;
    ++includes_;
    const char kind = name.front();
    name = name.substr(1, name.size() - 2);
    const Part* from = part_of(file);
    if (!from) {
      offend(file, number, "the file is in no part of the house; see kParts in house.cpp");
      return;
    }
    if (kind == '<' || name.rfind("breve/", 0) == 0)
      check_library(*from, file, number, name);
    else
      check_arrow(*from, file, number, name);
  }

  void check_library(const Part& from, const std::string& file, std::size_t number, const std::string& name) {
    for (const auto& [prefix, folders] : kLibraries)
      if (name.rfind(prefix, 0) == 0 && std::find(folders.begin(), folders.end(), from.folder) == folders.end())
        offend(file, number, std::string(from.folder) + " may not include <" + name + ">");
    const bool plain = name == "stdint.h" || name == "stddef.h" || name == "stdbool.h";
    const bool part = name == "breve/batch.h" || name == "breve/debug_draw.h" || name == "breve/events.h" ||
                      name == "breve/plugin.h" || name == "breve/record.h" || name == "breve/space.h" ||
                      name == "breve/step.h";
    if (file == "hostapi/include/breve/breve.h" && !plain && !part)
      offend(file, number, "breve.h includes nothing but stdint.h, stddef.h, stdbool.h and its own parts");
    if (file == "hostapi/include/breve/analysis.h" && name != "breve/breve.h")
      offend(file, number, "analysis.h includes nothing but breve.h");
  }

  void check_arrow(const Part& from, const std::string& file, std::size_t number, const std::string& name) {
    // A header that the build makes has no file here; it is named after the folder it belongs to.
    const Part* to = part_of(name);
    if (!to) {
      const fs::path beside = (root_ / file).parent_path() / name;
      if (!fs::exists(beside) || part_of(fs::relative(beside, root_).generic_string()) != &from)
        offend(file, number, "\"" + name + "\" is not a path from the root of the repository");
      return;
    }
    const auto word = kVocabulary.find(name);
    const bool shared = word != kVocabulary.end() && from.folder.rfind(word->second, 0) == 0;
    if (to != &from && !shared && from.may_include.count(to->folder) == 0)
      offend(file, number, std::string(from.folder) + " may not include " + name);
    if (name.rfind("runtime/dynamics/island_", 0) == 0 && island_class_of(name) > island_class_of(file))
      offend(file, number, "the class may not know " + name + ", which stands above it");
  }

  /// The parts of the house, the floors they are on, and each folder of tests.
  void check_readmes() {
    std::set<std::string> folders{"cmake", "docs", "hostapi", "runtime", "samples", "steve", "tests"};
    for (const Part& part : kParts)
      if (fs::exists(root_ / part.folder) && has_files(root_ / part.folder)) folders.emplace(part.folder);
    if (fs::exists(root_ / "tests"))
      for (const auto& entry : fs::directory_iterator(root_ / "tests"))
        if (entry.is_directory()) folders.insert(relative(entry.path()));
    for (const std::string& folder : folders)
      if (fs::exists(root_ / folder) && !has_readme(folder)) offend(folder, 0, "no README.md");
  }

  /// The page on architecture lists the effects that the world has.
  void check_effects() {
    const std::string table = "runtime/world/effects.cpp", page = "docs/architecture.md";
    std::ifstream effects(root_ / table), pages(root_ / page);
    std::string text, line;
    while (std::getline(pages, line)) text += line + ' ';
    const std::size_t begin = std::min(text.find("An effect is something"), text.size());
    const std::string list = text.substr(begin, text.find('.', begin) - begin);
    static const std::regex kEffect(R"re(^    \{"([a-z ]+)", ")re");
    std::smatch found;
    for (std::size_t number = 1; std::getline(effects, line); ++number)
      if (std::regex_search(line, found, kEffect) && list.find(" " + found[1].str()) == std::string::npos)
        offend(table, number, page + " does not list the effect '" + found[1].str() + "'");
  }

  /// A header that is installed has the name of the file that implements it.
  void note_name(const fs::path& path, const std::string& file) {
    const Part* part = part_of(file);
    if (!part || part->folder == "hostapi/include" || part->folder == "samples/hosts") return;
    rooms_[path.stem().string()].emplace(part->folder, file);
  }

  /// A name is of one file, in one room, unless it is in the table of twins.
  void check_names() {
    for (const auto& [name, files] : rooms_) {
      std::string rooms;
      for (const auto& [room, file] : files) rooms += (rooms.empty() ? "" : " ") + std::string(room);
      const auto* twins = std::find_if(std::begin(breve::house::kTwins), std::end(breve::house::kTwins),
                                       [&name](const auto& known) { return known.name == name; });
      const bool known = twins != std::end(breve::house::kTwins);
      if (files.size() > 1 && (!known || twins->rooms != rooms))
        offend(files.begin()->second, 0,
               "files of this name are in " + rooms + ": rename one, or give the reason in twins.hpp");
    }
    const std::string table = "tests/arrows/twins.hpp";
    if (!fs::exists(root_ / table)) return;
    for (const auto& twins : breve::house::kTwins)
      if (const auto at = rooms_.find(std::string(twins.name)); at == rooms_.end() || at->second.size() < 2)
        offend(table, 0, "'" + std::string(twins.name) + "' is not the name of files in several rooms any more");
  }

  /// A folder that only a compiler looks into (hostapi/include) may be described by its parent's page.
  bool has_readme(std::string_view folder) const {
    return fs::exists(root_ / folder / "README.md") ||
           (folder == "hostapi/include" && fs::exists(root_ / "hostapi/README.md"));
  }

  static bool has_files(const fs::path& folder) {
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.is_regular_file() && is_source(entry.path())) return true;
    return false;
  }

  fs::path root_;
  breve::house::Inside inside_;
  std::set<std::string> offences_;
  std::map<std::string, std::map<std::string_view, std::string>> rooms_;  // of a file's name: the rooms, a file in each
  std::size_t files_ = 0, includes_ = 0;
};

int check_lots(const fs::path& root, const fs::path& build) {
  const auto offences = breve::house::names_that_meet(root, build);
  for (const auto& found : offences) std::cout << found.file << ':' << found.line << ": " << found.what << '\n';
  return offences.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 4 && std::string_view(argv[1]) == "--lots") return check_lots(argv[2], argv[3]);
  if (argc != 2) {
    std::cerr << "usage: house SOURCE_DIR, or house --lots SOURCE_DIR BUILD_DIR\n";
    return 2;
  }
  return House(argv[1]).check();
}
