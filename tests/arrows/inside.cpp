// The checks of inside.hpp, on what source.cpp reads.
#include "inside.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string_view>
#include <tuple>

namespace breve::house {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kLongestFunction = 60;

/// Functions that may be longer, each with its reason.
const std::map<std::string_view, std::string_view> kMayBeLong = {
    {"steve/machine/interpreter.cpp", "the interpreter's loop is one function, alone in its file"},
};

/// Files whose lines only look like variables, each with its reason.
const std::map<std::string_view, std::string_view> kHaveNoState = {
    {"runtime/render/shader_texts.hpp", "the lines are texts in the language of shaders"},
};

bool begins(const std::string& text, std::string_view with) { return text.rfind(with, 0) == 0; }

/// Two runtimes in one process share nothing; the command is a process of its own.
bool is_library(const std::string& file) {
  return begins(file, "runtime/") || begins(file, "steve/") || begins(file, "hostapi/src/") ||
         begins(file, "hostapi/lua/");
}

/// A variable that lives as long as the process or thread and can change; its name, or nothing.
std::string state_on(const std::string& line) {
  static const std::regex constant(R"(\bconstexpr\b|\bconst\b[^*]*$|\* ?const\b)");
  static const std::regex local(R"(^\s*(inline )?(static|thread_local)\b[^();]*?(\w+)\s*(=|\{|;))");
  static const std::regex wide(
      R"(^(?!(using|extern|namespace|class|struct|enum|template|return|friend|typedef|union|goto|else)\b))"
      R"((inline |volatile )*[A-Za-z_][\w:<>, *&]* ([a-z_]\w*)( = [^()]*|\{[^()]*\})?;)");
  const std::string code = line.substr(0, line.find("//"));
  const std::string before = code.substr(0, code.find_first_of("={;"));
  std::smatch found;
  if (std::regex_search(before, constant)) return {};
  if (std::regex_search(code, found, local)) return found[3];
  if (std::regex_search(code, found, wide)) return found[3];
  return {};
}

std::string last_part(const std::string& owner) {
  const std::size_t colon = owner.rfind(':');
  return colon == std::string::npos ? owner : owner.substr(colon + 1);
}

/// Called by its name, if at all: not through a base class, an operator or a host.
bool is_called_by_name(const Name& name) {
  return name.function && !name.overrides && name.name[0] != '~' && name.name != "operator" && name.name != "main" &&
         name.name != last_part(name.owner) && !begins(name.name, "breve_");
}

bool is_header(const std::string& file) { return fs::path(file).extension() == ".hpp"; }

/// Like is_called_by_name, where the base class is one of another library: its methods are written as it likes.
bool is_in_our_style(const std::string& name) {
  return std::none_of(name.begin(), name.end(), [](unsigned char c) { return std::isupper(c); });
}

/// "// files.cpp, other.cpp" or "// words (file.cpp)", with or without words behind a colon.
std::vector<std::string> files_of_heading(const Comment& comment) {
  static const std::regex list(R"(^// ([a-z_0-9]+\.cpp(, [a-z_0-9]+\.cpp)*)(: .*)?$)");
  static const std::regex behind(R"(^// [^.]*\(([a-z_0-9]+\.cpp)\)$)");
  std::smatch found;
  if (!comment.alone ||
      (!std::regex_match(comment.text, found, list) && !std::regex_match(comment.text, found, behind)))
    return {};
  static const std::regex file(R"([a-z_0-9]+\.cpp)");
  const std::string text = found[1];
  return {std::sregex_token_iterator(text.begin(), text.end(), file), {}};
}

}  // namespace

// One function a line: its name, then the reason.
Inside::Inside(fs::path root) : root_(std::move(root)) {
  std::ifstream in(root_ / "tests/arrows/for_tests.txt");
  std::string name, reason;
  while (in >> name && std::getline(in, reason)) for_tests_.insert(name);
}

void Inside::add(const std::string& file) { files_.emplace(file, read_source(root_ / file)); }

std::vector<Offence> Inside::offences() const {
  std::vector<Offence> out;
  for (const auto& [file, source] : files_) {
    if (begins(file, "tests/")) continue;
    find_long(file, source, out);
    find_state(file, out);
    if (is_header(file)) find_false_headings(file, source, out);
  }
  find_dead(out);
  return out;
}

void Inside::find_long(const std::string& file, const Source& source, std::vector<Offence>& out) const {
  if (kMayBeLong.count(file) != 0) return;
  for (const Name& name : source.names) {
    const std::size_t lines = name.last_line - name.first_line + 1;
    if (name.function && name.defined && lines > kLongestFunction)
      out.push_back({file, name.first_line,
                     "'" + name.name + "' has " + std::to_string(lines) + " lines, more than " +
                         std::to_string(kLongestFunction)});
  }
}

void Inside::find_state(const std::string& file, std::vector<Offence>& out) const {
  if (!is_library(file) || kHaveNoState.count(file) != 0) return;
  std::ifstream in(root_ / file);
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number)
    if (const std::string name = state_on(line); !name.empty())
      out.push_back({file, number, "'" + name + "' is shared by all runtimes of the process"});
}

