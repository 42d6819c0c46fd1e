// The statuses that the installed headers name for each function, against those that its code gives: each
// BREVE_ERROR_... in the function and in what it calls in hostapi/src has to be named. Errors that come from further
// inside are found by the fuzzers, which compare what functions return with the same comments.
//
// A comment names a status itself, or refers to another function ("As breve_object_call"), or stands below one that
// says "The same below" in its section. The rules for all functions are at the top of breve.h.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "source.hpp"

namespace breve::house {
namespace {

using Names = std::set<std::string>;

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The words of a text that begin with `prefix`.
Names words_with(std::string_view text, std::string_view prefix) {
  Names found;
  for (std::size_t at = text.find(prefix); at != std::string_view::npos; at = text.find(prefix, at + 1)) {
    if (at != 0 && is_word(text[at - 1])) continue;
    std::size_t end = at;
    while (end < text.size() && is_word(text[end])) ++end;
    found.emplace(text.substr(at, end - at));
  }
  return found;
}

// --- headers ---------------------------------------------------------------------------------------------------------

struct Documented {
  std::string file;
  Names statuses, referred;  // referred: functions whose statuses it also has
};

class Headers {
 public:
  void read(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    Names section;  // of comments that hold for what follows
    std::string comment;
    for (std::size_t at = 0; at < text.size();) {
      if (text.compare(at, 2, "/*") == 0) {
        const std::size_t end = std::min(text.find("*/", at), text.size());
        comment = text.substr(at, end - at);
        if (comment.find("----") != std::string::npos) section.clear();
        at = end;
      } else if (text.compare(at, kReturns.size(), kReturns) == 0) {
        const std::size_t begin = at + kReturns.size(), end = text.find('(', begin);
        add(text.substr(begin, end - begin), path.filename(), comment, section);
        if (comment.find("he same below") != std::string::npos || comment.find("unctions below") != std::string::npos)
          section.merge(words_with(comment, kError));
        comment.clear();
        at = end;
      } else {
        ++at;
      }
    }
  }

  const std::map<std::string, Documented>& functions() const { return functions_; }

  /// With those of the functions that it refers to.
  Names statuses_of(const std::string& function) const {
    Names all, seen;
    std::vector<std::string> open{function};
    while (!open.empty()) {
      const std::string name = open.back();
      open.pop_back();
      const auto found = functions_.find(name);
      if (found == functions_.end() || !seen.insert(name).second) continue;
      all.insert(found->second.statuses.begin(), found->second.statuses.end());
      open.insert(open.end(), found->second.referred.begin(), found->second.referred.end());
    }
    return all;
  }

 private:
  static constexpr std::string_view kReturns = "BREVE_API breve_status ", kError = "BREVE_ERROR_";

  void add(const std::string& name, const std::string& file, const std::string& comment, const Names& section) {
    Documented& one = functions_[name] = {file, words_with(comment, kError), {}};
    for (const std::string& end : words_with(comment, "_"))  // "BREVE_ERROR_SCRIPT, _BUDGET"
      one.statuses.insert(std::string(kError) + end.substr(1));
    one.statuses.insert(section.begin(), section.end());
    for (const std::string_view mark : {"As ", "as for ", "ike ", "same statuses as "})
      for (std::size_t at = comment.find(mark); at != std::string::npos; at = comment.find(mark, at + 1)) {
        const std::string_view behind = std::string_view(comment).substr(at + mark.size());
        if (behind.substr(0, 6) == "breve_")
          one.referred.merge(words_with(behind.substr(0, behind.find_first_of(" ;,.:")), "breve_"));
      }
  }

  std::map<std::string, Documented> functions_;
};

// --- code ------------------------------------------------------------------------------------------------------------

class Code {
 public:
  void read(const std::filesystem::path& path) {
    const Source source = read_source(path);
    const std::string file = path.filename();
    for (const Name& name : source.names)
      if (name.function && name.defined && name.owner.empty() && !name.in_class)
        (name.space.find("{}") == std::string::npos ? files_of_ : hidden_in_)[name.name].insert(file);
    for (const Use& use : source.uses) uses_[{file, use.inside}].insert(use.name);
  }

