// Natives that run script: while they do, a method may free or change whatever they hold, and call them again. The list
// is made from the sources, and each of them has programs that do just that (tests/steve/library/running_script).
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace breve::steve {
namespace script_natives {

namespace fs = std::filesystem;
using Function = std::pair<std::string, std::string>;  // file and name

std::string read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string without_comments(const std::string& text) {
  return std::regex_replace(std::regex_replace(text, std::regex("//[^\n]*"), ""), std::regex(R"("(\\.|[^"\\\n])*")"),
                            "\"\"");
}

std::size_t end_of_block(const std::string& text, std::size_t at) {
  for (int depth = 1; depth > 0 && at < text.size(); ++at) depth += (text[at] == '{') - (text[at] == '}');
  return at;
}

/// All matches of the first group of `pattern`.
std::set<std::string> all_of(const std::string& text, const std::regex& pattern) {
  std::set<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) found.insert(at->str(1));
  return found;
}

/// The sources of the natives as a graph: which function calls which, by name. A name means the function of the same
/// file if there is one; else one that a header declares or, behind a dot, the only member of that name.
class Sources {
 public:
  Sources() {
    for (const fs::path& path : files()) {
      const std::string text = read(path), name = path.filename();
      natives_of(name, text);
      functions_of(name, without_comments(text));
      if (path.extension() == ".hpp") declared_.merge(all_of(without_comments(text), std::regex(R"(\b(\w+)\()")));
    }
    spread();
  }

  /// Names of natives whose functions run script, or call what does.
  std::set<std::string> that_run_script() const {
    std::set<std::string> names;
    for (const auto& [native, function] : natives_)
      for (const std::string& part : function.second)
        for (const Function& meant_by_it : meant(function.first, part))
          if (run_.contains(meant_by_it)) names.insert(native);
    return names;
  }
  std::size_t natives() const { return natives_.size(); }

 private:
  static std::vector<fs::path> files() {
    std::vector<fs::path> found;
    const fs::path steve = fs::path(BREVE_SOURCES) / "steve";
    for (const char* folder : {"library", "machine"})
      for (const auto& entry : fs::directory_iterator(steve / folder)) {
        const std::string name = entry.path().filename();
        const bool source = name.ends_with(".cpp") || name.ends_with(".hpp");
        if (source && (std::string_view(folder) == "library" || name.starts_with("functions"))) found.push_back(entry);
      }
    return found;
  }

  void natives_of(const std::string& file, const std::string& text) {
    static const std::regex kNative(R"(native<([^;]*?)>\(\s*"([^"]+)\")");
    for (std::sregex_iterator at(text.begin(), text.end(), kNative), end; at != end; ++at)
      natives_[at->str(2)] = {file, all_of(at->str(1), std::regex(R"((\w+))"))};
  }

  void functions_of(const std::string& file, const std::string& text) {
    static const std::regex kHead(
        R"(([\w&*>:] *|\n|explicit )\b([A-Za-z_]\w*)\(([^;{}]*)\)[ \n]*(const|noexcept|override|[ \n]|->[^{;]*|:[^{;]*)*\{)");
    for (std::sregex_iterator at(text.begin(), text.end(), kHead), end; at != end; ++at) {
      static const std::set<std::string> kWords = {"if", "for", "while", "switch", "catch", "return"};
      if (kWords.contains(at->str(2))) continue;
      const auto from = static_cast<std::size_t>(at->position() + at->length());
      const auto name_at = static_cast<std::size_t>(at->position(2));
      const std::size_t line = text.rfind('\n', name_at) + 1;
      const bool indented = text[line] == ' ';
      if (indented || text.substr(line, name_at - line).ends_with("::")) members_.insert({file, at->str(2)});
      bodies_[{file, at->str(2)}] += text.substr(from, end_of_block(text, from) - from);
    }
  }

  /// The functions that `name` may be in this file. A member's name begins with a dot.
  std::vector<Function> meant(const std::string& file, const std::string& name) const {
    const bool member = name.front() == '.';
    const std::string plain = name.substr(member ? 1 : 0);
    if (bodies_.contains({file, plain})) return {{file, plain}};
    std::vector<Function> found;
    for (const auto& [function, body] : bodies_)
      if (function.second == plain && members_.contains(function) == member) found.push_back(function);
    if (member ? found.size() > 1 : !declared_.contains(plain)) found.clear();
    return found;
  }

  /// From what runs script itself to all that call it.
  void spread() {
    // The machine runs methods, `init`, `destroy` and descriptions; the world runs handlers.
    static const std::regex kRunsScript(
        R"((machine_?\.(call|call_guarded|call_with_keywords|create|free_instance|text|evaluate)\()"
        R"(|\.announce\(|advance_bodies\())");
    static const std::regex kCalled(R"(((?:\.|\b)[A-Za-z_]\w*)[(<])");
    std::map<Function, std::vector<Function>> callers;
    std::vector<Function> fresh;
    for (const auto& [function, body] : bodies_) {
      if (std::regex_search(body, kRunsScript)) fresh.push_back(function);
      for (const std::string& name : all_of(body, kCalled))
        for (const Function& callee : meant(function.first, name)) callers[callee].push_back(function);
    }
    while (!fresh.empty()) {
      const Function function = fresh.back();
      fresh.pop_back();
      if (run_.insert(function).second) fresh.insert(fresh.end(), callers[function].begin(), callers[function].end());
    }
  }

  std::map<std::string, std::pair<std::string, std::set<std::string>>> natives_;  // to a file and names of functions
  std::map<Function, std::string> bodies_;
  std::set<Function> members_;
  std::set<Function> run_;  // script
  std::set<std::string> declared_;
};

/// From the first lines of the programs: "# natives: object.announce notify", where "# natives: " is the mark.
std::map<std::string, std::string> programs(std::string_view mark) {
  std::map<std::string, std::string> found;
  for (const auto& entry : fs::directory_iterator(fs::path(BREVE_STEVE_TESTS) / "library" / "running_script")) {
    std::istringstream lines(read(entry.path()));
    for (std::string line; std::getline(lines, line) && line.starts_with('#');) {
      if (!line.starts_with(mark)) continue;
      std::istringstream names(line.substr(mark.size()));
      for (std::string name; names >> name;) found[name] = entry.path().filename();
    }
  }
  return found;
}

TEST(ScriptNatives, EachThatRunsScriptHasProgramsThatFreeWhatItHoldsAndCallItAgain) {
  const Sources sources;
  const std::set<std::string> run = sources.that_run_script();
  EXPECT_GT(sources.natives(), 700U) << "the sources are not read as they are written";
  for (const char* mark : {"# natives: ", "# again: "}) {
    const std::map<std::string, std::string> programs_of = programs(mark);
    for (const std::string& name : run)
      EXPECT_TRUE(programs_of.contains(name))
          << name << " can run script: give it a program in running_script, with the mark '" << mark << "'";
    for (const auto& [name, program] : programs_of)
      EXPECT_TRUE(run.contains(name)) << name << ", of " << program << ", does not run script";
  }
}

/// The graph is found as it should be: a few that everybody knows, and a few that do not.
TEST(ScriptNatives, TheListIsThatOfTheSources) {
  const std::set<std::string> run = Sources().that_run_script();
  for (const char* name : {"object.announce", "callMethodNamed", "control.iterate", "object.archive-as-xml",
                           "patch-grid.update-states", "multi-body.rotate", "menu.create"})
    EXPECT_TRUE(run.contains(name)) << name;
  for (const char* name : {"matrix-2d.get-value", "mobile.get-velocity", "sqrt"}) EXPECT_FALSE(run.contains(name));
}

}  // namespace script_natives
}  // namespace breve::steve
