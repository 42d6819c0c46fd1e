// A tokeniser for TextMate grammars, with Oniguruma, the engine of regular expressions that editors use for them. It
// knows what our grammar uses: match, begin and end, captures, includes of the repository.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace breve::test {

class Grammar {
 public:
  /// @throws std::runtime_error if a regular expression is wrong or an include names nothing
  explicit Grammar(const nlohmann::json& definition);
  ~Grammar();
  Grammar(const Grammar&) = delete;
  Grammar& operator=(const Grammar&) = delete;

  /// For each byte of a text its scopes, outermost first, each with a blank behind it.
  std::vector<std::string> scopes(const std::string& text) const;

 private:
  class Rules;
  std::unique_ptr<Rules> rules_;
};

}  // namespace breve::test
