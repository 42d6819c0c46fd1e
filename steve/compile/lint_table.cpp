// The table of lints, and how they are turned off.
#include "steve/compile/lint_table.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace breve::steve {

namespace {

using enum Severity;

// KEEP IN STEP: docs/messages.md.
constexpr std::array kLints{
    Lint{"lint-allow", Warning, "a comment '# allow:' names an unknown lint"},
    Lint{"lint-assignment-condition", Warning, "a condition is an assignment, where '==' may be meant"},
    Lint{"lint-assignment-element", Warning, "an element of a list is an assignment, where '==' may be meant"},
    Lint{"lint-bypassed-override", Warning, "calls that match the parent's method never reach this override"},
    Lint{"lint-call-on-value", Warning, "a method is called on a number, text or another value without methods"},
    Lint{"lint-chained-comparison", Warning, "'a < b < c', which compares the result of 'a < b' with c"},
    Lint{"lint-dot", Warning, "'a.b' without spaces: two statements, the second without effect"},
    Lint{"lint-escaped-dollar", Warning, "'\\$' in a string, which keeps its backslash"},
    Lint{"lint-implicit-return", Note, "the value of a method without 'return' is used"},
    Lint{"lint-include-comment", Warning, "'#include' is a comment"},
    Lint{"lint-interpolation", Warning, "a '$' reference in a string that ends earlier than it seems to"},
    Lint{"lint-keywords", Warning, "a call whose keywords no method of that name takes"},
    Lint{"lint-leading-percent", Warning, "a line that begins with '%' in the middle of an expression"},
    Lint{"lint-list-sum", Warning, "two lists are added, which adds their lengths"},
    Lint{"lint-lone-dollar", Warning, "a '$' in a string that refers to nothing"},
    Lint{"lint-minus-spacing", Warning, "'a -1', which is a subtraction"},
    Lint{"lint-new-count", Warning, "'n new Class' with a count that is not a literal: a count of 1 gives no list"},
    Lint{"lint-nib-file", Warning, "an interface file, which is ignored"},
    Lint{"lint-no-super-iterate", Warning, "the controller's iterate does not call 'super iterate'"},
    Lint{"lint-object-string", Warning, "an object is compared with a string, which is never equal"},
    Lint{"lint-one-argument-atan2", Warning, "atan2 with one argument, which is atan"},
    Lint{"lint-precedence", Warning, "'^' next to other operators: it takes everything to its left"},
    Lint{"lint-scalar-by-vector", Warning, "a number divided by a vector"},
    Lint{"lint-shadow", Warning, "a local variable hides an instance variable"},
    Lint{"lint-special-parameters", Warning,
         "init, iterate or a similar method with parameters, which is never called"},
    Lint{"lint-string-sum", Warning, "a text and a number are added, which gives a number"},
    Lint{"lint-super-init", Warning, "'super init', which runs the parent's init a second time"},
    Lint{"lint-unknown-class", Warning, "an object of a class that does not exist"},
    Lint{"lint-unknown-method", Warning, "a method that no class has, or that the receiver's class does not have"},
    Lint{"lint-unused-comparison", Warning, "a comparison whose result is not used, where '=' may be meant"},
    Lint{"lint-unused-local", Warning, "a local variable is never read"},
    Lint{"lint-unused-parameter", Note, "a parameter is never used"},
    Lint{"lint-unused-variable", Warning, "an instance variable is never used"},
};
static_assert(std::is_sorted(kLints.begin(), kLints.end(),
                             [](const Lint& a, const Lint& b) { return a.code < b.code; }));

constexpr std::string_view kMark = "# allow:";

bool is_code_char(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; }

/// What the comments of one file allow.
class FileAllowances {
 public:
  FileAllowances(const Sources& sources, std::uint32_t file, Diagnostics& complaints) {
    const std::string_view text = sources.file(file).text;
    if (text.find(kMark) == std::string_view::npos) return;
    bool head = true;  // nothing but comments so far
    for (std::uint32_t line = 1; line <= sources.file(file).lines.size(); ++line) {
      const std::string_view content = sources.line_text({file, 0, 0, line, 1});
      const std::size_t first = content.find_first_not_of(" \t");
      const std::size_t mark = content.find(kMark);
      if (mark != std::string_view::npos) read(sources, file, content, mark, line, head, first == mark, complaints);
      if (first != std::string_view::npos && content[first] != '#') head = false;
    }
  }
  bool allows(std::string_view code, std::uint32_t line) const {
    const auto found = lines_.find(line);
    return everywhere_.contains(code) || (found != lines_.end() && found->second.contains(code));
  }

