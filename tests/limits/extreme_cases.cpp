// Each case stands three times for each of the odd values: with it as every argument, and with others for the other
// arguments; the first also in a loop that only the budget ends. The last value of each row is one that most methods
// take, so that what checks its arguments is also seen at work.
#include "extreme_cases.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "../fuzz/class_library.hpp"
#include "extreme_values.hpp"
#include "large_objects.hpp"

namespace breve::limits {

namespace {

using fuzz::ClassLibrary;
using fuzz::LibraryClass;
using fuzz::LibraryKeyword;
using fuzz::LibrarySelector;

/// Ends the simulation, or the process that is tested.
bool is_left_out(std::string_view name) {
  constexpr std::array kNames = {"end-simulation", "endSimulation", "die", "init"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

/// How many arguments a call is tried with.
enum class Tries { all, some, fitting };

std::string filled(std::string_view statements, std::string_view variable) {
  std::string text;
  for (const char c : statements) {
    if (c == '@')
      text += variable;
    else
      text += c;
  }
  return text;
}

class Writer {
 public:
  explicit Writer(std::string about) { program_.about = std::move(about); }

  void add(const std::string& name, const std::string& statement, bool fits = false) {
    if (written_.insert(statement).second) program_.cases.push_back({name, statement, fits});
  }
  /// `call` makes the statement of texts for the arguments.
  template <class Call>
  void add_variants(const std::string& name, const LibrarySelector& selector, Tries tries, Call&& call) {
    const std::vector<LibraryKeyword>& keywords = selector.keywords;
    std::vector<std::string> fitting;
    for (const LibraryKeyword& keyword : keywords)
      fitting.push_back(fitting_value(selector.name, keyword.name, keyword.parameter, keyword.type));
    add_in_loop(name, call(fitting), true);
    if (tries == Tries::fitting) return;
    for (std::size_t odd = tries == Tries::all ? 0 : kOddities - 2; odd < kOddities; ++odd)
      for (const std::size_t apart : {std::size_t{0}, std::size_t{1}, std::size_t{3}}) {
        std::vector<std::string> arguments;
        for (std::size_t i = 0; i < keywords.size(); ++i)
          arguments.push_back(odd_value(keywords[i].type, odd + apart * i));
        if (apart == 0)
          add_in_loop(name, call(arguments));
        else if (tries == Tries::all)
          add(name, call(arguments));
      }
  }
  ExtremeProgram program(const std::string& base, const Large& large) {
    std::string text;
    for (const std::string& module : ClassLibrary::get().modules()) text += "@use " + module + ".\n";
    text += "Controller Main.\n";
    text += derived_classes();
    text += base + kScene;
    text += "  + to make-arguments:\n    i (int).\n    word = " + std::string(large.word) +
            ".\n    if !fitting: { fitting = {}. " + std::string(large.fitting) + "}\n";
    for (const std::string_view variable : {"one", "peer"})
      text += "  + to make-" + std::string(variable) + ":\n    i (int).\n    if !" + std::string(variable) + ": { " +
              filled(large.made, variable) + " }\n";
    for (std::size_t i = 0; i < program_.cases.size(); ++i)
      text += "  + to case-" + std::to_string(i) + ":\n    " + program_.cases[i].statement + "\n";
    program_.text = text + "}\n";
    return std::move(program_);
  }

 private:
  /// The variables and methods of each program. `ready` may be called before each case: it makes again objects that
  /// were freed.
  static constexpr const char* kScene = R"tz( : Main {
  + variables:
    long, xml (string).
    many, deep, ring, tree, things, places, fitting, row, other (list).
    table (hash).
    bytes (data).
    one, peer, picture, field, cube, numbers, grid, chemical, body, shape, got (object).
    program, interpreter, link, before, joint (object).
    number (int).
    copy (list).
    text, word (string).
    real (float).
  + to ready:
    i (int).
    if !many: {
      for i = 0, i < 100000, i++: push i onto many.
      long = "0123456789abcdef".
      for i = 0, i < 18, i++: long = long + long.
    }
    if !deep: {
      for i = 0, i < 10000, i++: deep = { deep }.
      ring = { 1, 2 }. push ring onto ring.
      tree = { 1, 2, 3 }.
      for i = 0, i < 40, i++: tree = { tree, tree }.
      for i = 0, i < 10000, i++: table{i} = i.
      for i = 0, i < 50000, i++: push (i, i % 7, 1) onto places.
      xml = "<a><b/></a>".
      for i = 0, i < 16, i++: xml = xml + xml.
    }
    if |things| == 0: for i = 0, i < 3000, i++: push (new Mobile) onto things.
    if !picture: picture = (new Image init-with width 2000 height 2000).
    if !field: field = (new Matrix2D init-with x-size 1000 y-size 1000).
    if !cube: cube = (new Matrix3D init-with x-size 20 y-size 20 z-size 1).
    if !numbers: numbers = (new Vector init-with size 2500).
    if !chemical: chemical = (new PatchChemical init-with diffusion-rate 0.1 decay-rate 0.1).
    if !grid: {
      grid = (new PatchGrid init-with x-count 20 y-count 20 z-count 1).
      grid track patch-chemical chemical.
    }
    if !shape: shape = (new Sphere init-with radius 1.0).
    if !body: body = new Mobile.
    if !link: link = new Link.
    if !before: before = new Link.
    if !interpreter: interpreter = new PushInterpreter.
    if !program: {
      program = new PushProgram.
      program parse program "( 1 ( 2 INTEGER.+ ) )".
    }
  + to settle: number += 1.
  + to drive-link: number += 1.
  + to identity reading x (float): return x.
  + to next-state state s (int) neighbors n (int): return s + n.
  + to make-faces of mesh (object):
    % Of a body of revolution.
    i, j, sides (int).
    a, b (float).
    sides = 40.
    for i = 0, i < sides, i++: for j = 0, j < sides, j++: {
      a = PI * i / sides.
      b = PI * (i + 1) / sides.
      mesh add-face with-vertex-list { (self point-at down a around j of sides), (self point-at down b around j of sides), (self point-at down b around j + 1 of sides), (self point-at down a around j + 1 of sides) }.
    }
  + to point-at down a (float) around j (int) of sides (int):
    return (sin(a) * cos(2 * PI * j / sides), cos(a), sin(a) * sin(2 * PI * j / sides)).
)tz";

  void add_in_loop(const std::string& name, const std::string& statement, bool fits = false) {
    add(name, statement, fits);
    add(name, "for number = 0, number < 2000000, number++: " + statement);
  }

  ExtremeProgram program_;
  std::set<std::string> written_;
};

std::string sent(const std::string& receiver, const LibrarySelector& selector,
                 const std::vector<std::string>& arguments) {
  std::string text = receiver + " " + selector.name;
  for (std::size_t i = 0; i < arguments.size(); ++i) text += " " + selector.keywords[i].name + " " + arguments[i];
  return text + ".";
}

/// Its own selectors, and those that it inherits if it is large.
ExtremeProgram of_class(const LibraryClass& cls, const Large& large, bool first) {
  const ClassLibrary& library = ClassLibrary::get();
  const bool controls = library.derives(cls.name, "Control");
  Writer writer(cls.name);
  std::set<std::string> seen;
  for (const LibraryClass* from = &cls; from; from = large.made.empty() ? nullptr : library.find(from->parent))
    for (const LibrarySelector& selector : from->selectors) {
      if (is_left_out(selector.name) || !seen.insert(sent("", selector, {})).second) continue;
      const Tries tries = from != &cls ? Tries::fitting : first ? Tries::all : Tries::some;
      writer.add_variants(cls.name + " " + selector.name, selector, tries, [&](const std::vector<std::string>& texts) {
        return sent(controls ? "self" : "one", selector, texts);
      });
    }
  Large made = large;
  const std::string plain = controls ? "@ = self." : "@ = new " + cls.name + ".";
  if (made.made.empty()) made.made = plain;
  return writer.program(cls.name != "Control" && controls ? cls.name : "PhysicalControl", made);
}

ExtremeProgram of_functions() {
  Writer writer("functions");
  for (const LibrarySelector& function : ClassLibrary::get().functions())
    if (!is_left_out(function.name))
      writer.add_variants(function.name + "()", function, Tries::all, [&](const std::vector<std::string>& arguments) {
        std::string text = function.name + "(";
        for (std::size_t i = 0; i < arguments.size(); ++i) text += (i == 0 ? "" : ", ") + arguments[i];
        return text + ").";
      });
  return writer.program("PhysicalControl", {"", "@ = (new Image init-with width 2000 height 2000)."});
}

/// What the language does with values itself.
ExtremeProgram of_language() {
  constexpr std::pair<const char*, const char*> kStatements[] = {
      {"copylist", "copy = copylist many."},
      {"copylist", "copy = copylist tree."},
      {"sort", "sort many with compare."},
      {"insert", "for number = 0, number < 2000000, number++: insert 5 at many{50000}."},
      {"remove", "for number = 0, number < 2000000, number++: number = remove many{1}."},
      {"prepend", "for number = 0, number < 2000000, number++: prepend 5 onto many."},
      {"push", "for number = 0, number < 2000000, number++: push tree onto many."},
      {"==", "number = (many == (copylist many))."},
      {"==", "number = (tree == (copylist tree))."},
      {"==", "number = (deep == (copylist deep))."},
      {"==", "number = (long == (long + \"\"))."},
      {"|x|", "number = |tree| + |long| + |table|."},
      {"all", "for number = 0, number < 2000000, number++: number = |all Mobiles|."},
      {"print", "print many."},
      {"print", "print tree."},
      {"print", "print deep."},
      {"print", "print ring."},
      {"print", "print long."},
      {"print", "print table."},
      {"print", "for number = 0, number < 2000000, number++: print number."},
      {"print", "for number = 0, number < 1000, number++: print long."},
      {"interpolation", "text = \"$many\"."},
      {"interpolation", "text = \"$tree\"."},
      {"interpolation", "text = \"$long$long$long$long$long$long$long$long\"."},
      {"+", "for number = 0, number < 100, number++: long = long + long."},
      {"text{n} =", "for number = 0, number < 2000000, number++: long{3} = \"y\"."},
      {"text{n}", "for number = 0, number < 2000000, number++: text = long{3}."},
      {"hash{key}", "for number = 0, number < 2000000, number++: table{\"$number\"} = number."},
      {"hash{key}", "for number = 0, number < 2000000, number++: table{number} = number."},
      {"hash{key}", "for number = 0, number < 2000000, number++: table{random[1.0]} = number."},
      {"hash{key}", "for number = 0, number < 2000000, number++: table{(number, number, 0)} = places."},
      {"hash{key}", "for number = 0, number < 2000000, number++: real = table{number * 7919 % 10007}."},
      {"hash{key}", "for number = 0, number < 300, number++: table{many} = number."},
      {"hash{key}", "for number = 0, number < 1000, number++: table{long} = number."},
      {"new", "for number = 0, number < 2000000, number++: new Object."},
      {"new", "for number = 0, number < 2000000, number++: new Mobile."},
      {"free", "free all Mobiles."},
      {"all: selector", "things set-color to (1, 0, 0)."},
      {"all: selector", "(all Mobiles) move to (1, 2, 3)."},
      {"error in a long text", "(long + 1) none."},
      {"endless recursion", "self ready-again."},
      {"endless loop", "while 1: number += 1."},
      {"foreach", "foreach number in many: foreach real in many: got = 0."},
      {"random[n]", "real = random[2147483647] + random[-2147483647] + random[1.0e308]."},
  };
  Writer writer("language");
  for (const auto& [name, statement] : kStatements) writer.add(name, statement);
  ExtremeProgram program = writer.program("PhysicalControl", {"", "@ = new Object."});
  program.text.resize(program.text.rfind('}'));
  program.text +=
      "  + to compare first a (int) second b (int): return b - a.\n"
      "  + to ready-again: self ready-again.\n}\n";
  return program;
}

}  // namespace

std::vector<ExtremeProgram> extreme_programs() {
  std::vector<ExtremeProgram> programs = {of_language(), of_functions()};
  for (const LibraryClass& cls : ClassLibrary::get().classes()) {
    std::vector<Large> ways = ways_to_be_large(cls.name);
    if (ways.empty()) ways.push_back({cls.name, ""});
    for (std::size_t way = 0; way < ways.size(); ++way)
      if (ExtremeProgram program = of_class(cls, ways[way], way == 0); !program.cases.empty())
        programs.push_back(std::move(program));
  }
  return programs;
}

}  // namespace breve::limits
