// How messages write methods: the same words at compile time and at run time.
#include "steve/code/wording.hpp"

#include <algorithm>
#include <set>

namespace breve::steve {

namespace {

constexpr std::size_t kLongestValue = 30;  // bytes of an argument's source that are repeated
constexpr std::size_t kMostClasses = 3;

std::string_view type_word(StaticType type) {
  static constexpr std::string_view kWords[] = {"value",  "int",  "float", "vector",  "matrix", "string",
                                                "object", "list", "hash",  "pointer", "data",   "value"};
  return kWords[static_cast<std::size_t>(type)];
}

std::string_view source_of(const Sources& sources, const Span& span) {
  if (span.line == 0 || span.file >= sources.size()) return {};
  return std::string_view(sources.file(span.file).text).substr(span.offset, span.length);
}

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// More '(' than ')' in front: those that enclose the call itself.
std::string_view without_enclosing(std::string_view text) {
  auto open = std::count(text.begin(), text.end(), '(') - std::count(text.begin(), text.end(), ')');
  while (open-- > 0 && text.starts_with('(')) text = trimmed(text.substr(1));
  return text;
}

std::string value_text(const CallSite& site, std::size_t argument, const Sources& sources, const Span& call) {
  const Span& keyword = site.arguments[argument].span;
  if (call.line == 0 || keyword.line == 0) return "...";
  std::uint32_t end = call.offset + call.length;
  for (const auto& other : site.arguments)
    if (other.span.offset > keyword.offset) end = std::min(end, other.span.offset);
  const std::uint32_t begin = keyword.offset + keyword.length;
  if (end <= begin) return "...";
  auto text = trimmed(std::string_view(sources.file(call.file).text).substr(begin, end - begin));
  auto extra = std::count(text.begin(), text.end(), ')') - std::count(text.begin(), text.end(), '(');
  while (extra-- > 0 && text.ends_with(')')) text = trimmed(text.substr(0, text.size() - 1));
  if (text.size() > kLongestValue || text.find('\n') != std::string_view::npos) return "...";
  return std::string(text);
}

// The call as it should read, every keyword that is needed in its place.
std::string whole_call(const CallSite& site, const MethodInfo& method, const SymbolTable& symbols,
                       const Sources& sources, const Span& call) {
  std::string text;
  if (call.line != 0 && site.span.offset > call.offset) {
    const Span before{call.file, call.offset, site.span.offset - call.offset, call.line, call.column};
    text = std::string(without_enclosing(trimmed(source_of(sources, before))));
    if (text.size() > kLongestValue) text = "...";
    text += ' ';
  } else if (call.line != 0) {
    text = site.super_of ? "super " : "self ";
  }
  text += symbols.name(site.selector);
  for (const auto& p : method.parameters) {
    const auto given = std::find_if(site.arguments.begin(), site.arguments.end(),
                                    [&](const auto& a) { return a.keyword == p.keyword; });
    if (given == site.arguments.end() && p.has_default) continue;
    text += ' ' + symbols.name(p.keyword) + ' ';
    text += given == site.arguments.end()
                ? '<' + type_words(p, symbols) + '>'
                : value_text(site, static_cast<std::size_t>(given - site.arguments.begin()), sources, call);
  }
  return text;
}

}  // namespace

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " and " : ", ";
    text += words[i];
  }
  return text;
}

std::string type_words(const ParameterInfo& p, const SymbolTable& symbols) {
  if (p.class_name != kNoSymbol) return symbols.name(p.class_name) + " object";
  return std::string(type_word(p.type));
}

std::string keyword_words(const MethodInfo& method, const SymbolTable& symbols) {
  std::string text;
  for (const auto& p : method.parameters) {
    text += (text.empty() ? "" : ", ") + symbols.name(p.keyword) + " (" + type_words(p, symbols);
    text += p.has_default ? ", may be left out)" : ")";
  }
  return text.empty() ? "no keywords" : text;
}

