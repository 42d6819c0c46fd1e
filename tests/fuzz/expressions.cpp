// The generator's expressions: of the type that is wanted, out of what is visible. Every compound stands in
// parentheses, so that the text means what the generator meant.
#include <array>

#include "writer.hpp"

namespace breve::fuzz {

namespace {

constexpr int kDeepest = 4;
constexpr std::array kArithmetic = {" + ", " - ", " * ", " / ", " % ", " ^ "};
constexpr std::array kComparisons = {" == ", " != ", " < ", " <= ", " > ", " >= "};
constexpr std::array kWords = {"a", "b", "red", "", "12", "3.5", "x y", "tick", "C0", "C1"};
constexpr std::array kFunctions = {"sin", "cos", "tan", "asin", "acos", "atan", "sqrt", "exp", "log", "abs"};

}  // namespace

std::string Writer::expression(const Kind& kind) {
  if (scope_.depth >= kDeepest || choose_.empty()) return leaf(kind);
  ++scope_.depth;
  std::string text;
  switch (choose_.below(8)) {
    case 0:
    case 1: text = leaf(kind); break;
    case 2: text = call(kind); break;
    case 3: text = element_of_container(kind); break;
    case 4: text = native_value(kind); break;
    default: break;
  }
  if (text.empty()) {
    switch (kind.type) {
      case Type::Int: text = int_expression(); break;
      case Type::Double: text = double_expression(); break;
      case Type::Vector: text = vector_expression(); break;
      case Type::Matrix: text = matrix_expression(); break;
      case Type::String: text = string_expression(); break;
      case Type::Object: text = object_expression(kind.cls); break;
      case Type::List: text = list_expression(kind); break;
      case Type::Hash: text = hash_expression(kind); break;
    }
  }
  --scope_.depth;
  return text;
}

std::string Writer::leaf(const Kind& kind) {
  if (!choose_.chance(30))
    if (auto text = variable(kind); !text.empty()) return text;
  switch (kind.type) {
    case Type::Object: return kind.cls < 0 || derives(scope_.cls, kind.cls) ? "self" : "0";
    case Type::List:
    case Type::Hash: {
      Kind found;
      return kind.type == Type::List ? "{}" : container(Type::Hash, found).empty() ? "0" : container(Type::Hash, found);
    }
    default: return literal(kind);
  }
}

std::string Writer::literal(const Kind& kind) {
  static constexpr std::array kInts = {"0", "1", "2", "3", "5", "7", "-1", "100", "255", "2147483647"};
  static constexpr std::array kDoubles = {"0.0", "1.0", ".5", "2.5", "-1.5", "1e3", "3.14159", "-0.001", "1e300"};
  static constexpr std::array kVectors = {"(0, 0, 0)", "(1, 0, 0)", "(0, 1, 2)", "(-3, .5, 2.25)", "(10, -10, 1e-3)"};
  static constexpr std::array kMatrices = {"[(1, 0, 0), (0, 1, 0), (0, 0, 1)]", "[(1, 2, 3), (4, 5, 6), (7, 8, 10)]",
                                           "[(0, 0, 0), (0, 0, 0), (0, 0, 0)]"};
  switch (kind.type) {
    case Type::Int: return choose_.one_of(kInts);
    case Type::Double: return choose_.one_of(kDoubles);
    case Type::Vector: return choose_.one_of(kVectors);
    case Type::Matrix: return choose_.one_of(kMatrices);
    case Type::String: return "\"" + std::string(choose_.one_of(kWords)) + "\"";
    default: return "";
  }
}

std::string Writer::int_expression() {
  const auto sub = [&] { return expression({Type::Int}); };
  switch (choose_.below(15)) {
    case 0:
    case 1:
    case 2: return joined({"(", sub(), choose_.one_of(kArithmetic), sub(), ")"});
    case 3:
      return joined({"(", expression({Type::Double}), choose_.one_of(kComparisons), expression({Type::Double}), ")"});
    case 4: return joined({"(", sub(), choose_.one_of(kComparisons), sub(), ")"});
    case 5: return condition();
    case 6: return "(- " + sub() + ")";
    case 7: return "(!" + sub() + ")";
    case 8: return "random[" + sub() + "]";
    case 9: return "(| " + sub() + " |)";
    case 10: {
      Kind found;
      const auto list = container(choose_.chance(70) ? Type::List : Type::String, found);
      return list.empty() ? "(| " + expression({Type::String}) + " |)" : "(| " + list + " |)";
    }
    case 11:
      return joined(
          {"(", expression({Type::String}), choose_.chance(50) ? " == " : " != ", expression({Type::String}), ")"});
    case 12:
      return joined(
          {"(", expression({Type::Vector}), choose_.chance(50) ? " == " : " != ", expression({Type::Vector}), ")"});
    case 13:
      return joined({"(", object_expression(-1), choose_.chance(50) ? " == " : " != ", object_expression(-1), ")"});
    default:
      return choose_.chance(50) ? "isa(" + expression({Type::String}) + ")"
                                : "isnan(" + expression({Type::Double}) + ")";
  }
}

std::string Writer::double_expression() {
  const auto sub = [&] { return expression({Type::Double}); };
  switch (choose_.below(14)) {
    case 0:
    case 1:
    case 2: return joined({"(", sub(), choose_.one_of(kArithmetic), sub(), ")"});
    case 3: return joined({"(", sub(), choose_.one_of(kArithmetic), expression({Type::Int}), ")"});
    case 4: return "(- " + sub() + ")";
    case 5: return "(| " + expression({Type::Vector}) + " |)";
    case 6: return joined({choose_.one_of(kFunctions), "(", sub(), ")"});
    case 7: return joined({choose_.chance(50) ? "min(" : "max(", sub(), ", ", sub(), ")"});
    case 8: return joined({"dot(", expression({Type::Vector}), ", ", expression({Type::Vector}), ")"});
    case 9:
      return joined({expression({Type::Vector}), choose_.chance(50) ? "::x" : choose_.chance(50) ? "::y" : "::z"});
    case 10: return "random[" + sub() + "]";
    case 11: {
      static constexpr std::array kDraws = {"randomGauss()", "randomExponential()", "getTime()", "randomGamma(3)"};
      return choose_.one_of(kDraws);
    }
    case 12: return joined({"angle(", expression({Type::Vector}), ", ", expression({Type::Vector}), ")"});
    default: return joined({"(", expression({Type::Vector}), "{", std::to_string(choose_.below(3)), "})"});
  }
}

std::string Writer::vector_expression() {
  const auto sub = [&] { return expression({Type::Vector}); };
  switch (choose_.below(9)) {
    case 0:
    case 1: return joined({"(", sub(), choose_.chance(50) ? " + " : " - ", sub(), ")"});
    case 2: return joined({"(", sub(), choose_.chance(70) ? " * " : " / ", expression({Type::Double}), ")"});
    case 3: return joined({"(", expression({Type::Double}), " * ", sub(), ")"});
    case 4: return joined({"cross(", sub(), ", ", sub(), ")"});
    case 5:
      return joined(
          {"(", expression({Type::Double}), ", ", expression({Type::Int}), ", ", expression({Type::Double}), ")"});
    case 6: return "random[" + sub() + "]";
    case 7: return joined({"(", expression({Type::Matrix}), " * ", sub(), ")"});
    default: return "(- " + sub() + ")";
  }
}

std::string Writer::matrix_expression() {
  const auto sub = [&] { return expression({Type::Matrix}); };
  switch (choose_.below(6)) {
    case 0: return joined({"(", sub(), " + ", sub(), ")"});
    case 1: return joined({"(", sub(), " * ", sub(), ")"});
    case 2: return "transpose(" + sub() + ")";
    case 3: return joined({"(", sub(), " * ", expression({Type::Double}), ")"});
    case 4: return joined({"rotationMatrix(", expression({Type::Vector}), ", ", expression({Type::Double}), ")"});
    default: {
      const auto row = [&] {
        return joined({"(", expression({Type::Double}), ", ", leaf({Type::Double}), ", ", leaf({Type::Int}), ")"});
      };
      return joined({"[", row(), ", ", row(), ", ", row(), "]"});
    }
  }
}

std::string Writer::string_expression() {
  switch (choose_.below(7)) {
    case 0: return joined({"(", expression({Type::String}), " + ", expression({Type::String}), ")"});
    case 1:
    case 2:
    case 3: return text_literal(true);
    case 4: return joined({"typeof(", expression(any_kind(true)), ")"});
    case 5: return "objectName(" + leaf({Type::Object}) + ")";
    default: return text_literal(false);
  }
}

std::string Writer::text_literal(bool interpolated) {
  std::string text = "\"" + std::string(choose_.one_of(kWords));
  const auto all = visible();
  for (std::size_t i = choose_.below(3); interpolated && i > 0 && !all.empty(); --i) {
    const auto& v = choose_.one_of(all);
    text += " ${" + v.name + (v.array != 0 ? "[" + std::to_string(choose_.below(3)) + "]" : "") + "}";
    if (v.array == 0 && v.kind.type == Type::Vector) text += " $" + v.name + "{1}";
  }
  return text + "\"";
}

std::string Writer::object_expression(int cls) {
  switch (choose_.below(6)) {
    case 0: {
      std::vector<std::string> names;
      for (std::size_t i = 0; i < classes_.size(); ++i)
        if (classes_[i].base != Base::Control && derives(static_cast<int>(i), cls)) names.push_back(classes_[i].name);
      if (!names.empty() && choose_.chance(60)) return "(new " + choose_.one_of(names) + ")";
      return leaf({Type::Object, cls});
    }
    case 1:
      return cls < 0 || classes_[static_cast<std::size_t>(cls)].base == Base::Control ? "(self get-controller)"
                                                                                      : leaf({Type::Object, cls});
    case 2:
      return cls < 0 ? "newInstanceForClassString(\"" + choose_.one_of(classes_).name + "\")"
                     : leaf({Type::Object, cls});
    default: return leaf({Type::Object, cls});
  }
}

std::string Writer::list_expression(const Kind& kind) {
  const Kind element{kind.element, kind.element_cls};
  switch (choose_.below(6)) {
    case 0:
      if (kind.element == Type::Object && kind.element_cls >= 0) {
        const auto& cls = classes_[static_cast<std::size_t>(kind.element_cls)];
        return choose_.chance(30) && cls.base != Base::Control
                   ? "(" + std::to_string(choose_.below(5)) + " new " + cls.name + ")"
                   : "(all " + (choose_.chance(50) ? cls.name : cls.alias) + ")";
      }
      [[fallthrough]];
    case 1:
    case 2: {
      std::string text = "{" + expression(element);
      for (std::size_t i = choose_.below(5); i > 0; --i) text += ", " + expression(element);
      return text + "}";
    }
    case 3: {
      const auto original = variable(kind);
      return original.empty() ? "{}" : "(copylist " + original + ")";
    }
    case 4: {
      Kind found;
      const auto hash = container(Type::Hash, found);
      return kind.element == Type::String && !hash.empty() ? "keys(" + hash + ")" : leaf(kind);
    }
    default: return leaf(kind);
  }
}

std::string Writer::hash_expression(const Kind& kind) { return leaf(kind); }

std::string Writer::condition() {
  const auto one = [&]() -> std::string {
    switch (choose_.below(5)) {
      case 0: return joined({"(", expression({Type::Int}), choose_.one_of(kComparisons), expression({Type::Int}), ")"});
      case 1: return joined({"(", expression({Type::Double}), choose_.one_of(kComparisons), leaf({Type::Double}), ")"});
      case 2: return leaf({Type::Object});
      case 3: return joined({"(", leaf({Type::String}), " == ", leaf({Type::String}), ")"});
      default: return leaf({Type::Int});
    }
  };
  switch (choose_.below(4)) {
    case 0: return joined({"(", one(), " && ", one(), ")"});
    case 1: return joined({"(", one(), " || ", one(), ")"});
    case 2: return "(!" + one() + ")";
    default: return one();
  }
}

std::string Writer::key() {
  switch (choose_.below(4)) {
    case 0: return expression({Type::Int});
    case 1: return leaf({Type::Vector});
    case 2: return leaf({Type::Object});
    default: return "\"" + std::string(choose_.one_of(kWords)) + "\"";
  }
}

// --- what is visible -------------------------------------------------------------------------------------------------

bool Writer::derives(int cls, int from) const {
  if (from < 0) return true;
  while (cls >= 0 && cls != from) cls = classes_[static_cast<std::size_t>(cls)].parent;
  return cls == from;
}

bool Writer::fits(const Kind& have, const Kind& want) {
  if (have.type != want.type) return false;
  if (want.type == Type::Object) return want.cls < 0 || have.cls == want.cls;
  if (want.type == Type::List) return have.element == want.element && have.element_cls == want.element_cls;
  return true;
}

std::vector<Variable> Writer::visible() const {
  auto all = scope_.locals;
  for (int cls = scope_.cls; cls >= 0; cls = classes_[static_cast<std::size_t>(cls)].parent) {
    const auto& own = classes_[static_cast<std::size_t>(cls)].variables;
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

std::string Writer::named(const std::string& name, const Kind&, int array) {
  if (array == 0) return name;
  const auto index = std::to_string(choose_.below(static_cast<std::size_t>(array)));
  return joined({name, "[", choose_.chance(10) ? literal({Type::Int}) : index, "]"});
}

std::string Writer::variable(const Kind& kind) {
  std::vector<Variable> fitting;
  for (const auto& v : visible())
    if (fits(v.kind, kind)) fitting.push_back(v);
  if (fitting.empty()) return "";
  const auto& v = choose_.one_of(fitting);
  return named(v.name, v.kind, v.array);
}

std::string Writer::container(Type type, Kind& found) {
  std::vector<Variable> fitting;
  for (const auto& v : visible())
    if (v.kind.type == type) fitting.push_back(v);
  if (fitting.empty()) return "";
  const auto& v = choose_.one_of(fitting);
  found = v.kind;
  return named(v.name, v.kind, v.array);
}

/// An element that is of the wanted type if the program keeps its containers clean, which it need not.
std::string Writer::element_of_container(const Kind& kind) {
  std::vector<Variable> fitting;
  for (const auto& v : visible())
    if ((v.kind.type == Type::List || v.kind.type == Type::Hash) && v.kind.element == kind.type &&
        (kind.type != Type::Object || kind.cls < 0 || v.kind.element_cls == kind.cls))
      fitting.push_back(v);
  if (fitting.empty()) return "";
  const auto& v = choose_.one_of(fitting);
  const auto name = named(v.name, v.kind, v.array);
  if (v.kind.type == Type::Hash)
    return choose_.chance(80) ? "(" + name + "{" + key() + "})" : "(remove " + name + "{" + key() + "})";
  switch (choose_.below(6)) {
    case 0: return "(pop " + name + ")";
    case 1: return "(unprepend " + name + ")";
    case 2: return "(remove " + name + "{" + std::to_string(choose_.below(4)) + "})";
    case 3: return "(" + name + "{" + expression({Type::Int}) + "})";
    default: return "(" + name + "{" + std::to_string(choose_.below(3)) + "})";
  }
}

Kind Writer::any_kind(bool containers) {
  const auto simple = [&]() -> Kind {
    switch (choose_.below(8)) {
      case 0:
      case 1: return {Type::Int};
      case 2:
      case 3: return {Type::Double};
      case 4: return {Type::Vector};
      case 5: return {Type::String};
      case 6: return {Type::Matrix};
      default: return {Type::Object, choose_.chance(60) ? static_cast<int>(choose_.below(classes_.size())) : -1};
    }
  };
  Kind kind = simple();
  if (containers && choose_.chance(30)) {
    kind.element = kind.type;
    kind.element_cls = kind.cls;
    kind.cls = -1;
    kind.type = choose_.chance(70) ? Type::List : Type::Hash;
  }
  return kind;
}

std::string Writer::declared(const Kind& kind) const {
  switch (kind.type) {
    case Type::Int: return "int";
    case Type::Double: return "float";
    case Type::Vector: return "vector";
    case Type::Matrix: return "matrix";
    case Type::String: return "string";
    case Type::List: return "list";
    case Type::Hash: return "hash";
    case Type::Object: break;
  }
  return kind.cls < 0 ? "object" : classes_[static_cast<std::size_t>(kind.cls)].name + " object";
}

}  // namespace breve::fuzz
