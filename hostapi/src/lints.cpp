// The list of lints, and what a host does not want to hear of.
#include "internal.hpp"
#include "steve/compile/lint_table.hpp"

using namespace breve::host;

size_t breve_lint_count(void) { return breve::steve::lints().size(); }

breve_status breve_lint(size_t index, breve_lint_info* lint) {
  return guard([&] {
    need(lint, "lint");
    const auto all = breve::steve::lints();
    if (index >= all.size()) fail(BREVE_ERROR_NOT_FOUND, "there is no such lint");
    const bool note = all[index].severity == breve::steve::Severity::Note;
    // Views of literals: a zero byte stands behind them.
    *lint = {all[index].code.data(), note ? BREVE_SEVERITY_NOTE : BREVE_SEVERITY_WARNING, all[index].summary.data()};
  });
}

breve_status breve_runtime_allow_lint(breve_runtime* runtime, const char* code) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  return guard(runtime->error, [&] {
    need(code, "code");
    if (!breve::steve::find_lint(code)) {
      std::vector<std::string_view> codes;
      for (const auto& lint : breve::steve::lints()) codes.push_back(lint.code);
      const auto near = breve::steve::nearest(code, codes);
      fail(BREVE_ERROR_NOT_FOUND, "there is no lint '" + std::string(code) + "'" +
                                      (near.empty() ? std::string() : "; did you mean '" + near + "'?"));
    }
    runtime->allowed.insert(code);
  });
}
