// Line by line, as editors do: no expression sees more than its line.
#include "tokeniser.hpp"

#include <oniguruma.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string_view>

namespace breve::test {

using nlohmann::json;

namespace {

struct RegionDeleter {
  void operator()(OnigRegion* region) const { onig_region_free(region, 1); }
};

}  // namespace

/// Compiled. Oniguruma's header and that of POSIX expressions cannot be seen together: it stays in this file.
class Grammar::Rules {
 public:
  explicit Rules(const json& definition);
  std::vector<std::string> scopes(const std::string& text) const;

 private:
  using Captures = std::map<int, std::string>;
  struct RegexDeleter {
    void operator()(regex_t* regex) const { onig_free(regex); }
  };
  using Regex = std::unique_ptr<regex_t, RegexDeleter>;
  struct Rule {
    std::string name;
    Regex begin, end;  // `begin` alone: a match
    Captures begin_captures, end_captures;
    std::vector<const Rule*> patterns;  // inside
  };
  struct Hit {
    const Rule* rule = nullptr;  // null: the end of the innermost rule
    std::vector<std::pair<int, int>> groups;
  };
  class Run;

  std::vector<const Rule*> compile_all(const nlohmann::json& patterns, const nlohmann::json& repository);
  static Regex compile(const std::string& expression);
  static Captures captures_of(const nlohmann::json& rule, const char* key);

  std::map<std::string, std::vector<const Rule*>> repository_;
  std::vector<std::unique_ptr<Rule>> rules_;
  std::vector<const Rule*> top_;
};

/// One text being tokenised.
class Grammar::Rules::Run {
 public:
  Run(const Rules& grammar, const std::string& text) : grammar_(grammar), text_(text), scopes_(text.size()) {}

  std::vector<std::string> run() {
    for (std::size_t start = 0; start < text_.size();) {
      const std::size_t end = std::min(text_.find('\n', start), text_.size());
      line(start, end);
      start = end + 1;
    }
    return std::move(scopes_);
  }

 private:
  void line(std::size_t start, std::size_t end) {
    const std::string line = text_.substr(start, end - start) + "\n";
    const int length = static_cast<int>(end - start);
    int at = 0;
    int turns = 0;
    while (at <= length) {
      const Hit hit = find(line, at, start == 0);
      const int stop = hit.groups.empty() ? length : std::min(hit.groups[0].first, length);
      paint(start, at, stop, {});
      if (hit.groups.empty()) return;
      if (hit.groups[0].first >= length && hit.groups[0].second > length) return;
      take(start, hit, length);
      // Matches of nothing must not be repeated for ever.
      const int next = std::min(hit.groups[0].second, length);
      if (next == at && ++turns > 100) throw std::runtime_error("the grammar does not move on in: " + line);
      if (next != at) turns = 0;
      at = next;
      if (at == length && hit.rule != nullptr && !hit.rule->end) return;
      if (at == length && hit.groups[0].first == hit.groups[0].second && hit.rule == nullptr) continue;
      if (at == length) return;
    }
  }

  Hit find(const std::string& line, int at, bool first) const {
    Hit best;
    const auto consider = [&](const Rule* rule, regex_t* regex) {
      std::unique_ptr<OnigRegion, RegionDeleter> region(onig_region_new());
      const auto* begin = reinterpret_cast<const OnigUChar*>(line.data());
      const auto* end = begin + line.size();
      // \A is the beginning of the text, not of each line.
      const OnigOptionType option = first ? ONIG_OPTION_NONE : ONIG_OPTION_NOT_BEGIN_STRING;
      const int found = onig_search(regex, begin, end, begin + at, end, region.get(), option);
      if (found < 0) return;
      if (!best.groups.empty() && found >= best.groups[0].first) return;
      best.rule = rule;
      best.groups.clear();
      for (int i = 0; i < region->num_regs; ++i) best.groups.emplace_back(region->beg[i], region->end[i]);
    };
    const std::vector<const Rule*>& patterns = stack_.empty() ? grammar_.top_ : stack_.back()->patterns;
    if (!stack_.empty()) consider(nullptr, stack_.back()->end.get());
    for (const Rule* rule : patterns) consider(rule, rule->begin.get());
    return best;
  }

