// Lexer, parser and compiler on any bytes: they end, every error is a diagnostic with a place, and the same text gets
// the same answer twice.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "support.hpp"
#include "targets.hpp"

namespace breve::fuzz {

namespace {

constexpr char kBetweenModules = 0x1e;

/// The modules that a program may ask for, by name.
struct Modules {
  static constexpr std::array<std::string_view, 3> kNames = {"A.tz", "B.tz", "C.tz"};
  std::vector<std::string> texts;  // [0] is the program
};

bool resolve(void* user, const char* name, const char*, breve_module* module) {
  const auto& modules = *static_cast<const Modules*>(user);
  const auto at = std::find(Modules::kNames.begin(), Modules::kNames.end(), std::string_view(name));
  const auto number = static_cast<std::size_t>(at - Modules::kNames.begin()) + 1;
  if (number >= modules.texts.size()) return false;
  module->text = modules.texts[number].data();
  module->size = modules.texts[number].size();
  return true;
}

void check_diagnostic(const breve_diagnostic& d) {
  require(d.code && *d.code && d.message && *d.message && d.help && d.file && d.text, "a diagnostic lacks something");
  const std::string_view text = d.text;
  require(!text.empty() && text.back() == '\n', "the text of a diagnostic does not end with a newline", text);
  require((d.line == 0) == (d.column == 0), "a diagnostic has a line or a column alone", text);
  require(
      d.severity == BREVE_SEVERITY_ERROR || d.severity == BREVE_SEVERITY_WARNING || d.severity == BREVE_SEVERITY_NOTE,
      "a diagnostic of unknown severity", text);
}

/// Everything that the compiler says, as one text.
std::string compile(Modules& modules) {
  breve_runtime_config config = breve_runtime_config_default();
  config.user = &modules;
  config.resolve_module = resolve;
  const Runtime runtime = make_runtime(config);
  breve_program* compiled = nullptr;
  const std::string& text = modules.texts[0];
  const breve_status status = breve_program_compile(runtime.get(), "fuzz.tz", text.data(), text.size(), &compiled);
  const Program program(compiled);
  require(status == BREVE_OK || status == BREVE_ERROR_COMPILE, breve_status_name(status),
          status == BREVE_OK ? "" : breve_runtime_last_error(runtime.get())->text);

  std::string said = breve_status_name(status);
  bool error = false;
  for (std::size_t i = 0; i < breve_runtime_diagnostic_count(runtime.get()); ++i) {
    breve_diagnostic d{};
    require(breve_runtime_diagnostic(runtime.get(), i, &d) == BREVE_OK, "a diagnostic that is counted is not there");
    check_diagnostic(d);
    error = error || d.severity == BREVE_SEVERITY_ERROR;
    said += d.text;
  }
  require(error == (status != BREVE_OK), "errors and the status of a compilation do not agree", said);
  for (std::size_t i = 0; i < breve_program_class_count(compiled); ++i) {
    breve_class_info info{};
    require(breve_program_class(compiled, i, &info) == BREVE_OK, "a class that is counted is not there");
  }
  return said;
}

}  // namespace

void fuzz_compile(Bytes bytes) {
  Modules modules;
  modules.texts.emplace_back();
  for (const std::uint8_t byte : bytes) {
    const char c = static_cast<char>(byte);
    if (c == kBetweenModules && modules.texts.size() <= Modules::kNames.size())
      modules.texts.emplace_back();
    else
      modules.texts.back() += c;
  }
  const std::string said = compile(modules);
  require(said == compile(modules), "the same text is compiled twice and gets two answers", said);
}

}  // namespace breve::fuzz