  /// Each status that a function and what it calls may give, and where: "file: function".
  std::map<std::string, std::string> statuses_of(const std::string& function) const {
    std::map<std::string, std::string> all;
    std::set<Place> seen;
    std::vector<Place> open = places_of(function, "");
    while (!open.empty()) {
      const Place place = open.back();
      open.pop_back();
      if (!seen.insert(place).second) continue;
      const auto uses = uses_.find(place);
      if (uses == uses_.end()) continue;
      for (const std::string& name : uses->second) {
        if (name.rfind("BREVE_ERROR_", 0) == 0) all.emplace(name, place.first + ": " + place.second);
        // Other functions of the interface have comments of their own; what turns exceptions into statuses knows all.
        if (name.rfind("breve_", 0) == 0 || kTranslators.count(name) != 0) continue;
        const std::vector<Place> called = places_of(name, place.first);
        open.insert(open.end(), called.begin(), called.end());
      }
    }
    return all;
  }

  bool knows(const std::string& function) const { return files_of_.count(function) != 0; }

 private:
  using Place = std::pair<std::string, std::string>;  // file, function
  inline static const Names kTranslators = {"guard", "status_of", "keep_current"};

  /// Where a name that is used in a file is defined: there, or else wherever it is.
  std::vector<Place> places_of(const std::string& function, const std::string& file) const {
    std::vector<Place> places;
    const auto hidden = hidden_in_.find(function);
    if (hidden != hidden_in_.end() && hidden->second.count(file) != 0) return {{file, function}};
    const auto found = files_of_.find(function);
    if (found == files_of_.end()) return places;
    if (found->second.count(file) != 0) return {{file, function}};
    for (const std::string& one : found->second) places.emplace_back(one, function);
    return places;
  }

  std::map<std::string, Names> files_of_, hidden_in_;  // hidden: in unnamed namespaces
  std::map<Place, Names> uses_;
};

// Rules of all functions: NULL handles and numbers that are not finite, ids that are gone, memory, defects; and
// pointers of scripts, which `from_host` refuses.
const Names kAlways = {"BREVE_ERROR_ARGUMENT", "BREVE_ERROR_STALE", "BREVE_ERROR_MEMORY", "BREVE_ERROR_INTERNAL"};
constexpr std::string_view kRefusesPointers = "values.cpp: from_host";

int check(const std::filesystem::path& root) {
  Headers headers;
  Code code;
  for (const auto& entry : std::filesystem::directory_iterator(root / "hostapi/include/breve"))
    if (entry.path().extension() == ".h") headers.read(entry.path());
  for (const auto& entry : std::filesystem::directory_iterator(root / "hostapi/src"))
    if (entry.path().extension() == ".cpp" || entry.path().extension() == ".hpp") code.read(entry.path());
  std::size_t checked = 0, failed = 0;
  for (const auto& [function, documented] : headers.functions()) {
    if (!code.knows(function)) continue;  // of another folder, such as the binding of Lua
    ++checked;
    const Names named = headers.statuses_of(function);
    for (const auto& [status, place] : code.statuses_of(function)) {
      if (named.count(status) != 0 || kAlways.count(status) != 0 || place == kRefusesPointers) continue;
      ++failed;
      std::printf("%s: %s may give %s (%s), which its comment does not name\n", documented.file.c_str(),
                  function.c_str(), status.c_str(), place.c_str());
    }
  }
  std::printf("%zu functions, %zu statuses are not named\n", checked, failed);
  return checked == 0 || failed != 0;
}

}  // namespace
}  // namespace breve::house

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "statuses ROOT\n");
    return 2;
  }
  return breve::house::check(arguments[1]);
}
