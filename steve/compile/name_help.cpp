// What to do about a name that nothing is called by: a near one, a subtraction without blanks, a word of another
// language, or where to declare it.
#include <algorithm>

#include "steve/compile/function_compiler.hpp"
#include "steve/compile/scope.hpp"
#include "steve/syntax/words.hpp"

namespace breve::steve {

namespace {

struct Habit {
  std::string_view word, help;
};
constexpr Habit kHabits[] = {
    {"this", "the object itself is called 'self'"},
    {"me", "the object itself is called 'self'"},
    {"true", "there is no keyword for it: write 1"},
    {"True", "there is no keyword for it: write 1"},
    {"TRUE", "there is no keyword for it: write 1"},
    {"false", "there is no keyword for it: write 0"},
    {"False", "there is no keyword for it: write 0"},
    {"FALSE", "there is no keyword for it: write 0"},
    {"NULL", "no object is written 0; to test for an object: if object: ..."},
    {"null", "no object is written 0; to test for an object: if object: ..."},
    {"nil", "no object is written 0; to test for an object: if object: ..."},
    {"None", "no object is written 0; to test for an object: if object: ..."},
    {"break", "there is no such statement: end a loop by its condition, or leave the method with 'return'"},
    {"continue", "there is no such statement: put the rest of the loop's body into an 'if'"},
    {"not", "logical not is written !"},
    {"pi", "the constant is written PI"},
    {"Infinity", "no number is infinite here: write a large one, 1e300"},
    {"inf", "no number is infinite here: write a large one, 1e300"},
    {"NaN", "there is no constant for what is not a number"},
    {"nan", "there is no constant for what is not a number"},
    {"pass", "an empty body is written {}"},
    {"quit", "the simulation ends with: self end-simulation."},
    {"exit", "the simulation ends with: self end-simulation."},
    {"stop", "the simulation ends with: self end-simulation."},
    {"del", "an object is removed with: free object.   an element of a list with: remove list{i}."},
    {"delete", "an object is removed with: free object.   an element of a list with: remove list{i}."},
    {"global", "what several methods use is declared under '+ variables:' of the class"},
    {"nonlocal", "what several methods use is declared under '+ variables:' of the class"},
    {"end", "a block ends with }, a statement with a period"},
    {"begin", "a block begins with { and ends with }"},
    {"set", "a value is assigned with =: variable = value"},
    {"tell", "a call begins with the object: object method keyword value"},
    {"ask", "a call begins with the object: object method keyword value"},
    {"console", "write in its place: print value"},
    {"cout", "write in its place: print a, b"},
    {"stdout", "write in its place: print value"},
    {"endl", "'print' ends the line by itself; inside a string write \\n"},
};

// Functions of other languages.
constexpr Habit kFunctionHabits[] = {
    {"rand", "a random number from 0 to n is written random[n]"},
    {"random", "a random number from 0 to n is written random[n]"},
    {"randint", "a random number from 0 to n is written random[n]"},
    {"mod", "the remainder is written a % b"},
    {"fmod", "the remainder is written a % b"},
    {"sqr", "the square of x is written x * x"},
    {"square", "the square of x is written x * x"},
    {"append", "a value is put at the end of a list by: push value onto list"},
    {"push", "a value is put at the end of a list by: push value onto list"},
    {"str", "a value is put into a text with its name and a '$': \"count: $n\""},
    {"tostring", "a value is put into a text with its name and a '$': \"count: $n\""},
    {"String", "a value is put into a text with its name and a '$': \"count: $n\""},
    {"concat", "texts are joined in a string, by names with a '$': \"$first$second\""},
    {"exit", "the simulation ends with: self end-simulation."},
    {"quit", "the simulation ends with: self end-simulation."},
    {"input", "a program cannot ask its user: give a value with  breve run --set name=value"},
    {"prompt", "a program cannot ask its user: give a value with  breve run --set name=value"},
    {"isinstance", "write: (object is-a \"Class\")"},
    {"instanceof", "write: (object is-a \"Class\")"},
    {"sizeof", "the number of elements of a list or a hash is written with bars: |list|"},
    {"delete", "an object is removed with: free object."},
    {"enumerate", "a loop with an index is written: for i = 0, i < |list|, i++: ..."},
    {"pairs", "a loop over a hash is written: foreach key in keys(hash): ..."},
    {"ipairs", "a loop over a list is written: foreach item in list: ..."},
    {"print_r", "write, without parentheses: print value"},
    {"range", "a loop that counts is written: for i = 0, i < n, i++: ..."},
};

constexpr std::size_t kLongestApart = 60;  // bytes of a name that is tried as a subtraction: the ways grow fast

constexpr std::size_t kLongestQuote = 60;  // bytes of the program that a help repeats

std::string source_text(std::string_view source, const Span& span) {
  if (span.line == 0 || span.length > kLongestQuote) return "...";
  return std::string(source.substr(span.offset, span.length));
}

/// The name in front of the dot that stands, without a space, before `span`; "" if there is none.
std::string before_dot(std::string_view source, const Span& span) {
  const auto part = [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (span.line == 0 || span.offset < 2 || source[span.offset - 1] != '.') return {};
  std::size_t begin = span.offset - 1;
  while (begin > 0 && part(source[begin - 1])) --begin;
  if (source[begin] >= '0' && source[begin] <= '9') return {};
  return std::string(source.substr(begin, span.offset - 1 - begin));
}

/// The name directly behind the dot that stands, without a space, behind `span`; "" if there is none.
std::string behind_dot(std::string_view source, const Span& span) {
  std::size_t begin = span.offset + span.length;
  if (span.line == 0 || begin + 1 >= source.size() || source[begin] != '.') return {};
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  std::size_t end = ++begin;
  while (end < source.size() && (letter(source[end]) || (end > begin && source[end] >= '0' && source[end] <= '9')))
    ++end;
  return std::string(source.substr(begin, end - begin));
}

/// Does a language keep its functions of numbers under this name?
bool names_a_module(std::string_view name) {
  return name == "Math" || name == "math" || name == "np" || name == "numpy" || name == "std" || name == "cmath";
}

bool is_number_text(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// `a-b-1` as `a - b - 1`, if all its parts are known; the fewest parts that do. "" if there is no such way.
template <class Known>
std::string spaced(std::string_view name, const Known& known) {
  for (std::size_t dash = name.size(); (dash = name.rfind('-', dash - 1)) != std::string_view::npos && dash > 0;) {
    const std::string_view right = name.substr(dash + 1);
    if (!known(right)) continue;
    const std::string_view left = name.substr(0, dash);
    if (known(left)) return std::string(left) + " - " + std::string(right);
    if (const std::string more = spaced(left, known); !more.empty()) return more + " - " + std::string(right);
  }
  return {};
}

}  // namespace

std::string FunctionCompiler::unknown_name_help(std::string_view name, const Span& span) {
  if (builder_.diagnostics().full()) return {};
  const auto& source = builder_.source(span.file);
  if (const std::string object = before_dot(source, span); !object.empty()) {
    const auto variable = find(object);
    if (variable && variable->type() == StaticType::Hash)
      return "a '.' ends the statement; an entry of a hash is written " + object + "{\"" + std::string(name) + "\"}";
    return "a '.' ends the statement; a variable of another object is written " + object + "::" + std::string(name);
  }
  if (const std::string member = behind_dot(source, span); !member.empty() && names_a_module(name)) {
    if (member == "random" || member == "randint" || member == "rand")
      return "a random number from 0 to n is written random[n]";
    if (member == "pi" || member == "PI") return "the constant is written PI";
    return "functions of numbers stand alone: write " + member + "(...)";
  }
  std::vector<std::string_view> candidates;
  for (const auto& [local, unused] : locals_) candidates.push_back(local);
  std::sort(candidates.begin(), candidates.end());
  for (const ClassInfo* c = &class_; c; c = c->parent)
    for (const auto& v : c->variables) candidates.push_back(builder_.symbol_name(v.name));
  for (const auto& [constant, value] : builder_.defines().seen()) candidates.push_back(constant);
  const auto known = [&](std::string_view part) {
    return is_number_text(part) || find(part).has_value() || builder_.defines().find(part, false) != nullptr;
  };
  if (name.size() < kLongestApart)
    if (const std::string apart = spaced(name, known); !apart.empty())
      return "a dash can be part of a name: for a subtraction write spaces around it, " + apart;
  for (const Habit& habit : kHabits)
    if (habit.word == name) return std::string(habit.help);
  const std::string small = reserved_in_small(name);
  if (!small.empty() && builder_.class_named(name) == nullptr)
    return "the keywords of the language are written in lower case: " + small;
  if (std::find(candidates.begin(), candidates.end(), name) != candidates.end())
    return "a constant is known from its @define on: this file needs the @use or @include of the file that defines it";
  if (const auto near = nearest(name, candidates); !near.empty()) return "did you mean '" + near + "'?";
  const std::string text(name);
  if (class_.responds(builder_.symbol(name))) return "'" + text + "' is a method: write (self " + text + ")";
  if (builder_.function_exists(name)) return "'" + text + "' is a function: write " + text + "(...)";
  if (const auto* cls = builder_.class_named(name))
    return "'" + cls->name + "' is a class: write new " + cls->name + " for an instance";
  return "declare it under '+ variables:' of the class, or at the beginning of the method, as in   " + text +
         " (float).";
}

std::string FunctionCompiler::unknown_function_help(const ast::FunctionCall& f, const Span& span) {
  if (builder_.diagnostics().full()) return {};
  const auto& source = builder_.source(span.file);
  const auto near = nearest(f.name, builder_.function_names());
  const auto symbol = builder_.symbol(f.name);
  const std::string dotted = before_dot(source, span);
  const auto holder = dotted.empty() ? std::nullopt : find(dotted);
  const StaticType held = holder ? holder->type() : StaticType::Object;
  if (names_a_size(f.name) && (held == StaticType::List || held == StaticType::String || held == StaticType::Hash))
    return "the size of a list, a text or a hash is written with bars: |" + dotted + "|";
  if (held == StaticType::List && (names_a_push(f.name) || f.name == "push"))
    return "a value is put at the end of a list by: push value onto " + dotted;
  if (held == StaticType::Hash && (f.name == "get" || f.name == "has" || f.name == "set" || f.name == "put"))
    return "an entry of a hash is written " + dotted + "{key}";
  if (held == StaticType::Hash && (f.name == "values" || f.name == "items" || f.name == "entries"))
    return "write: foreach key in keys(" + dotted + "): ... " + dotted + "{key} ...";
  if ((held == StaticType::List || held == StaticType::Hash) && f.name == "clear")
    return "a list or a hash is emptied by: " + dotted + " = {}";
  if (!dotted.empty())
    return "a method is called with a space, not with a dot: (" + dotted + " " + f.name +
           (f.arguments.empty() ? ")" : " keyword value)");
  if (class_.responds(symbol))
    return "'" + f.name + "' is a method: write (self " + f.name + (f.arguments.empty() ? ")" : " keyword value)");
  const std::string argument = f.arguments.size() == 1 ? source_text(source, f.arguments[0]->span) : "...";
  if (names_a_size(f.name) && f.arguments.size() == 1)
    return "the size of a list, a text or a vector is written with bars: |" + argument + "|";
  if (const std::string small = reserved_in_small(f.name); !small.empty() || names_a_print(f.name))
    return "write, in lower case and without parentheses: " + (small.empty() ? "print" : small) + " " + argument;
  for (const Habit& habit : kFunctionHabits)
    if (habit.word == f.name) return std::string(habit.help);
  if (const auto* cls = builder_.class_named(f.name))
    return "'" + cls->name + "' is a class: write new " + cls->name + " for an instance";
  if (!near.empty()) return "did you mean '" + near + "'?";
  return "a method is called on an object: (object " + f.name + (f.arguments.empty() ? ")" : " keyword value)");
}

// `h.keys()`: the function gets its value in parentheses.
std::string FunctionCompiler::argument_count_help(const ast::FunctionCall& f, const Span& span) {
  const std::string dotted = before_dot(builder_.source(span.file), span);
  if (!dotted.empty() && f.arguments.empty() && builder_.find_function(f.name, 1))
    return "nothing is called with a '.': write " + f.name + "(" + dotted + ")";
  return "the arguments are written in parentheses, with commas between them";
}

// Operators whose operands give no error, and never what was meant.
void FunctionCompiler::lint_operands(ast::BinaryOp op, StaticType a, StaticType b) {
  const auto pair = [&](auto left, auto right) { return (left(a) && right(b)) || (left(b) && right(a)); };
  const auto string = [](StaticType t) { return t == StaticType::String; };
  const auto number = [](StaticType t) { return t == StaticType::Int || t == StaticType::Double; };
  const auto object = [](StaticType t) { return t == StaticType::Object; };
  if (op == ast::BinaryOp::Add && !builder_.checks_sums_later()) {
    if (pair(string, number)) builder_.lint_text_sum(emit_.span());
    if (a == StaticType::List && b == StaticType::List) builder_.lint_list_sum(emit_.span());
  }
  if ((op == ast::BinaryOp::Eq || op == ast::BinaryOp::Ne) && pair(string, object))
    builder_.lint(emit_.span(), "lint-object-string", "an object is never equal to a string",
                  "compare what the object has, for example its name");
}

}  // namespace breve::steve
