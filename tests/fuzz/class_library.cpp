// The library's declarations, taken from an analysis of a program that uses none of them.
#include "class_library.hpp"

#include "breve/analysis.h"
#include "support.hpp"

namespace breve::fuzz {

namespace {

/// Without the folder and the ending that a module's name may have: what `@use` takes.
std::string module_name(std::string_view name) {
  constexpr std::string_view kFolder = "library:", kEnding = ".tz";
  if (name.substr(0, kFolder.size()) == kFolder) name.remove_prefix(kFolder.size());
  if (name.size() > kEnding.size() && name.substr(name.size() - kEnding.size()) == kEnding)
    name.remove_suffix(kEnding.size());
  return std::string(name);
}

/// The name in a keyword's signature: "place" in "to place (vector)".
std::string parameter_of(std::string_view signature, std::string_view keyword) {
  if (signature.size() <= keyword.size() + 1) return "";
  signature.remove_prefix(keyword.size() + 1);
  return std::string(signature.substr(0, signature.find(' ')));
}

}  // namespace

const ClassLibrary& ClassLibrary::get() {
  static const ClassLibrary library;
  return library;
}

ClassLibrary::ClassLibrary() {
  constexpr std::string_view kText = "@use Control.\nController Control.\n";
  const Runtime runtime = make_runtime(breve_runtime_config_default());
  breve_analysis* analysis = nullptr;
  require(breve_analysis_create(runtime.get(), "empty.tz", kText.data(), kText.size(), &analysis) == BREVE_OK,
          "the class library cannot be analysed");
  std::map<std::size_t, std::string> module_of;                          // by symbol
  std::map<std::size_t, std::size_t> class_of;                           // by symbol
  std::map<std::size_t, std::pair<std::size_t, std::size_t>> method_of;  // by symbol: class, selector
  for (std::size_t i = 0; i < breve_analysis_symbol_count(analysis); ++i) {
    breve_symbol symbol;
    if (breve_analysis_symbol(analysis, i, &symbol) != BREVE_OK || !symbol.library) continue;
    const auto cls = class_of.find(symbol.parent);
    switch (symbol.kind) {
      case BREVE_NAME_MODULE:
        modules_.push_back(module_name(symbol.name));
        module_of[i] = modules_.back();
        break;
      case BREVE_NAME_CLASS:
        class_of[i] = numbers_[symbol.name] = classes_.size();
        classes_.push_back({symbol.name, symbol.parent_class, module_of[symbol.parent], {}, {}});
        break;
      case BREVE_NAME_METHOD:
        if (cls == class_of.end()) break;
        method_of[i] = {cls->second, classes_[cls->second].selectors.size()};
        classes_[cls->second].selectors.push_back({symbol.name, symbol.type, {}});
        break;
      case BREVE_NAME_KEYWORD:
        if (const auto method = method_of.find(symbol.parent); method != method_of.end())
          classes_[method->second.first].selectors[method->second.second].keywords.push_back(
              {symbol.name, symbol.type, parameter_of(symbol.signature, symbol.name), *symbol.value != 0});
        break;
      case BREVE_NAME_VARIABLE:
        if (cls != class_of.end()) classes_[cls->second].variables.push_back({symbol.name, symbol.type});
        break;
      case BREVE_NAME_FUNCTION: add_function(symbol.name, symbol.type, symbol.signature); break;
      default: break;
    }
  }
  breve_analysis_destroy(analysis);
  require(!classes_.empty() && !functions_.empty(), "the class library is empty");
}

/// The parameters stand in the signature alone: "angle(a (vector), b (vector))".
void ClassLibrary::add_function(std::string_view name, std::string_view type, std::string_view signature) {
  LibrarySelector function{std::string(name), std::string(type), {}};
  signature.remove_prefix(std::min(signature.size(), signature.find('(') + 1));
  for (std::size_t open; (open = signature.find('(')) != std::string_view::npos;) {
    const std::size_t close = signature.find(')', open);
    if (close == std::string_view::npos) break;
    std::string_view parameter = signature.substr(0, open);
    while (!parameter.empty() && parameter.back() == ' ') parameter.remove_suffix(1);
    while (!parameter.empty() && (parameter.front() == ' ' || parameter.front() == ',')) parameter.remove_prefix(1);
    function.keywords.push_back(
        {"", std::string(signature.substr(open + 1, close - open - 1)), std::string(parameter), false});
    signature.remove_prefix(close + 1);
  }
  functions_.push_back(std::move(function));
}

const LibraryClass* ClassLibrary::find(std::string_view name) const {
  const auto found = numbers_.find(name);
  return found == numbers_.end() ? nullptr : &classes_[found->second];
}

bool ClassLibrary::derives(std::string_view name, std::string_view from) const {
  for (const LibraryClass* cls = find(name); cls; cls = find(cls->parent))
    if (cls->name == from) return true;
  return false;
}

}  // namespace breve::fuzz
