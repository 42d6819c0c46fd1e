// The generator's calls: of methods of the program, with keywords in any order and defaults left out, and of the class
// library's.
#include <algorithm>
#include <array>

#include "writer.hpp"

namespace breve::fuzz {

std::string Writer::call(const Kind& result) {
  struct Candidate {
    int cls;
    const Method* method;
  };
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < classes_.size(); ++i)
    for (const auto& m : classes_[i].methods)
      if (!m.special && fits(m.result, result)) candidates.push_back({static_cast<int>(i), &m});
  if (candidates.empty()) return "";
  const auto& candidate = choose_.one_of(candidates);
  std::string receiver;
  if (derives(scope_.cls, candidate.cls) && choose_.chance(70)) {
    receiver = "self";
  } else {
    receiver = variable({Type::Object, candidate.cls});
    if (receiver.empty()) receiver = derives(scope_.cls, candidate.cls) ? "self" : "";
    if (receiver.empty() && choose_.chance(30))
      receiver = "(new " + classes_[static_cast<std::size_t>(candidate.cls)].name + ")";
    if (receiver.empty() || classes_[static_cast<std::size_t>(candidate.cls)].base == Base::Control) return "";
  }
  return "(" + call_text(receiver, candidate.cls, *candidate.method) + ")";
}

std::string Writer::call_text(const std::string& receiver, int, const Method& method) {
  std::vector<std::string> arguments;
  for (const auto& p : method.parameters) {
    if (!p.default_text.empty() && choose_.chance(40)) continue;
    arguments.push_back(" " + p.keyword + " " + expression(p.kind));
  }
  if (arguments.size() > 1 && choose_.chance(30)) std::reverse(arguments.begin(), arguments.end());
  std::string text = receiver + " " + method.name;
  for (const auto& a : arguments) text += a;
  return text;
}

const Method* Writer::some_method(int cls, bool parameterless) {
  std::vector<const Method*> methods;
  for (; cls >= 0; cls = classes_[static_cast<std::size_t>(cls)].parent)
    for (const auto& m : classes_[static_cast<std::size_t>(cls)].methods)
      if (!m.special && (!parameterless || m.parameters.empty())) methods.push_back(&m);
  return methods.empty() ? nullptr : choose_.one_of(methods);
}

/// A method of the current class with that many parameters, as a name in quotes.
std::string Writer::method_name(std::size_t parameters) {
  std::vector<std::string> names;
  for (int cls = scope_.cls; cls >= 0; cls = classes_[static_cast<std::size_t>(cls)].parent)
    for (const auto& m : classes_[static_cast<std::size_t>(cls)].methods)
      if (!m.special && m.parameters.size() == parameters) names.push_back(m.name);
  return "\"" + (names.empty() ? std::string("m0") : choose_.one_of(names)) + "\"";
}

std::string Writer::native_call() {
  const Base base = classes_[static_cast<std::size_t>(scope_.cls)].base;
  if (base == Base::Mobile) return mobile_call("self");
  if (base == Base::Control) return control_call("self");
  std::vector<std::string> bodies;
  for (const auto& v : visible())
    if (v.kind.type == Type::Object && v.kind.cls >= 0 && v.array == 0 &&
        classes_[static_cast<std::size_t>(v.kind.cls)].base == Base::Mobile)
      bodies.push_back(v.name);
  if (!bodies.empty()) return mobile_call(choose_.one_of(bodies));
  switch (choose_.below(4)) {
    case 0: return "self enable-auto-free";
    case 1: return "self disable-auto-free";
    case 2: return "self add-dependency on " + leaf({Type::Object});
    default: return "self remove-dependency on " + leaf({Type::Object});
  }
}

