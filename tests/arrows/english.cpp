// Plain English: finds turns of phrase that a reader has to read twice, and citations of documents that nobody can
// read here, in pages, comments and messages. Prints each with its reason; exits 1 if there is one.
// Usage: english SOURCE_DIR; english --count SOURCE_DIR prints the number of findings in each folder, and exits 0.
#include <array>
#include <filesystem>
#include <iostream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "prose.hpp"

namespace fs = std::filesystem;

namespace {

struct Rule {
  std::string_view name;
  std::string_view key;      // the pattern is tried only where the text has this
  std::string_view pattern;  // ECMAScript
  std::string_view unless;   // not an offence if this is found in the match; "" for never
  std::string_view reason;
};

constexpr std::array<Rule, 23> kRules{{
    {"is no", " no ", R"((^|[\w']+ )(is|are|was|were) no \w+)",
     R"(^([Tt]|[Ww])?here |no (longer|more|less|later|earlier|better|worse|matter|farther|smaller|larger|such)$)",
     "write 'is not a'"},
    {"is none", " none", R"((^|\w+ )((is|are|was|were) none\b|none that\b))", R"(^[Tt]here )",
     "say what it is: 'is not finite', 'is invalid'"},
    {"tells of", " of", R"(\b([Tt]ells?|[Tt]old) of\b)", "", "write 'reports' or 'describes'"},
    {"is told", " told", R"(\b(is|are|was|were|be) told( \w+)?)", R"(told (to|apart)$)",
     "write 'is reported', or name the call"},
    {"Nothing if", "Nothing if", R"((^|[.:;] )Nothing if\b)", "", "write 'Does nothing if'"},
    {"too,", " too", R"(\w+,? too, |\w+,? too([.;:)]|$))", "", "write 'also' or 'including' before what is added"},
    {"as well.", " as well", R"(\bas well([.;:)]|$))", "", "write 'also' before what is added"},
    {"free relative: who", "ho ", R"((^|[.;] )Who [a-z]+s\b[^?]*?[.;]|\b(for|to|by|that) who\b)", "",
     "name the person: 'the reader', 'a host that'"},
    {"free relative: what", "What ",
     R"((^|[.:;] )What (is|are|was|were|has|have|does|do|did|comes|goes|stands|can|cannot|may|must|remains|holds|hangs|moves|touches)\b[^.?]*\??)",
     R"(\?$)", "name the thing instead of 'what is'"},
    {"fronted genitive", "Of ",
     R"((^|[.:;] )Of (a|an|the|two|all|what|these|those|several|both|each|every|its|their) )", "",
     "put the subject first: 'If both bodies have one, ...'"},
    {"where there is none", " none", R"(\b[Ww]here there (is|are) none\b)", "", "write 'if there is none', or name it"},
    {"lets go", " go", R"(\b([Ll]ets?|letting) go\b)", "", "write 'disconnects', 'releases'"},
    {"and its like", " like", R"(\band (its|their|the) like\b)", "", "write 'and similar methods', or 'such as'"},
    {"term", "", R"(\bno account\b|\b(from|of) nowhere\b|\b(own|energy) account\b)", "",
     "the field's terms: energy ledger, unexplained energy"},
    {"term: felt", "fe",
     R"(\b(mass|inertia|point|body|bodies|joint|motor|row|side)s? (that |which )?(is |are )?(feels?|felt)\b)"
     R"(|\bfelt (mass|inertia)\b|\b(joint|point|body)'s motor feels\b)",
     "", "the field's terms: effective mass, effective inertia; a body receives a force"},
    {"term: ring", "ing",
     R"(\b([Cc]los(e|es|ed|ing)|[Oo]pens?|[Hh](o|e)lds?) (a|the|their|its|such|these)? ?rings?\b)"
     R"(|\brings? (that )?(is |are )?(closed|close|open|hold)\b|\b[Rr]ing joints?\b)",
     "", "the field's terms: closed loop, loop joint"},
    {"term: tie", "ti",
     R"(\b[Ss]prings? (that |which |only )?(tie|ties|tied)\b|\b([Tt]ied|[Tt]ying) (to|by|together|with)\b)"
     R"(|\b[Tt]ies (bodies|links|trees)\b|\b(joint|spring), tie\b)",
     "", "springs connect bodies"},
    {"term: turn", "urn",
     R"(\b[Tt]urn(s|ed|ing)? (freely |evenly |fast |slowly )?about (its|their|an?|the|[xyz]|some|one|that|which)\b)"
     R"(|\b(whole|full|quarter|half|all its) turns?\b|\bplace and turn\b|\bturn and (place|spin)\b)"
     R"(|\b(bodies|body|links?|joints?|wheels?|limbs?|spin|shapes?) (that )?turns?\b)",
     "", "the field's terms: rotation, orientation; a body rotates"},
    {"term: turns", "turn", R"(^turns\b|\b(many|some|more|[0-9]+|million|thousand) turns\b|\bturns? of (a|the) loop\b)",
     "", "a loop has iterations, a joint full rotations"},
    {"term: quiet", "uiet",
     R"(\b[Qq]uiet (bod|island|pair|contact|stack|pile)\w*)"
     R"(|\b(bod(y|ies)|islands?|stacks?|piles?) (is|are|gets?|becomes?|lies?|stands?) quiet\b)",
     "", "the field's term: a body is resting, or comes to rest"},
    {"term: place", "place",
     R"(\b(body|bodies|link|object|child|parent|joint)('s|s') places?\b)"
     R"(|\bplaces? and (velocit|spin|orientation|rotation|turn)\w*)",
     "", "the field's terms: position, pose"},
    {"citation", "",
     R"(\bDESIGN [0-9]|\bCLASSES [0-9]|\bSTYLE\.md|\b[Ll]anguage(,| document,?) (section )?[0-9]|[(; ]F[0-9]{1,2}\b[,;)])",
     "", "give the reason in place, or cite a paper or book"},
    {"dangling number", " (", R"((^expect: .*)?[a-z]{3,} \([0-9]{1,2}\)[.,:;])", R"(^expect: )",
     "say what the number is, or name the section that it cites"},
}};

/// Not ours to reword: fuzz inputs, pages that `breve doc` makes of checked comments, and what tests this test.
bool is_left_out(const std::string& file) {
  for (const std::string_view start :
       {"docs/reference/", "tests/fuzz/corpus/", "tests/arrows/broken/", "tests/arrows/english.cpp"})
    if (file.rfind(start, 0) == 0) return true;
  return false;
}

using Offence = std::tuple<std::string, std::size_t, std::string>;  // file, line, what

class English {
 public:
  explicit English(fs::path root) : root_(std::move(root)) {
    for (const Rule& rule : kRules) {
      patterns_.emplace_back(std::string(rule.pattern));
      unless_.emplace_back(std::string(rule.unless));
    }
  }

