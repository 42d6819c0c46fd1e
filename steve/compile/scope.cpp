// Numbers for constants and names, and the functions that scripts may call.
#include "steve/compile/scope.hpp"

namespace breve::steve {

std::shared_ptr<const CompileScope::FunctionTable> CompileScope::function_table(const LibrarySource& library,
                                                                                const ForeignFunctions& foreign) {
  auto table = std::make_shared<FunctionTable>();
  std::uint32_t number = 0;
  for (const auto& native : library.functions) table->emplace(native.name, FunctionEntry{number++, native.signature});
  number = 0;
  for (const auto& function : foreign) {
    if (!function->is_method()) table->emplace(function->name(), FunctionEntry{number, function->signature(), true});
    ++number;
  }
  return table;
}

std::uint32_t CompileScope::string_number(std::string_view text) {
  if (const auto at = strings_.find(text); at != strings_.end()) return at->second;
  const auto number = static_cast<std::uint32_t>(code().strings.size());
  code().strings.emplace_back(text);
  strings_.emplace(std::string(text), number);
  return number;
}

std::uint32_t CompileScope::text_number(std::string_view text) {
  if (const auto at = texts_.find(text); at != texts_.end()) return at->second;
  if (code().texts.empty()) code().texts.emplace_back("value");  // number 0 also stands for those beyond 16 bits
  if (code().texts.size() > 0xffff) return 0;
  const auto number = static_cast<std::uint32_t>(code().texts.size());
  code().texts.emplace_back(text);
  texts_.emplace(std::string(text), number);
  return number;
}

std::optional<CompileScope::FunctionEntry> CompileScope::find_function(std::string_view name,
                                                                       std::size_t arguments) const {
  const auto [first, last] = functions_->equal_range(name);
  for (auto at = first; at != last; ++at)
    if (at->second.signature.find(':') == arguments) return at->second;
  return std::nullopt;
}

std::vector<std::string_view> CompileScope::function_names() const {
  std::vector<std::string_view> names;
  for (const auto& [name, entry] : *functions_) names.push_back(name);
  return names;
}

void CompileScope::lint(const Span& span, std::string code, std::string message, std::string help) {
  if (!embedded(span)) diagnostics_.warning(span, std::move(code), std::move(message), std::move(help));
}

void CompileScope::lint_text_sum(const Span& span) {
  lint(span, "lint-string-sum", "a string and a number are added: the sum is a number, not a text",
       "to put a value into a text write its name with a '$' in the string: \"count: $n\"");
}

void CompileScope::lint_list_sum(const Span& span) {
  lint(span, "lint-list-sum", "two lists are added: the sum is that of their lengths, not a list",
       "to append the elements of one to the other: foreach item in second: push item onto first.");
}

}  // namespace breve::steve