std::string Writer::mobile_call(const std::string& receiver) {
  static constexpr std::array kVectors = {"move to ",
                                          "set-velocity to ",
                                          "set-acceleration to ",
                                          "set-rotational-velocity to ",
                                          "set-rotational-acceleration to ",
                                          "offset by ",
                                          "set-color to ",
                                          "set-force to ",
                                          "set-torque to "};
  static constexpr std::array kPlain = {
      "enable-physics", "disable-physics", "make-invisible",      "suspend-physics",     "resume-physics",
      "show-axis",      "remove-label",    "show-neighbor-lines", "hide-neighbor-lines", "show-bounding-box"};
  switch (choose_.below(14)) {
    case 0:
    case 1:
    case 2:
    case 3: return joined({receiver, " ", choose_.one_of(kVectors), leaf({Type::Vector})});
    case 4: return joined({receiver, " ", choose_.one_of(kVectors), expression({Type::Vector})});
    case 5: return joined({receiver, " rotate around-axis ", leaf({Type::Vector}), " by ", leaf({Type::Double})});
    case 6:
      return joined(
          {receiver, " relative-rotate around-axis ", expression({Type::Vector}), " by ", leaf({Type::Double})});
    case 7: return receiver + " set-neighborhood-size to " + leaf({Type::Double});
    case 8: return receiver + " set-rotation to " + expression({Type::Matrix});
    case 9: {
      static constexpr std::array kShapes = {
          "((new Sphere) init-with radius 1.5)", "((new Cube) init-with size (1, 2, 3))",
          "((new Sphere) init-with radius .25)", "((new PolygonDisk) init-with sides 5 height 1 radius 2)",
          "((new PolygonCone) init-with sides 4 height 2 radius 1)"};
      return joined(
          {receiver, choose_.chance(50) ? " set-shape to " : " register with-shape ", choose_.one_of(kShapes)});
    }
    case 10: return joined({receiver, " point vertex ", leaf({Type::Vector}), " at ", leaf({Type::Vector})});
    case 11: return receiver + " set-label to " + leaf({Type::String});
    case 12:
      return joined({receiver, " set-restitution normal ", leaf({Type::Double}), " tangential ", leaf({Type::Double})});
    default: return receiver + " " + choose_.one_of(kPlain);
  }
}

std::string Writer::control_call(const std::string& receiver) {
  static constexpr std::array kCalls = {
      "update-neighbors",
      "set-integration-step to .01",
      "set-integration-step to .04",
      "set-iteration-step to .05",
      "set-iteration-step to .1",
      "set-random-seed to 7",
      "set-impact-timing to \"step\"",
      "set-impact-timing to \"impact\"",
      "set-gravity to (0, -2, 0)",
      "set-background-color to (.1, .2, .3)",
      "set-display-text to \"text\" number 1",
      "enable-lighting",
      "zoom-camera to 20",
      "point-camera at (0, 1, 0) from (10, 0, 0)",
      "set-accuracy to \"fast\"",
      "add-menu-separator",
  };
  if (choose_.chance(20))
    return joined({receiver, " add-menu named ", leaf({Type::String}), " for-method ", method_name(0)});
  if (choose_.chance(10)) return receiver + " watch item " + leaf({Type::Object});
  return receiver + " " + choose_.one_of(kCalls);
}

std::string Writer::native_value(const Kind& kind) {
  const Base base = classes_[static_cast<std::size_t>(scope_.cls)].base;
  const bool body = base == Base::Mobile || base == Base::Stationary;
  switch (kind.type) {
    case Type::Vector: {
      static constexpr std::array kVectors = {
          "get-location",      "get-velocity", "get-acceleration", "get-force", "get-rotational-velocity",
          "get-bound-maximum", "get-color"};
      if (base == Base::Mobile) return "(self " + std::string(choose_.one_of(kVectors)) + ")";
      return base == Base::Stationary ? "(self get-location)" : "";
    }
    case Type::Matrix: return body ? "(self get-rotation)" : "";
    case Type::Double:
      if (base == Base::Mobile && choose_.chance(50)) return "(self get-distance from " + leaf({Type::Object}) + ")";
      return base == Base::Control ? "(self get-time)" : "(self get-age)";
    case Type::Int:
      if (choose_.chance(50)) return joined({"(self can-respond to ", method_name(choose_.below(3)), ")"});
      return "(self is a " + leaf({Type::String}) + ")";
    case Type::List:
      if (kind.element != Type::Object || kind.element_cls >= 0) return "";
      if (base == Base::Mobile && choose_.chance(30)) return "(self check-for-penetrations)";
      return body ? "(self get-neighbors)" : "";
    case Type::String: return choose_.chance(50) ? "(self get-type)" : "";
    case Type::Object:
      if (kind.cls < 0 && choose_.chance(20)) return "callMethodNamed(self, " + method_name(0) + ", {})";
      return "";
    case Type::Hash: return "";
  }
  return "";
}

}  // namespace breve::fuzz