 private:
  void read(const Sources& sources, std::uint32_t file, std::string_view content, std::size_t mark, std::uint32_t line,
            bool head, bool alone, Diagnostics& complaints) {
    std::size_t at = mark + kMark.size();
    while (at < content.size()) {
      while (at < content.size() && (content[at] == ' ' || content[at] == ',' || content[at] == '\t')) ++at;
      std::size_t end = at;
      while (end < content.size() && is_code_char(content[end])) ++end;
      if (end == at) break;
      const std::string_view code = content.substr(at, end - at);
      if (find_lint(code) == nullptr) {
        std::vector<std::string_view> codes;
        for (const Lint& lint : kLints) codes.push_back(lint.code);
        const std::string near = nearest(code, codes);
        const auto offset = static_cast<std::uint32_t>(content.data() + at - sources.file(file).text.data());
        complaints.warning(sources.span_at(file, offset, static_cast<std::uint32_t>(end - at)), "lint-allow",
                           "there is no lint '" + std::string(code) + "'",
                           near.empty() ? "the code of a lint is shown in brackets after its message"
                                        : "did you mean '" + near + "'?");
      } else if (head) {
        everywhere_.insert(std::string(code));
      } else {
        lines_[alone ? line + 1 : line].insert(std::string(code));
      }
      at = end;
    }
  }

  AllowedLints everywhere_;
  std::map<std::uint32_t, AllowedLints> lines_;
};

}  // namespace

std::span<const Lint> lints() { return kLints; }

const Lint* find_lint(std::string_view code) {
  const auto found = std::lower_bound(kLints.begin(), kLints.end(), code,
                                      [](const Lint& lint, std::string_view key) { return lint.code < key; });
  return found != kLints.end() && found->code == code ? &*found : nullptr;
}

Diagnostics finished(const Diagnostics& all, const Sources& sources, const AllowedLints& allowed) {
  std::vector<Diagnostic> list = all.all();
  Diagnostics complaints;
  std::map<std::uint32_t, FileAllowances> files;
  for (std::uint32_t file = 0; file < sources.size(); ++file)
    if (!sources.file(file).embedded) files.try_emplace(file, sources, file, complaints);
  list.insert(list.end(), complaints.all().begin(), complaints.all().end());
  std::stable_sort(list.begin(), list.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::pair(a.span.file, a.span.offset) < std::pair(b.span.file, b.span.offset);
  });
  // That a number has no methods makes it no news that no class has this one.
  std::set<std::pair<std::uint32_t, std::uint32_t>> called_values;
  for (const Diagnostic& diagnostic : list)
    if (diagnostic.code == "lint-call-on-value") called_values.emplace(diagnostic.span.file, diagnostic.span.line);
  std::erase_if(list, [&](const Diagnostic& d) {
    return d.code == "lint-unknown-method" && called_values.contains({d.span.file, d.span.line});
  });
  Diagnostics result;
  for (Diagnostic& diagnostic : list) {
    if (const Lint* lint = diagnostic.severity == Error ? nullptr : find_lint(diagnostic.code)) {
      const auto file = files.find(diagnostic.span.file);
      const bool in_file = file != files.end() && diagnostic.span.line > 0;
      if (allowed.contains(lint->code) || (in_file && file->second.allows(lint->code, diagnostic.span.line))) continue;
      diagnostic.severity = lint->severity;
    }
    result.add(std::move(diagnostic));
  }
  return result;
}

}  // namespace breve::steve