  void read() {
    for (const char* page : {"README.md", "CHANGES.md", "CMakeLists.txt", "run"})
      if (fs::exists(root_ / page)) read_file(root_ / page);
    for (const char* top : {"cmake", "docs", "hostapi", "runtime", "samples", "steve", "tests"})
      if (fs::exists(root_ / top))
        for (const auto& entry : fs::recursive_directory_iterator(root_ / top))
          if (entry.is_regular_file()) read_file(entry.path());
  }

  int report() const {
    std::size_t offences = 0;
    for (const auto& [folder, found] : found_) {
      for (const auto& [file, line, what] : found) std::cout << file << ':' << line << ": " << what << '\n';
      offences += found.size();
    }
    std::cout << paragraphs_ << " paragraphs, " << offences << " offences\n";
    if (paragraphs_ == 0) std::cout << "no prose under " << root_ << ": wrong folder?\n";
    return offences == 0 && paragraphs_ > 0 ? 0 : 1;
  }

  int count() const {
    for (const auto& [folder, found] : found_) std::cout << folder << ": " << found.size() << '\n';
    return 0;
  }

 private:
  static std::string folder_of(const std::string& file) {
    const std::size_t first = file.find('/');
    const std::size_t second = first == std::string::npos ? first : file.find('/', first + 1);
    return file.substr(0, second == std::string::npos ? first : second);
  }

  void read_file(const fs::path& path) {
    const std::string file = fs::relative(path, root_).generic_string();
    if (is_left_out(file)) return;
    for (const breve::house::Paragraph& paragraph : breve::house::prose_of(path)) {
      ++paragraphs_;
      for (std::size_t i = 0; i < kRules.size(); ++i)
        if (paragraph.text.find(kRules[i].key) != std::string::npos) try_rule(i, file, paragraph);
    }
  }

  void try_rule(std::size_t i, const std::string& file, const breve::house::Paragraph& paragraph) {
    const std::string& text = paragraph.text;
    for (std::sregex_iterator match(text.begin(), text.end(), patterns_[i]), end; match != end; ++match) {
      if (!kRules[i].unless.empty() && std::regex_search(match->str(), unless_[i])) continue;
      const auto at = static_cast<std::size_t>(match->position());
      found_[folder_of(file)].emplace(file, paragraph.line_of(at),
                                      "'" + std::string(kRules[i].name) + "' in \"" + match->str().substr(0, 60) +
                                          "\": " + std::string(kRules[i].reason));
    }
  }

  fs::path root_;
  std::vector<std::regex> patterns_, unless_;
  std::map<std::string, std::set<Offence>> found_;
  std::size_t paragraphs_ = 0;
};

}  // namespace

int main(int count, char** arguments) {
  const bool counting = count == 3 && std::string_view(arguments[1]) == "--count";
  if (count != 2 && !counting) {
    std::cerr << "usage: english [--count] SOURCE_DIR\n";
    return 2;
  }
  English english(arguments[count - 1]);
  english.read();
  return counting ? english.count() : english.report();
}
