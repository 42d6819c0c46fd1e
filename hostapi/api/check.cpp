// Each function is assigned to a pointer of the type that its parameters give, each field has the size of its type,
// each enumerator its number: the C compiler reads the headers by itself, and compares.
#include "check.hpp"

#include <cstddef>

namespace breve::api {

namespace {

/// "double[3]" and a name as C writes it: "double name[3]"; "void (*)(int)" likewise.
std::string declared(const std::string& type, const std::string& name) {
  if (const auto star = type.find("(*)"); star != std::string::npos)
    return type.substr(0, star + 2) + name + type.substr(star + 2);
  const auto bracket = type.find('[');
  return type.substr(0, bracket) + " " + name + (bracket == std::string::npos ? "" : type.substr(bracket));
}

std::string parameters(const Callable& one) {
  std::string text;
  for (const Parameter& parameter : one.parameters)
    text += (text.empty() ? "" : ", ") + declared(parameter.type, parameter.name);
  return text.empty() ? "void" : text;
}

void check_fields(const std::string& path, const std::vector<Parameter>& fields, std::ostream& out) {
  for (const Parameter& field : fields) {
    if (!field.members.empty()) {
      check_fields(path + field.name + ".", field.members, out);
      continue;
    }
    out << "  { " << declared(field.type, "other") << "; (void)sizeof other;\n    _Static_assert(sizeof s." << path
        << field.name << " == sizeof other && _Alignof(__typeof__(s." << path << field.name
        << ")) == _Alignof(__typeof__(other)), \"" << field.name << "\"); }\n";
  }
}

}  // namespace

void write_check(const Interface& interface, std::ostream& out) {
  out << "/* Made from the description of the headers. */\n#include <breve/analysis.h>\n#include <breve/breve.h>\n"
         "#include <breve/breve_lua.h>\n#include <breve/sound.h>\n#include <breve/view.h>\n\n";
  std::size_t number = 0;
  for (const Enumeration& one : interface.enumerations)
    for (const Value& value : one.values)
      out << "_Static_assert(" << value.name << " == " << value.value << ", \"" << value.name << "\");\n";
  for (const Callable& one : interface.callbacks) {
    out << "typedef " << one.result << " (*callback_" << number << ")(" << parameters(one) << ");\n"
        << "_Static_assert(_Generic((" << one.name << ")0, callback_" << number << ": 1, default: 0), \"" << one.name
        << "\");\n";
    ++number;
  }
  for (const Struct& one : interface.structs) {
    out << "void struct_" << number << "(void);\nvoid struct_" << number << "(void) {\n  " << one.name
        << " s;\n  (void)sizeof s;\n";
    check_fields("", one.fields, out);
    out << "}\n";
    ++number;
  }
  for (const Callable& one : interface.functions) {
    if (one.in_header) continue;
    out << "typedef " << one.result << " (*function_" << number << ")(" << parameters(one) << ");\n"
        << "_Static_assert(_Generic(&" << one.name << ", function_" << number << ": 1, default: 0), \"" << one.name
        << "\");\n";
    ++number;
  }
}

}  // namespace breve::api