// By name: where two functions share one, the dead one hides behind the other. The linker finds those (dead.sh).
void Inside::find_dead(std::vector<Offence>& out) const {
  std::set<std::string> ours, of_tests;
  for (const auto& [file, source] : files_)
    for (const Use& use : source.uses)
      if (use.name != use.inside) (begins(file, "tests/") ? of_tests : ours).insert(use.name);
  for (const auto& [file, source] : files_) {
    // Hosts call what is installed; samples are hosts.
    if (begins(file, "tests/") || begins(file, "samples/") || begins(file, "hostapi/include/")) continue;
    for (const Name& name : source.names) {
      if (!is_called_by_name(name) || !is_in_our_style(name.name) || ours.count(name.name) != 0) continue;
      if (begins(name.name, "luaopen_")) continue;  // the entry of a Lua module, which interpreters find by its name
      const bool tested = of_tests.count(name.name) != 0;
      if (tested && for_tests_.count(name.name) != 0) continue;
      // A method of ours is declared in a header; where only its body is, its base class says who calls it.
      const bool declared = name.owner.empty() || name.in_class;
      if (declared)
        out.push_back({file, name.first_line,
                       "'" + name.name + "' is called by " + (tested ? "tests only" : "nobody") +
                           "; remove it, or give a reason in for_tests.txt"});
    }
  }
}

// The text below a heading: declarations up to the next heading, access specifier or end of the class.
void Inside::find_false_headings(const std::string& file, const Source& source, std::vector<Offence>& out) const {
  const std::string folder = fs::path(file).parent_path().generic_string() + "/";
  std::vector<std::pair<std::size_t, std::vector<std::string>>> headings;
  for (const Comment& comment : source.comments)
    if (auto names = files_of_heading(comment); !names.empty()) headings.emplace_back(comment.line, std::move(names));
  for (std::size_t i = 0; i < headings.size(); ++i) {
    const auto& line = headings[i].first;
    const auto& names = headings[i].second;
    std::set<std::tuple<std::string, std::string>> defined, elsewhere;
    for (const auto& [other, content] : files_) {
      if (!begins(other, folder) || is_header(other)) continue;
      const bool named = std::find(names.begin(), names.end(), other.substr(folder.size())) != names.end();
      for (const Name& name : content.names)
        if (name.function && name.defined) (named ? defined : elsewhere).emplace(last_part(name.owner), name.name);
    }
    for (const std::string& name : names)
      if (files_.count(folder + name) == 0)
        out.push_back({file, line, "the heading names " + name + ", which is not there"});
    std::size_t end = i + 1 < headings.size() ? headings[i + 1].first : ~std::size_t{0};
    // Nested classes have ends of their own; the scope's is the first that closes no name below the heading.
    for (const Name& name : source.names) {
      if (!name.function || name.defined || name.overrides || name.first_line < line || name.first_line >= end)
        continue;
      const bool past = std::any_of(source.breaks.begin(), source.breaks.end(),
                                    [&](std::size_t at) { return at > line && at < name.first_line; });
      if (past) break;
      const std::tuple key(last_part(name.owner), name.name);
      if (defined.count(key) == 0 && elsewhere.count(key) != 0)
        out.push_back({file, name.first_line,
                       "'" + name.name + "' stands below a heading that names another file than it is in"});
    }
  }
}

std::vector<Offence> names_that_meet(const fs::path& root, const fs::path& build) {
  std::vector<Offence> out;
  std::map<std::string, Source> read;
  static const std::regex include(R"re(#include "(.*)")re");
  for (const auto& entry : fs::recursive_directory_iterator(build)) {
    if (entry.path().parent_path().filename() != "Unity" || entry.path().extension() != ".cxx") continue;
    std::map<std::pair<std::string, std::string>, std::string> first;
    std::ifstream lot(entry.path());
    std::string line;
    while (std::getline(lot, line)) {
      std::smatch found;
      if (!std::regex_search(line, found, include)) continue;
      const std::string path = found[1];
      const std::string file = fs::path(path).lexically_relative(root).generic_string();
      if (begins(file, "tests/arrows/broken/")) continue;  // the checker's own fixture
      if (read.count(path) == 0) read[path] = read_source(path);
      for (const Name& name : read[path].names) {
        const bool local = name.owner.empty() && (name.space.find("{}") != std::string::npos || name.is_static);
        if (!local || !name.defined || name.name == "TEST" || name.name == "TEST_F" || name.name == "TEST_P") continue;
        // Two names meet if they are looked up in the same places: the unnamed namespace is a part of what is around
        // it.
        const std::string space = std::regex_replace(name.space, std::regex(R"((::)?\{\})"), "");
        const auto [at, is_new] = first.emplace(std::pair(space, name.name), file);
        if (!is_new && at->second != file)
          out.push_back({file, name.first_line,
                         "'" + name.name + "' is in " + at->second + " too, and both are compiled in one lot"});
      }
    }
  }
  return out;
}

}  // namespace breve::house
