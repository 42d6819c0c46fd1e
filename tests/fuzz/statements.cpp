// The generator's statements, and methods as a whole.
#include <array>

#include "writer.hpp"

namespace breve::fuzz {

namespace {

constexpr std::array kAssignments = {" = ", " = ", " = ", " += ", " -= ", " *= ", " /= ", " %= ", " ^= "};
constexpr std::array kMessages = {"\"tick\"", "\"red\"", "\"a\""};
constexpr int kMostLoops = 3;  // one in the other

std::string margin(int indent) { return std::string(static_cast<std::size_t>(indent), ' '); }

}  // namespace

std::string Writer::method(int cls, const Method& method) {
  scope_ = {};
  scope_.cls = cls;
  scope_.method = &method;
  std::string text = "  + to " + method.name;
  for (const auto& p : method.parameters) {
    text += " " + p.keyword + " " + p.name + (p.default_text.empty() ? "" : " = " + p.default_text) + " (" +
            declared(p.kind) + ")";
    scope_.locals.push_back({p.name, p.kind, 0});
  }
  text += ":\n";
  for (std::size_t i = choose_.below(5); i > 0; --i) {
    Variable v{"l" + std::to_string(i), any_kind(true), 0};
    text += "    " + v.name + " (" + declared(v.kind) + ").\n";
    scope_.locals.push_back(std::move(v));
  }
  text += "    i0, i1, i2, i3 (int).\n" + method.prologue;
  text += statements(1 + choose_.below(8), 4);
  text += method.after;
  if (!method.special) text += "    return " + expression(method.result) + ".\n";
  return text;
}

std::string Writer::statements(std::size_t count, int indent) {
  std::string text;
  for (std::size_t i = 0; i < count && (i == 0 || !choose_.empty()); ++i)
    text += margin(indent) + statement(indent) + "\n";
  return text;
}

std::string Writer::block(int indent) {
  return joined({"{\n", statements(1 + choose_.below(3), indent + 2), margin(indent), "}"});
}

std::string Writer::statement(int indent) {
  switch (choose_.below(16)) {
    case 0:
    case 1:
    case 2:
    case 3: return assignment();
    case 4:
    case 5: return indent < 12 ? loop(indent) : assignment();
    case 6:
    case 7: return indent < 12 ? branch(indent) : assignment();
    case 8: {
      const auto made = call(any_kind(true));
      return made.empty() ? assignment() : made.substr(1, made.size() - 2) + ".";
    }
    case 9:
    case 10: return native_call() + ".";
    case 11:
    case 12: return list_statement();
    case 13: return event_statement();
    case 14: return lifetime_statement();
    default: {
      std::string text = choose_.chance(80) ? "print " : "printf ";
      text += expression(any_kind(true));
      for (std::size_t i = choose_.below(3); i > 0; --i) text += ", " + expression(any_kind(true));
      return text + ".";
    }
  }
}

/// Something that can be assigned to, and what it takes.
std::string Writer::target(Kind& kind) {
  const auto all = visible();
  const auto& v = choose_.one_of(all);  // i0 aside, self is always there: see assignment
  kind = v.kind;
  const auto name = named(v.name, v.kind, v.array);
  if (v.kind.type == Type::Vector && choose_.chance(40)) {
    kind = {Type::Double};
    static constexpr std::array kParts = {"::x", "::y", "::z", "{0}", "{2}"};
    return name + choose_.one_of(kParts);
  }
  if (v.kind.type == Type::Matrix && choose_.chance(40)) {
    kind = {choose_.chance(50) ? Type::Vector : Type::Double};
    return name + (kind.type == Type::Vector ? "{1}" : "{1}{2}");
  }
  if (v.kind.type == Type::Hash && choose_.chance(90)) {
    kind = {v.kind.element, v.kind.element_cls};
    return joined({name, choose_.chance(30) ? std::string("::part") : "{" + key() + "}"});
  }
  if (v.kind.type == Type::List && choose_.chance(50)) {
    kind = {v.kind.element, v.kind.element_cls};
    return name + "{" + std::to_string(choose_.below(3)) + "}";
  }
  if (v.kind.type == Type::Object && v.kind.cls >= 0 && v.array == 0 && choose_.chance(40)) {
    const auto& other = classes_[static_cast<std::size_t>(v.kind.cls)].variables;
    if (!other.empty()) {
      const auto& member = choose_.one_of(other);
      if (member.array == 0) {
        kind = member.kind;
        return name + "::" + member.name;
      }
    }
  }
  return name;
}

std::string Writer::assignment() {
  if (visible().empty()) return "i3 = " + expression({Type::Int}) + ".";
  Kind kind;
  const auto to = target(kind);
  if ((kind.type == Type::Int || kind.type == Type::Double) && choose_.chance(70)) {
    if (choose_.chance(15)) return to + (choose_.chance(50) ? "++." : "--.");
    return joined({to, choose_.one_of(kAssignments), expression(choose_.chance(80) ? kind : Kind{Type::Double}), "."});
  }
  if (kind.type == Type::String && choose_.chance(30)) return to + " += " + expression({Type::String}) + ".";
  if (kind.type == Type::Vector && choose_.chance(30))
    return joined({to, choose_.chance(50) ? " += " : " -= ", expression({Type::Vector}), "."});
  return to + " = " + expression(kind) + ".";
}

std::string Writer::loop(int indent) {
  if (scope_.loops >= kMostLoops) return assignment();
  const std::string i = "i" + std::to_string(scope_.loops++);
  std::string text;
  switch (choose_.below(7)) {
    case 0:
    case 1:
      text =
          joined({"for ", i, " = 0, ", i, " < ", std::to_string(1 + choose_.below(9)), ", ", i, "++: ", block(indent)});
      break;
    case 2: text = joined({"while (", i, "++) < ", std::to_string(1 + choose_.below(9)), ": ", block(indent)}); break;
    case 3:
      text = joined({"while ", condition(), ": ", block(indent)});
      break;  // perhaps without end: the budget ends it
    default: {
      Kind found;
      const auto list = choose_.chance(60) ? container(Type::List, found) : "";
      const Kind element = list.empty() ? Kind{Type::Object} : Kind{found.element, found.element_cls};
      auto runner = variable(element);
      if (runner.empty() || runner.find('[') != std::string::npos) {
        text = joined({"if ", condition(), ": ", block(indent)});
        break;
      }
      text = joined({"foreach ", runner, " in ", (list.empty() ? objects_list() : list), ": ", block(indent)});
      break;
    }
  }
  --scope_.loops;
  return text;
}

std::string Writer::objects_list() {
  const auto& cls = choose_.one_of(classes_);
  if (choose_.chance(70)) return "(all " + cls.name + ")";
  const auto near = native_value({Type::List, -1, Type::Object, -1});
  return near.empty() ? "(all " + cls.alias + ")" : near;
}

std::string Writer::branch(int indent) {
  std::string text = joined({"if ", condition(), ": ", block(indent)});
  if (choose_.chance(40)) text += " else " + block(indent);
  return text;
}

std::string Writer::list_statement() {
  Kind found;
  const auto list = container(Type::List, found);
  if (list.empty()) return assignment();
  const Kind element{found.element, found.element_cls};
  switch (choose_.below(9)) {
    case 0:
    case 1:
    case 2: return "push " + expression(element) + " onto " + list + ".";
    case 3: return "prepend " + expression(element) + " onto " + list + ".";
    case 4: return joined({"insert ", expression(element), " at ", list, "{", std::to_string(choose_.below(4)), "}."});
    case 5: return "remove " + list + "{" + std::to_string(choose_.below(4)) + "}.";
    case 6: return "sort " + list + " with compare.";
    case 7: return "push " + list + " onto " + list + ".";  // a cycle
    default:
      // A call on a list goes to all that are in it.
      return element.type == Type::Object ? list + " get-age." : "print " + list + ".";
  }
}

std::string Writer::event_statement() {
  const auto message = std::string(choose_.one_of(kMessages));
  switch (choose_.below(7)) {
    case 0:
      return joined(
          {"self schedule method-call ", method_name(0), " at-time getTime() + ", literal({Type::Double}), "."});
    case 1:
      return joined(
          {"self schedule-repeating method-call ", method_name(0), " with-interval ", literal({Type::Double}), "."});
    case 2: return "self unschedule method-call " + method_name(0) + ".";
    case 3:
    case 4:
      return joined({"self observe instance ", leaf({Type::Object}), " for-notification ", message, " with-method ",
                     method_name(choose_.below(3)), "."});
    case 5: return "self unobserve instance " + leaf({Type::Object}) + " for-notification " + message + ".";
    default: return "self announce message " + message + ".";
  }
}

std::string Writer::lifetime_statement() {
  switch (choose_.below(6)) {
    case 0: {
      Kind found;
      const auto list = container(Type::List, found);
      return list.empty() || found.element != Type::Object ? assignment() : "free " + list + ".";
    }
    case 1: return "free " + leaf({Type::Object}) + ".";
    case 2: return choose_.chance(20) ? "free self." : assignment();
    case 3: {
      const auto held = variable({Type::Object});
      return held.empty() ? assignment() : "if " + held + ": free " + held + ".";
    }
    case 4: return "(new " + choose_.one_of(classes_).name + ") enable-auto-free.";
    default: return choose_.chance(10) ? "die \"enough\"." : native_call() + ".";
  }
}

}  // namespace breve::fuzz
