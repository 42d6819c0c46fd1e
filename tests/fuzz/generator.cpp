// Programs as a whole: classes with their variables and the heads of their methods first, so that bodies may use all.
#include "generator.hpp"

#include <array>

#include "writer.hpp"

namespace breve::fuzz {

namespace {

class Generator {
 public:
  explicit Generator(Choices& choices) : choose_(choices), writer_(choices, classes_) {}

  std::string program() {
    const std::size_t count = 2 + choose_.below(4);
    for (std::size_t i = 0; i < count; ++i) declare_class(i, i + 1 == count);
    for (std::size_t i = 0; i < count; ++i) declare_members(i);
    std::string text = "@use Control.\n@use Mobile.\n@use Stationary.\n@use Shape.\n\nController C" +
                       std::to_string(count - 1) + ".\n";
    for (std::size_t i = 0; i < count; ++i) text += class_text(static_cast<int>(i));
    return text;
  }

 private:
  void declare_class(std::size_t number, bool controller) {
    static constexpr std::array kBases = {Base::Object, Base::Mobile, Base::Mobile, Base::Stationary};
    static constexpr std::array kNames = {"Object", "Mobile", "Stationary", "Control"};
    Class cls;
    cls.name = "C" + std::to_string(number);
    cls.alias = cls.name + "s";
    cls.base = controller ? Base::Control : choose_.one_of(kBases);
    if (!controller && number > 0 && choose_.chance(40)) {
      cls.parent = static_cast<int>(choose_.below(number));
      cls.base = classes_[static_cast<std::size_t>(cls.parent)].base;
      cls.parent_name = classes_[static_cast<std::size_t>(cls.parent)].name;
    } else {
      cls.parent_name = kNames[static_cast<std::size_t>(cls.base)];
    }
    classes_.push_back(std::move(cls));
  }

  void declare_members(std::size_t number) {
    Class& cls = classes_[number];
    for (std::size_t i = 1 + choose_.below(6); i > 0; --i) {
      Variable v{"v" + std::to_string(number) + "x" + std::to_string(i), writer_.any_kind(true), 0};
      if (choose_.chance(15)) v.array = static_cast<int>(1 + choose_.below(4));
      cls.variables.push_back(std::move(v));
    }
    for (std::size_t i = 1 + choose_.below(4); i > 0; --i) declare_method(cls, i);
    if (choose_.chance(60)) cls.methods.push_back(special("iterate"));
    if (choose_.chance(20)) cls.methods.push_back(special("post-iterate"));
    if (choose_.chance(20)) cls.methods.push_back(special("destroy"));
    cls.methods.push_back(special("init"));
    if (cls.base == Base::Control) {
      cls.methods.back().prologue = population(number);
      cls.methods.push_back(special("catch-key-a-down"));
      if (choose_.chance(50)) cls.methods.push_back(special("click"));
      if (cls.methods.back().name == "click") cls.methods.back().parameters = {{"on", "item", {Type::Object}, ""}};
    } else if (cls.base != Base::Object && choose_.chance(60)) {
      static constexpr std::array kPoints = {"", "C0", "C1", "C2"};
      const std::string type = choose_.one_of(kPoints);
      cls.methods.back().prologue = "    self handle-collisions with-type \"" +
                                    (type.empty() ? cls.name : type_or_own(type, cls)) +
                                    "\" with-method \"touched\".\n";
      cls.methods.push_back(special("touched"));
      cls.methods.back().parameters = {{"by", "other", {Type::Object}, ""}};
      if (choose_.chance(50)) {
        cls.methods.back().parameters.push_back({"at", "point", {Type::Vector}, ""});
        cls.methods.back().parameters.push_back({"along", "normal", {Type::Vector}, ""});
      }
    }
    if (choose_.chance(20)) {
      cls.methods.push_back(special("get-description"));
      cls.methods.back().after = "    return \"described\".\n";
    }
  }

  std::string type_or_own(const std::string& type, const Class& cls) const {
    for (const auto& c : classes_)
      if (c.name == type && (c.base == Base::Mobile || c.base == Base::Stationary)) return type;
    return cls.name;
  }

  void declare_method(Class& cls, std::size_t number) {
    // An override has the parent's head: sometimes with another count, which makes it an overload.
    if (cls.parent >= 0 && choose_.chance(40)) {
      for (const auto& inherited : classes_[static_cast<std::size_t>(cls.parent)].methods) {
        if (inherited.special || has(cls, inherited)) continue;
        cls.methods.push_back(inherited);
        return;
      }
    }
    Method m;
    m.name = "m" + std::to_string(choose_.chance(60) ? number : choose_.below(3));
    m.result = writer_.any_kind(true);
    for (std::size_t i = choose_.below(4); i > 0; --i) {
      Parameter p{"with-" + std::to_string(i), "p" + std::to_string(i), writer_.any_kind(true), ""};
      p.keyword = "k" + std::to_string(i);
      if (choose_.chance(30)) p.default_text = writer_.literal(p.kind);
      m.parameters.push_back(std::move(p));
    }
    if (!has(cls, m)) cls.methods.push_back(std::move(m));
  }

  static bool has(const Class& cls, const Method& method) {
    for (const auto& m : cls.methods)
      if (m.name == method.name && m.parameters.size() == method.parameters.size()) return true;
    return false;
  }

  static Method special(const std::string& name) {
    Method m;
    m.name = name;
    m.special = true;
    if (name == "iterate" || name == "destroy") m.prologue = "    super " + name + ".\n";
    return m;
  }

  /// What the controller makes at the start: some of each class, bodies in a cloud.
  std::string population(std::size_t controller) {
    std::string text;
    for (std::size_t i = 0; i < controller; ++i) {
      const auto number = 1 + choose_.below(6);
      text += "    i0 = 0.\n    while (i0++) < " + std::to_string(number) + ": ";
      if (classes_[i].base == Base::Mobile)
        text += "(new " + classes_[i].name + ") move to random[(6.0, 6.0, 6.0)].\n";
      else
        text += "new " + classes_[i].name + ".\n";
    }
    return text + "    self add-menu named \"Choose\" for-method \"be-chosen\".\n";
  }

  std::string class_text(int number) {
    const Class& cls = classes_[static_cast<std::size_t>(number)];
    std::string text = "\n" + cls.parent_name + " : " + cls.name + " (aka " + cls.alias + ") {\n  + variables:\n";
    for (const auto& v : cls.variables) text += "    " + v.name + " (" + declaration(v) + ").\n";
    text += "\n";
    for (const auto& m : cls.methods) text += writer_.method(number, m);
    text += "  + to compare one a (float) other b (float):\n    return a - b.\n";
    if (cls.base == Base::Control) text += "  + to be-chosen:\n    print \"chosen\".\n";
    return text + "}\n";
  }

  std::string declaration(const Variable& v) const {
    if (v.array == 0) return writer_.declared(v.kind);
    static constexpr std::array kPlural = {"ints",    "floats",  "vectors", "matrices",
                                           "strings", "objects", "lists",   "hashes"};
    const auto count = std::to_string(v.array) + " ";
    if (v.kind.type == Type::Object && v.kind.cls >= 0)
      return count + classes_[static_cast<std::size_t>(v.kind.cls)].name + " objects";
    return count + kPlural[static_cast<std::size_t>(v.kind.type)];
  }

  Choices& choose_;
  std::vector<Class> classes_;
  Writer writer_;
};

}  // namespace

std::string generate_program(Choices& choices) { return Generator(choices).program(); }

}  // namespace breve::fuzz