CallFault call_fault(const CallSite& site, const MethodInfo& method, const SymbolTable& symbols, const Sources& sources,
                     const Span& call) {
  const auto& name = symbols.name(site.selector);
  const std::string who = "'" + name + "' of class " + method.owner->name;
  const auto takes = [&](Symbol keyword) {
    return std::any_of(method.parameters.begin(), method.parameters.end(),
                       [&](const auto& p) { return p.keyword == keyword; });
  };
  std::set<Symbol> given;
  for (const auto& argument : site.arguments) {
    if (!takes(argument.keyword)) {
      std::vector<std::string_view> free;  // a keyword that is there already is not what was meant
      for (const auto& p : method.parameters) {
        const bool there = std::any_of(site.arguments.begin(), site.arguments.end(),
                                       [&](const auto& a) { return a.keyword == p.keyword; });
        if (!there) free.push_back(symbols.name(p.keyword));
      }
      const auto near = nearest(symbols.name(argument.keyword), free);
      return {CallFault::Kind::UnknownKeyword,
              "method " + who + " has no keyword '" + symbols.name(argument.keyword) + "'",
              (near.empty() ? std::string() : "did you mean '" + near + "'? ") + "'" + name + "' takes " +
                  keyword_words(method, symbols),
              argument.span};
    }
    if (!given.insert(argument.keyword).second)
      return {CallFault::Kind::RepeatedKeyword,
              "keyword '" + symbols.name(argument.keyword) + "' is given twice to method " + who,
              "each keyword is written once: remove one of the two", argument.span};
  }
  std::vector<std::string> missing;
  for (const auto& p : method.parameters)
    if (!p.has_default && !given.contains(p.keyword)) missing.push_back("'" + symbols.name(p.keyword) + "'");
  return {CallFault::Kind::MissingKeyword,
          "this call of method " + who + " lacks the keyword" + (missing.size() > 1 ? "s " : " ") + joined(missing),
          "the whole call reads: " + whole_call(site, method, symbols, sources, call),
          {}};
}

std::string unknown_method_help(std::string_view name, const ClassInfo* start, const Program& program) {
  const auto& symbols = program.symbols();
  std::vector<std::string_view> names;
  for (const ClassInfo* c = start; c; c = c->parent)
    for (const auto& method : c->methods) names.push_back(symbols.name(method->name));
  const auto variable = [&](std::string_view text) {
    const Symbol symbol = symbols.find(text);
    return start && symbol != kNoSymbol && start->find_variable(symbol);
  };
  const auto is_variable = [&](std::string_view text) {
    return "'" + std::string(text) + "' is a variable of " + start->name +
           ", not a method: from outside write object::" + std::string(text) + ", in its own methods " +
           std::string(text);
  };
  if (variable(name)) return is_variable(name);
  for (const std::string_view prefix : {"get-", "set-"})
    if (name.starts_with(prefix) && variable(name.substr(prefix.size())))
      return is_variable(name.substr(prefix.size()));
  if (const auto near = nearest(name, names); !near.empty()) return "did you mean '" + near + "'?";
  std::vector<std::string> classes;
  std::size_t more = 0;
  const Symbol symbol = symbols.find(name);
  for (const auto& cls : program.classes()) {
    const bool has =
        std::any_of(cls->methods.begin(), cls->methods.end(), [&](const auto& m) { return m->name == symbol; });
    if (!has) continue;
    if (classes.size() < kMostClasses) {
      classes.push_back(cls->name);
    } else {
      ++more;
    }
  }
  if (classes.empty()) return "no class of this program has a method of that name";
  if (more > 0) classes.push_back(std::to_string(more) + " more");
  return (classes.size() == 1 ? "class " : "classes ") + joined(classes) + (classes.size() == 1 ? " has" : " have") +
         " such a method: is this the object that you mean?";
}

}  // namespace breve::steve
