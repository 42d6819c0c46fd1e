// Each case stands three times for each of the odd values: with it as every argument, and with others for the other
// arguments; the first also in a loop that only the budget ends. The last value of each row is one that most methods
// take, so that what checks its arguments is also seen at work.
#include "extreme_cases.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "../fuzz/class_library.hpp"

namespace breve::limits {

namespace {

using fuzz::ClassLibrary;
using fuzz::LibraryClass;
using fuzz::LibraryKeyword;
using fuzz::LibrarySelector;

constexpr std::size_t kVariants = 8;
using Texts = std::array<const char*, kVariants>;

constexpr Texts kIntegers = {"2147483647", "(-2147483647 - 1)", "0", "30000", "1000", "-1", "1000000", "1"};
constexpr Texts kReals = {"1.0e308", "-1.0e308", "exp(1000.0)", "sqrt(-1.0)", "1.0e-308", "0.0", "1000000.0", "0.5"};
constexpr Texts kVectors = {"(1.0e308, 1.0e308, 1.0e308)",
                            "(-1.0e308, 0, 1.0e308)",
                            "(0, 0, 0)",
                            "(sqrt(-1.0), 0, 0)",
                            "(1.0e-308, 0, 0)",
                            "(1000000, 1000000, 1000000)",
                            "(1, 1, 1)",
                            "(0.5, 0.25, 0)"};
constexpr Texts kMatrices = {"[ (1.0e308, 0, 0), (0, 1.0e308, 0), (0, 0, 1.0e308) ]",
                             "[ (0, 0, 0), (0, 0, 0), (0, 0, 0) ]",
                             "[ (1, 0, 0), (0, 1, 0), (0, 0, 1) ]",
                             "[ (sqrt(-1.0), 0, 0), (0, 1, 0), (0, 0, 1) ]",
                             "[ (1.0e-308, 0, 0), (0, 1.0e-308, 0), (0, 0, 1) ]",
                             "[ (1000, 2, 3), (4, 5, 6), (7, 8, 9) ]",
                             "[ (-1, 0, 0), (0, 1, 0), (0, 0, 1) ]",
                             "[ (0, 1, 0), (-1, 0, 0), (0, 0, 1) ]"};
constexpr Texts kStrings = {"long", "\"\"", "xml", "\"big.png\"", "\"out.png\"", "\"Object\"", "\"noise\"", "word"};
constexpr Texts kLists = {"many", "deep", "ring", "tree", "things", "places", "{}", "fitting"};
constexpr Texts kObjects = {"picture", "one", "field", "0", "self", "body", "shape", "peer"};
constexpr Texts kHashes = {"table", "table", "table", "table", "table", "table", "table", "table"};
constexpr Texts kBytes = {"bytes", "bytes", "bytes", "bytes", "bytes", "bytes", "bytes", "bytes"};
constexpr Texts kAny = {"many", "long", "1.0e308", "tree", "one", "deep", "(1.0e308, 0, 0)", "1"};

const Texts& values_of(std::string_view type) {
  const auto is = [&](std::string_view name) { return type.substr(0, type.find(' ')) == name; };
  if (is("int")) return kIntegers;
  if (is("float") || is("double")) return kReals;
  if (is("vector")) return kVectors;
  if (is("matrix")) return kMatrices;
  if (is("string")) return kStrings;
  if (is("list")) return kLists;
  if (is("hash")) return kHashes;
  if (is("data")) return kBytes;
  if (type.find("object") != std::string_view::npos || ClassLibrary::get().find(type)) return kObjects;
  return kAny;
}

/// How an object is made so large that a call that goes through it just fits the budget, and values that fit it.
struct Large {
  std::string_view cls;
  std::string_view made;               // statements; '%' stands for the variable that takes it
  std::string_view fitting = "";       // statements that fill the list `fitting`, an argument that it takes
  std::string_view word = "\"move\"";  // the same for a string
};
constexpr Large kLarge[] = {
    {"Image", "% = (new Image init-with width 3800 height 3800)."},
    {"Matrix2D", "% = (new Matrix2D init-with x-size 2500 y-size 2500)."},
    {"Matrix3D", "% = (new Matrix3D init-with x-size 180 y-size 180 z-size 180)."},
    {"Vector", "% = (new Vector init-with size 6000000)."},
    {"PatchGrid", "% = (new PatchGrid init-with x-count 100 y-count 100 z-count 8)."},
    {"PolygonDisk", "% = (new PolygonDisk init-with sides 2000 height 1.0 radius 1.0)."},
    {"PolygonCone", "% = (new PolygonCone init-with sides 2000 height 1.0 radius 1.0)."},
    {"Terrain", "% = new Terrain. for i = 0, i < 5, i++: % generate."},
    {"NeuralNetwork",
     "% = new NeuralNetwork. % add-layer with-neuron-count 500. % add-elman-layer with-neuron-count 500.",
     "row = {}. for i = 0, i < 500, i++: push 0.5 onto row. for i = 0, i < 20, i++: push row onto fitting.",
     "\"adam\""},
    {"FFNetwork", "% = new FFNetwork. % add-layer with-neuron-count 500. % add-layer with-neuron-count 500.",
     "row = {}. for i = 0, i < 500, i++: push 0.5 onto row. for i = 0, i < 20, i++: push row onto fitting.",
     "\"adam\""},
    {"CMAEvolutionStrategy",
     "row = {}. for i = 0, i < 150, i++: push 0.5 onto row. % = new CMAEvolutionStrategy. "
     "% begin at row with-step 1.0 with-population 40. % ask.",
     "for i = 0, i < 40, i++: push 1.0 * i onto fitting."},
    {"MultiObjectiveSearch",
     "row = {}. other = {}. for i = 0, i < 50, i++: { push 0 onto row. push 1 onto other. } "
     "% = new MultiObjectiveSearch. % begin from row to other with-objectives 2 with-population 200. % ask.",
     "for i = 0, i < 200, i++: push { i, 200 - i } onto fitting."},
    {"GADirectedGraph",
     "% = new GADirectedGraph. % randomize with-max-nodes 60 with-node-parameters 20 with-connection-parameters 20."},
    {"PushProgram",
     "interpreter = new PushInterpreter. interpreter set-list-limit to 100000. % = new PushProgram. "
     "% make-random-code with-interpreter interpreter max-length 50000.",
     "for i = 0, i < 1000, i++: push i onto fitting.", "\"( 1 ( 2 INTEGER.+ ) )\""},
    {"PushInterpreter",
     "program = new PushProgram. program parse program \"( 1 1000000 EXEC.DO*RANGE ( INTEGER.DUP CODE.DUP ) )\". "
     "% = new PushInterpreter. % set-list-limit to 100000. % set-evaluation-limit to 1000000. "
     "for i = 0, i < 20000, i++: { % push-integer value i. % push-float value i. % push-code value program. "
     "% push-vector value (1, 2, 3). % push-boolean value 1. % push-exec value program. }",
     "", "\"instruction INTEGER.+\""},
    {"Drawing", "% = new Drawing. for i = 0, i < 60000, i++: % draw-line from (0, 0, 0) to (1, i, 1)."},
    {"MultiBody",
     "% = new MultiBody. link = new Link. % register with-link link. for i = 0, i < 60, i++: { before = link. "
     "link = new Link. joint = new RevoluteJoint. joint link parent before to-child link with-normal (0, 0, 1) "
     "with-parent-point (0.5, 0, 0) with-child-point (-0.5, 0, 0). }"},
    {"Sound", "% = new Sound. % load from-file \"sound.wav\".", "", "\"sound.wav\""},
    {"Graph",
     "% = new Graph. % add-line with-color (1, 0, 0). for i = 0, i < 50000, i++: % add-point on-line 0 with-value i."},
    {"MeshShape", "% = new MeshShape. % load-from-obj file \"mesh.obj\".", "", "\"mesh.obj\""},
    {"Reaction", "% = new Reaction. % init-with fields { field }.", "push field onto fitting."},
    {"RevoluteJoint",
     "link = new Link. before = new Link. % = new RevoluteJoint. % link parent before to-child link with-normal (0, 0, "
     "1)."},
    {"PrismaticJoint",
     "link = new Link. before = new Link. % = new PrismaticJoint. % link parent before to-child link with-normal (0, "
     "0, 1)."},
    {"BallJoint", "link = new Link. before = new Link. % = new BallJoint. % link parent before to-child link."},
    {"UniversalJoint",
     "link = new Link. before = new Link. % = new UniversalJoint. % link parent before to-child link with-normal (0, "
     "0, 1)."},
    {"FixedJoint", "link = new Link. before = new Link. % = new FixedJoint. % link parent before to-child link."},
    {"Spring",
     "link = new Mobile. before = new Mobile. % = new Spring. % connect from link to before with-length 1.0 "
     "with-strength 1.0 with-damping 1.0."},
};

Large large(std::string_view cls) {
  for (const Large& known : kLarge)
    if (known.cls == cls) return known;
  return {cls, ""};
}

std::string filled(std::string_view statements, std::string_view variable) {
  std::string text;
  for (const char c : statements) {
    if (c == '%')
      text += variable;
    else
      text += c;
  }
  return text;
}

/// Ends the simulation, or the process that is tested.
bool is_left_out(std::string_view name) {
  constexpr std::array kNames = {"end-simulation", "endSimulation", "die", "init"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

class Writer {
 public:
  explicit Writer(std::string about) { program_.about = std::move(about); }

  void add(const std::string& name, const std::string& statement) {
    for (const ExtremeCase& known : program_.cases)
      if (known.statement == statement) return;
    program_.cases.push_back({name, statement});
  }
  /// `call` makes the statement of texts for the arguments.
  template <class Call>
  void add_variants(const std::string& name, const std::vector<LibraryKeyword>& keywords, Call&& call) {
    for (std::size_t variant = 0; variant < kVariants; ++variant)
      for (const std::size_t apart : {std::size_t{0}, std::size_t{1}, std::size_t{3}}) {
        std::vector<std::string> arguments;
        for (std::size_t i = 0; i < keywords.size(); ++i)
          arguments.emplace_back(values_of(keywords[i].type)[(variant + apart * i) % kVariants]);
        add(name, call(arguments));
        if (apart == 0) add(name, "for number = 0, number < 2000000, number++: " + call(arguments));
      }
  }
  ExtremeProgram program(const std::string& base, const Large& large) {
    std::string text;
    for (const std::string& module : ClassLibrary::get().modules()) text += "@use " + module + ".\n";
    text += "Controller Main.\n" + base + R"( : Main {
  + variables:
    long, xml (string).
    many, deep, ring, tree, things, places, fitting, row, other (list).
    table (hash).
    bytes (data).
    one, peer, picture, field, body, shape, got (object).
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
    if !shape: shape = (new Sphere init-with radius 1.0).
    if !body: body = new Mobile.
    word = )" +
            std::string(large.word) + ".\n    if !fitting: { fitting = {}. " + std::string(large.fitting) + "}\n";
    for (const std::string_view variable : {"one", "peer"})
      text += "    if !" + std::string(variable) + ": { " + filled(large.made, variable) + " }\n";
    for (std::size_t i = 0; i < program_.cases.size(); ++i)
      text += "  + to case-" + std::to_string(i) + ":\n    " + program_.cases[i].statement + "\n";
    program_.text = text + "}\n";
    return std::move(program_);
  }

 private:
  ExtremeProgram program_;
};

std::string sent(const std::string& receiver, const LibrarySelector& selector,
                 const std::vector<std::string>& arguments) {
  std::string text = receiver + " " + selector.name;
  for (std::size_t i = 0; i < arguments.size(); ++i) text += " " + selector.keywords[i].name + " " + arguments[i];
  return text + ".";
}

ExtremeProgram of_class(const LibraryClass& cls) {
  const ClassLibrary& library = ClassLibrary::get();
  const bool controls = library.derives(cls.name, "Control");
  Writer writer(cls.name);
  for (const LibrarySelector& selector : cls.selectors)
    if (!is_left_out(selector.name))
      writer.add_variants(cls.name + " " + selector.name, selector.keywords,
                          [&](const std::vector<std::string>& arguments) {
                            return sent(controls ? "self" : "one", selector, arguments);
                          });
  Large made = large(cls.name);
  const std::string plain = controls ? "% = self." : "% = new " + cls.name + ".";
  if (made.made.empty()) made.made = plain;
  return writer.program(controls ? cls.name : "PhysicalControl", made);
}

ExtremeProgram of_functions() {
  Writer writer("functions");
  for (const LibrarySelector& function : ClassLibrary::get().functions())
    if (!is_left_out(function.name))
      writer.add_variants(function.name + "()", function.keywords, [&](const std::vector<std::string>& arguments) {
        std::string text = function.name + "(";
        for (std::size_t i = 0; i < arguments.size(); ++i) text += (i == 0 ? "" : ", ") + arguments[i];
        return text + ").";
      });
  return writer.program("PhysicalControl", {"", "% = (new Image init-with width 2000 height 2000)."});
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
  ExtremeProgram program = writer.program("PhysicalControl", {"", "% = new Object."});
  program.text.resize(program.text.rfind('}'));
  program.text +=
      "  + to compare first a (int) second b (int): return b - a.\n"
      "  + to ready-again: self ready-again.\n}\n";
  return program;
}

}  // namespace

std::vector<ExtremeProgram> extreme_programs() {
  std::vector<ExtremeProgram> programs = {of_language(), of_functions()};
  for (const LibraryClass& cls : ClassLibrary::get().classes())
    if (ExtremeProgram program = of_class(cls); !program.cases.empty()) programs.push_back(std::move(program));
  return programs;
}

}  // namespace breve::limits
