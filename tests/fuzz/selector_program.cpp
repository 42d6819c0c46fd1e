// The controller has variables for objects of some library classes, and actions: methods of random statements. Every
// hook that native code calls in the middle of its work, such as `init` of a patch or `archive`, runs an action.
// What the actions are depends on the course that a world takes: to compile the classes takes longer than to run them.
#include "selector_program.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <set>

#include "class_library.hpp"

namespace breve::fuzz {

namespace {

using Texts = std::initializer_list<const char*>;

constexpr std::size_t kActions = 10, kMostCourses = 8;

/// Classes that have something to do with one another.
constexpr std::array<std::array<const char*, 8>, 6> kThemes = {{
    {"Mobile", "Link", "MultiBody", "RevoluteJoint", "BallJoint", "Cube", "Spring", "Floor"},
    {"Link", "FixedJoint", "PrismaticJoint", "UniversalJoint", "Stationary", "Sphere", "Spring", "MultiBody"},
    {"Mobile", "Stationary", "Floor", "PolygonDisk", "CustomShape", "Terrain", "MeshShape", "Wanderer"},
    {"PatchGrid", "PatchToroid", "Patch", "PatchChemical", "GridAgent", "Matrix3D", "Reaction", "Image"},
    {"Image", "Vector", "VectorImage", "Matrix2D", "MatrixImage", "Drawing", "Line", "Camera"},
    {"Mobile", "Data", "Genome", "File", "MenuItem", "Object", "Camera", "Patch"},
}};

/// What waits, reaches outside the world, ends it, or reads the clock on the wall.
bool is_left_out(std::string_view name) {
  constexpr std::array kNames = {"sleep",
                                 "system",
                                 "get-real-time",
                                 "randomSeed",
                                 "getRealTime",
                                 "getRunningTime",
                                 "die",
                                 "end-simulation",
                                 "endSimulation",
                                 "stacktrace",
                                 "dearchive-xml",
                                 "get-real-running-time",
                                 "archive-as-xml",
                                 "load-from-xml",
                                 "save-as-xml",
                                 "save-to",
                                 "load-from",
                                 "set-random-seed-from-dev-random",
                                 "readFileAsString"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end() ||
         name.find("DevRandom") != std::string_view::npos || name.find("openFile") != std::string_view::npos ||
         name.find("open-for") != std::string_view::npos || name.find("write") == 0;
}

bool has(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

std::string lowered(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

class SelectorWriter {
 public:
  explicit SelectorWriter(Choices& choices) : choose_(choices), library_(ClassLibrary::get()) {}

  SelectorProgram program() {
    choose_classes();
    line("Controller Main.");
    for (const std::string& cls : classes_) write_class(cls);
    const std::size_t courses = write_controller();
    return {uses() + out_, courses};
  }

 private:
  struct Object {
    std::string variable, cls;
  };

  /// The modules of all classes that the program names: to read the whole library takes longer than to run it.
  std::string uses() const {
    std::set<std::string> used;
    for (const LibraryClass& cls : library_.classes())
      if (cls.name == base_ || std::find(classes_.begin(), classes_.end(), cls.name) != classes_.end() ||
          has(out_, "\"" + cls.name + "\""))
        used.insert(cls.module);
    std::string text;
    for (const std::string& module : library_.modules())
      if (used.contains(module)) text += "@use " + module + ".\n";
    return text;
  }

  void line(const std::string& text) { out_ += text + "\n"; }
  std::string pick(Texts texts) { return texts.begin()[choose_.below(texts.size())]; }

  // --- which classes ---------------------------------------------------------------------------------------------------

  void choose_classes() {
    constexpr std::array kBases = {"Control", "PhysicalControl", "PhysicalControl", "PlanarControl"};
    base_ = choose_.one_of(kBases);
    const auto add = [this](const std::string& name) {
      if (library_.find(name) && !library_.derives(name, "Control") &&
          std::find(classes_.begin(), classes_.end(), name) == classes_.end())
        classes_.push_back(name);
    };
    add("Object");
    for (const char* name : choose_.one_of(kThemes)) add(name);
    for (int i = 0; i < 2; ++i) add(choose_.one_of(library_.classes()).name);
    for (const std::string& cls : classes_)
      for (int i = 0; i < 2; ++i) objects_.push_back({"v" + std::to_string(objects_.size()), cls});
  }

  /// A variable whose object is of one of these classes; "" if there is none.
  std::string object_of(Texts classes) {
    std::vector<std::string> found;
    for (const Object& object : objects_)
      for (const char* cls : classes)
        if (library_.derives(object.cls, cls)) {
          found.push_back(object.variable);
          break;
        }
    return found.empty() ? "" : choose_.one_of(found);
  }

  // --- values ------------------------------------------------------------------------------------------------------------

  std::string integer() {
    if (choose_.chance(60)) return pick({"0", "1", "2", "3", "4", "5", "7", "10"});
    return pick({"-1", "-2", "2147483647", "(-2147483647 - 1)", "255", "256", "4097", "1000000", "number", "|items|"});
  }
  std::string real() {
    if (choose_.chance(65)) return pick({"0.0", "1.0", "0.5", "2.0", "0.1", "-1.0", "10.0", "random[1.0]", "6.3"});
    return pick({"1.0e300", "-1.0e300", "1.0e-300", "sqrt(-1.0)", "exp(1000.0)", "(0.0 - exp(1000.0))", "real",
                 "1.0e10", "1.0e-10", "-0.5", "1.0e38"});
  }
  std::string vector() {
    if (choose_.chance(70))
      return pick({"(0, 0, 0)", "(1, 0, 0)", "(0, 1, 0)", "(0, 0, 1)", "(1, 1, 1)", "(0.5, 0.2, -0.3)", "(0, -9.8, 0)",
                   "(2, 3, 0)", "random[(5, 5, 5)] - (2, 2, 2)", "place", "(0, 1.5, 0)"});
    const std::string x = real(), y = real();
    return "(" + x + ", " + y + ", " + real() + ")";
  }
  std::string matrix() {
    return pick({"[ (1, 0, 0), (0, 1, 0), (0, 0, 1) ]", "[ (0, 0, 0), (0, 0, 0), (0, 0, 0) ]",
                 "rotationMatrix((0, 1, 0), 0.7)", "turn", "[ (1, 2, 3), (4, 5, 6), (7, 8, 9) ]",
                 "[ (-1, 0, 0), (0, 1, 0), (0, 0, 1) ]", "[ (1.0e300, 0, 0), (0, 1.0e-300, 0), (0, 0, 1) ]"});
  }
  std::string action() { return "act" + std::to_string(choose_.below(kActions)); }
  std::string class_name() {
    return choose_.chance(70) ? "T" + choose_.one_of(classes_) : choose_.one_of(library_.classes()).name;
  }
  std::string string(const std::string& hint) {
    const std::string about = lowered(hint);
    if (choose_.chance(70)) {
      if (has(about, "class") || has(about, "type")) return "\"" + class_name() + "\"";
      if (has(about, "method") || has(about, "named"))
        return "\"" +
               (choose_.chance(60) ? action() : pick({"hit", "heard", "iterate", "init", "destroy", "due", "none"})) +
               "\"";
      if (has(about, "rung") || has(about, "accuracy"))
        return "\"" + pick({"fast", "balanced", "precise", "conserving", "none"}) + "\"";
      if (has(about, "xml") || has(about, "request")) return "text";
      if (has(about, "notif") || has(about, "message")) return "\"" + pick({"n1", "n2"}) + "\"";
      if (has(about, "file") || has(about, "name")) return pick({"\"none\"", "\"\""});
    }
    return pick({"\"impact\"", "\"step\"", "\"moore\"", "\"synchronous\"", "\"random\"", "\"checker\"", "\"rest\"",
                 "\"off\"", "text", "\"\"", "\"n1\"", "\"$number $place\"", "\"\\xff\\x00\""});
  }
  std::string any_object() { return objects_.empty() ? "self" : choose_.one_of(objects_).variable; }
  std::string object(const std::string& type, const std::string& hint) {
    const std::string about = lowered(hint);
    const std::string cls = type.substr(0, type.find(' '));
    if (choose_.chance(75)) {
      std::string found;
      if (library_.find(cls))
        found = object_of({cls.c_str()});
      else if (has(about, "shape"))
        found = object_of({"Shape"});
      else if (has(about, "image") || has(about, "texture"))
        found = object_of({"Image"});
      else if (has(about, "chemical"))
        found = object_of({"PatchChemical"});
      else if (has(about, "grid"))
        found = object_of({"PatchGrid"});
      else if (has(about, "joint"))
        found = object_of({"Joint"});
      else if (has(about, "matrix") || has(about, "source") || has(about, "field"))
        found = object_of({"Matrix", "Vector"});
      else if (has(about, "child") || has(about, "parent") || has(about, "link") || has(about, "root"))
        found = object_of({"Link", "Mobile"});
      if (!found.empty()) return found;
    }
    return choose_.chance(70) ? any_object() : pick({"self", "0", "me", "other", "gone", "(new TObject)"});
  }
  std::string list() {
    if (choose_.chance(50))
      return pick({"items", "{}", "{ 1, 2, 3 }", "{ (0, 0, 0), (1, 0, 0), (0, 1, 0) }", "{ 0.5 }", "{ \"a\", \"b\" }",
                   "ring", "{ { 1 }, { 2 } }"});
    std::string text = "{ ";
    for (std::size_t i = choose_.below(4); i > 0; --i)
      text += (choose_.chance(50) ? any_object() : value("any", "")) + ", ";
    return text + "1 }";
  }
  std::string value(const std::string& type, const std::string& hint) {
    if (choose_.chance(4)) return pick({"0", "0.0", "(0, 0, 0)", "\"\"", "{}", "gone", "table", "bytes", "ring", "-1"});
    if (type == "int") return integer();
    if (type == "float" || type == "double") return real();
    if (type == "vector") return vector();
    if (type == "matrix") return matrix();
    if (type == "string") return string(hint);
    if (type == "list") return list();
    if (type == "hash") return "table";
    if (type == "data") return "bytes";
    if (has(type, "object")) return object(type, hint);
    switch (choose_.below(5)) {
      case 0: return real();
      case 1: return vector();
      case 2: return string(hint);
      case 3: return any_object();
      default: return integer();
    }
  }
  /// The variable that takes a result of this type; "" if there is none.
  static std::string holder(const std::string& type) {
    if (type == "int") return "number";
    if (type == "float" || type == "double") return "real";
    if (type == "vector") return "place";
    if (type == "matrix") return "turn";
    if (type == "string") return "text";
    if (type == "list") return "items";
    if (type == "hash") return "table";
    if (type == "data") return "bytes";
    return has(type, "object") ? "got" : "";
  }

  // --- statements --------------------------------------------------------------------------------------------------------

  std::string call(const std::string& receiver, const std::string& cls) {
    std::vector<const LibraryClass*> line_of;
    for (const LibraryClass* c = library_.find(cls); c; c = library_.find(c->parent)) line_of.push_back(c);
    if (line_of.empty()) return "";
    const LibraryClass& owner = *line_of[choose_.chance(65) ? 0 : choose_.below(line_of.size())];
    if (owner.selectors.empty()) return "";
    const LibrarySelector& selector = choose_.one_of(owner.selectors);
    if (is_left_out(selector.name) || selector.name == "init" || (selector.name == "iterate" && receiver == "self"))
      return "";
    std::string text = receiver + " " + selector.name;
    for (const LibraryKeyword& keyword : selector.keywords)
      if (!keyword.optional || choose_.chance(60))
        text += " " + keyword.name + " " + value(keyword.type, keyword.name + keyword.parameter);
    const std::string to = holder(selector.type);
    return to.empty() || choose_.chance(40) ? text + "." : to + " = (" + text + ").";
  }

  std::string function_call() {
    const LibrarySelector& function = choose_.one_of(library_.functions());
    if (is_left_out(function.name)) return "";
    std::string text = function.name + "(";
    for (std::size_t i = 0; i < function.keywords.size(); ++i)
      text += (i == 0 ? "" : ", ") + value(function.keywords[i].type, function.keywords[i].parameter);
    const std::string to = holder(function.type);
    return (to.empty() ? "" : to + " = ") + text + ").";
  }

  std::string variable_statement() {
    const Object& object = choose_.one_of(objects_);
    std::vector<const LibraryVariable*> all;
    for (const LibraryClass* c = library_.find(object.cls); c; c = library_.find(c->parent))
      for (const LibraryVariable& variable : c->variables) all.push_back(&variable);
    if (all.empty()) return "";
    const LibraryVariable& variable = *choose_.one_of(all);
    return object.variable + "::" + variable.name + " = " + value(variable.type, variable.name) + ".";
  }

  std::string link_statement() {
    const std::string joint = object_of({"Joint"}), parent = object_of({"Link", "Mobile"}),
                      child = object_of({"Link", "Mobile"});
    if (joint.empty() || child.empty()) return "";
    const auto cls =
        std::find_if(objects_.begin(), objects_.end(), [&](const Object& o) { return o.variable == joint; });
    const bool plain = cls->cls == "FixedJoint" || cls->cls == "BallJoint";
    const auto point = [this] { return pick({"(0, 0, 0)", "(1, 0, 0)", "(0, -1, 0)", "(0.5, 0.2, 0)"}); };
    std::string text = joint + " link ";
    if (!plain) text += "with-normal " + vector() + " ";
    text += "parent " + (choose_.chance(30) ? "0" : parent) + " to-child " + child;
    text += " with-parent-point " + point();
    return text + " with-child-point " + point() + ".";
  }

  std::string statement() {
    switch (choose_.below(28)) {
      case 0: return "free " + any_object() + ".";
      case 1: {
        const Object& object = choose_.one_of(objects_);
        return object.variable + " = new T" + object.cls + ".";
      }
      case 2: return function_call();
      case 3: return "push " + value("any", "") + " onto items.";
      case 4: return "table{" + value("any", "") + "} = " + value("any", "") + ".";
      case 5: return variable_statement();
      case 6: return "for i = 0, i < " + std::to_string(choose_.below(256)) + ", i++: text = \"garbage $i\".";
      case 7: return "text = (" + any_object() + " archive-as-xml-string).";
      case 8: return "got = (self parse-xml-network-request from-string text).";
      case 9: {
        const std::string at = std::to_string(choose_.below(1200));
        return "if |text| > " + at + ": text{" + at + "} = \"" + pick({"0", "1", "7", "f", "<", "a"}) + "\".";
      }
      case 10: return any_object() + " schedule method-call \"" + action() + "\" at-time (self get-time) + 0.1.";
      case 11:
        return any_object() + " observe instance " + any_object() + " for-notification \"n1\" with-method \"heard\".";
      case 12: return any_object() + " announce message \"" + pick({"n1", "n2"}) + "\".";
      case 13: {
        const std::string body = object_of({"Real"});
        return body.empty() ? "" : body + " handle-collisions with-type \"" + class_name() + "\" with-method \"hit\".";
      }
      case 14: return "items = (all T" + choose_.one_of(classes_) + ").";
      case 15:
        return pick({"sort items with compare.", "items = copylist items.", "pop items.", "push items onto items.",
                     "text = \"$items\".", "print items, table, got, me, gone, ring.", "text = text + text."});
      case 16:
        return "callMethodNamed(" + any_object() + ", \"" +
               pick({"act1", "free-me", "hit", "due", "archive", "iterate"}) + "\", " + list() + ").";
      case 17: return "self call-method named \"" + action() + "\".";
      case 18: return call("self", base_);
      case 19: return link_statement();
      case 20: {
        const std::string body = object_of({"Real"}), shape = object_of({"Shape"});
        return body.empty() || shape.empty() ? "" : body + " set-shape to " + shape + ".";
      }
      case 21: return call(pick({"me", "other", "got", "gone"}), choose_.one_of(library_.classes()).name);
      default: {
        const Object& object = choose_.one_of(objects_);
        return call(object.variable, object.cls);
      }
    }
  }

  // --- the text --------------------------------------------------------------------------------------------------------

  void hook(std::size_t percent, const std::string& head, const std::string& last = "") {
    if (!choose_.chance(percent)) return;
    line("  + to " + head + ":");
    line("    (getController()) run of self with 0 action \"" + action() + "\".");
    if (!last.empty()) line("    " + last);
  }

  void write_class(const std::string& cls) {
    line(cls + " : T" + cls + " (aka T" + cls + "s) {");
    line("  + variables:\n    note (string).\n    bag (list).");
    if (cls != "Data" && cls != "Genome") hook(15, "init", choose_.chance(20) ? "self enable-auto-free." : "");
    hook(15, "iterate");
    hook(25, "destroy", "super destroy.");
    hook(10, "archive", "return 1.");
    hook(10, "dearchive", "return 1.");
    hook(10, "get-description", "return \"described\".");
    if (library_.derives(cls, "Patch")) hook(30, "init-patch");
    if (library_.derives(cls, "Shape")) hook(10, "get-scale", "return (1, 2, 3).");
    if (library_.derives(cls, "Mobile")) {
      hook(6, "move to p (vector)", "super move to p.");
      hook(10, "get-force-at time t (float)", "return (0, 1, 0).");
    }
    for (const char* head :
         {"hit with-object o (object) at p (vector) norm n (vector)", "heard from o (object) text t (string)"}) {
      line(std::string("  + to ") + head + ":");
      line("    (getController()) run of self with o action \"" + action() + "\".");
    }
    hook(100, "due");
    for (std::size_t i = 0; i < kActions; i += 3) hook(100, "act" + std::to_string(i));
    line("  + to free-me:\n    free self.");
    line("  + to rule state s (int) neighbors n (int):\n    return ((getController()) rule-of state s neighbors n).");
    line("}");
  }

  void write_maker(const Object& object, std::size_t number) {
    const std::string& v = object.variable;
    line("  + to make" + std::to_string(number) + ":");
    line("    " + v + " = new T" + object.cls + ".");
    if (object.cls == "Cube") line("    " + v + " init-with size (1, 0.5, 1).");
    if (object.cls == "Sphere") line("    " + v + " init-with radius 0.5.");
    if (library_.derives(object.cls, "PatchGrid"))
      line("    " + v + " init-with x-count 3 y-count 4 z-count 1 patch-class \"" + pick({"Patch", "TPatch"}) + "\".");
    if (object.cls == "Matrix2D") line("    " + v + " init-with x-size 3 y-size 4.");
    if (object.cls == "Matrix3D") line("    " + v + " init-with x-size 3 y-size 4 z-size 2.");
    if (library_.derives(object.cls, "Image")) line("    " + v + " set-size width 5 height 4.");
    if (library_.derives(object.cls, "Mobile")) {
      line("    " + v + " move to " + vector() + ".");
      if (choose_.chance(60) && base_ != "Control") line("    " + v + " enable-physics.");
      if (choose_.chance(40))
        line("    " + v + " handle-collisions with-type \"T" + choose_.one_of(classes_) + "\" with-method \"hit\".");
    }
  }

  void write_actions(std::size_t most) {
    for (std::size_t i = 1 + choose_.below(most); i > 0; --i)
      line("    callMethodNamed(self, \"" + action() + "\", {}).");
  }

  /// What a world does on one of its courses.
  void write_course(const std::string& course) {
    line("  + to before-" + course + ":");
    write_actions(4);
    line("  + to after-" + course + ":");
    write_actions(2);
    for (std::size_t i = 0; i < kActions; ++i) {
      line("  + to act" + std::to_string(i) + "-" + course + ":");
      for (std::size_t k = 1 + choose_.below(5); k > 0; --k)
        if (const std::string text = statement(); !text.empty()) line("    " + text);
      line("    return 0.");
    }
  }

  /// @return  how many courses there are
  std::size_t write_controller() {
    line(base_ + " : Main {");
    line("  + variables:");
    for (const Object& object : objects_) line("    " + object.variable + " (object).");
    line("    me, other, gone, got (object).\n    number, i, depth, course (int).\n    real (float).");
    line("    place (vector).");
    line("    turn (matrix).\n    text (string).\n    items, ring (list).\n    table (hash).\n    bytes (data).");
    line("  + to run of x (object) with y (object) action m (string):\n    if depth > 4: return 0.\n    depth++.");
    line("    me = x.\n    other = y.\n    callMethodNamed(self, m, {}).\n    depth--.\n    return 0.");
    line("  + to rule-of state s (int) neighbors n (int):\n    callMethodNamed(self, \"" + action() + "\", {}).");
    line("    if n == 3: return 1.\n    return s.");
    line("  + to compare a x (object) b y (object):\n    callMethodNamed(self, \"" + action() + "\", {}).");
    line("    return random[2] - 1.");
    for (std::size_t i = 0; i < objects_.size(); ++i) write_maker(objects_[i], i);
    line("  + to init:");
    line("    self set-iteration-step to 0.1.\n    self set-integration-step to 0.05.");
    line("    ring = { 1, 2 }.\n    push ring onto ring.\n    gone = new TObject.\n    free gone.");
    for (std::size_t i = 0; i < objects_.size(); ++i)
      line("    callMethodNamed(self, \"make" + std::to_string(i) + "\", {}).");
    line("  + to iterate:\n    depth = 0.\n    callMethodNamed(self, \"before-$course\", {}).\n    super iterate.");
    line("    callMethodNamed(self, \"after-$course\", {}).");
    for (std::size_t i = 0; i < kActions; ++i) {
      const std::string action = "act" + std::to_string(i);
      line("  + to " + action + ":\n    return (callMethodNamed(self, \"" + action + "-$course\", {})).");
    }
    std::size_t courses = 0;
    do write_course(std::to_string(courses++));
    while (courses < kMostCourses && !choose_.empty());
    line("}");
    return courses;
  }

  Choices& choose_;
  const ClassLibrary& library_;
  std::string base_, out_;
  std::vector<std::string> classes_;
  std::vector<Object> objects_;
};

}  // namespace

SelectorProgram selector_program(Choices& choices) { return SelectorWriter(choices).program(); }

}  // namespace breve::fuzz