  void take(std::size_t start, const Hit& hit, int length) {
    const Rule* const rule = hit.rule != nullptr ? hit.rule : stack_.back();
    if (hit.rule != nullptr) stack_.push_back(rule);
    const Captures& captures = hit.rule != nullptr ? rule->begin_captures : rule->end_captures;
    paint(start, hit.groups[0].first, std::min(hit.groups[0].second, length), {});
    for (const auto& [number, name] : captures) {
      if (static_cast<std::size_t>(number) >= hit.groups.size()) continue;
      const auto [begin, end] = hit.groups[static_cast<std::size_t>(number)];
      if (begin >= 0) paint(start, begin, std::min(end, length), name);
    }
    if (hit.rule == nullptr || !rule->end) stack_.pop_back();
  }

  /// Bytes get the scopes of the open rules, or `extra` besides those that they have.
  void paint(std::size_t start, int begin, int end, const std::string& extra) {
    for (int i = begin; i < end; ++i) {
      std::string& scopes = scopes_[start + static_cast<std::size_t>(i)];
      if (!extra.empty()) {
        scopes += extra + ' ';
        continue;
      }
      scopes.clear();
      for (const Rule* rule : stack_)
        if (!rule->name.empty()) scopes += rule->name + ' ';
    }
  }

  const Rules& grammar_;
  const std::string& text_;
  std::vector<std::string> scopes_;
  std::vector<const Rule*> stack_;
};

Grammar::Rules::Rules(const json& definition) {
  top_ = compile_all(definition.at("patterns"), definition.at("repository"));
}

Grammar::Rules::Regex Grammar::Rules::compile(const std::string& expression) {
  regex_t* regex = nullptr;
  OnigErrorInfo info;
  const auto* begin = reinterpret_cast<const OnigUChar*>(expression.data());
  const int status = onig_new(&regex, begin, begin + expression.size(), ONIG_OPTION_CAPTURE_GROUP, ONIG_ENCODING_UTF8,
                              ONIG_SYNTAX_DEFAULT, &info);
  if (status == ONIG_NORMAL) return Regex(regex);
  std::vector<OnigUChar> text(ONIG_MAX_ERROR_MESSAGE_LEN);
  onig_error_code_to_str(text.data(), status, &info);
  throw std::runtime_error(std::string(reinterpret_cast<const char*>(text.data())) + " in " + expression);
}

Grammar::Rules::Captures Grammar::Rules::captures_of(const json& rule, const char* key) {
  Captures captures;
  if (!rule.contains(key)) return captures;
  for (const auto& [number, capture] : rule.at(key).items()) captures[std::stoi(number)] = capture.at("name");
  return captures;
}

std::vector<const Grammar::Rules::Rule*> Grammar::Rules::compile_all(const json& patterns, const json& repository) {
  std::vector<const Rule*> result;
  for (const json& pattern : patterns) {
    if (pattern.contains("include")) {
      const std::string name = pattern.at("include").get<std::string>().substr(1);
      if (!repository.contains(name)) throw std::runtime_error("the grammar has no rules " + name);
      auto known = repository_.find(name);
      if (known == repository_.end()) {
        const json& entry = repository.at(name);
        const json list =
            entry.contains("match") || entry.contains("begin") ? json::array({entry}) : entry.at("patterns");
        known = repository_.emplace(name, compile_all(list, repository)).first;
      }
      result.insert(result.end(), known->second.begin(), known->second.end());
      continue;
    }
    Rule& rule = *rules_.emplace_back(std::make_unique<Rule>());
    rule.name = pattern.value("name", "");
    const bool region = pattern.contains("begin");
    rule.begin = compile(pattern.at(region ? "begin" : "match"));
    rule.begin_captures = captures_of(pattern, region ? "beginCaptures" : "captures");
    if (region) {
      rule.end = compile(pattern.at("end"));
      rule.end_captures = captures_of(pattern, "endCaptures");
      rule.patterns = compile_all(pattern.value("patterns", json::array()), repository);
    }
    result.push_back(&rule);
  }
  return result;
}

std::vector<std::string> Grammar::Rules::scopes(const std::string& text) const { return Run(*this, text).run(); }

Grammar::Grammar(const json& definition) : rules_(std::make_unique<Rules>(definition)) {}
Grammar::~Grammar() = default;
std::vector<std::string> Grammar::scopes(const std::string& text) const { return rules_->scopes(text); }

}  // namespace breve::test
