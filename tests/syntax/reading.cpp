// Trees and diagnostics as text.
#include "reading.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace breve::steve::test {

namespace {

std::string_view name(ast::BinaryOp op) {
  constexpr std::string_view kNames[] = {"+", "-", "*", "/", "%", "^", "<", "<=", ">", ">=", "==", "!=", "&&", "||"};
  return kNames[static_cast<std::size_t>(op)];
}

std::string number(double value) {
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".einf") == std::string::npos ? text + ".0" : text;
}

std::string show_all(const std::vector<ast::ExprPtr>& list) {
  std::string text;
  for (const ast::ExprPtr& each : list) text += " " + show(*each);
  return text;
}

struct ExprText {
  std::string operator()(const ast::IntLit& e) const { return fmt::format("{}", e.value); }
  std::string operator()(const ast::DoubleLit& e) const { return number(e.value); }
  std::string operator()(const ast::StringLit& e) const {
    std::string text = "\"" + e.texts.at(0) + "\"";
    for (std::size_t i = 0; i < e.parts.size(); ++i) {
      const ast::StringLit::Part& part = e.parts[i];
      text += " $" + (part.expr ? "=" + show(*part.expr) : part.name);
      if (part.index) text += fmt::format(fmt::runtime(part.array ? "[{}]" : "{{{}}}"), *part.index);
      text += " \"" + e.texts.at(i + 1) + "\"";
    }
    return e.parts.empty() ? text : "(" + text + ")";
  }
  std::string operator()(const ast::ConstantExpr& e) const {
    return fmt::format("(const {} {})", e.name, show(e.constant));
  }
  std::string operator()(const ast::VectorLit& e) const {
    return fmt::format("(vec {} {} {})", show(*e.x), show(*e.y), show(*e.z));
  }
  std::string operator()(const ast::MatrixLit& e) const {
    std::string text = "(mat";
    for (const ast::ExprPtr& each : e.elements) text += " " + show(*each);
    return text + ")";
  }
  std::string operator()(const ast::ListLit& e) const { return "(list" + show_all(e.elements) + ")"; }
  std::string operator()(const ast::Name& e) const { return e.name; }
  std::string operator()(const ast::ArrayItem& e) const { return fmt::format("(item {} {})", e.name, show(*e.index)); }
  std::string operator()(const ast::IndexExpr& e) const {
    return fmt::format("(at {} {})", show(*e.base), show(*e.index));
  }
  std::string operator()(const ast::Member& e) const { return fmt::format("(:: {} {})", show(*e.base), e.name); }
  std::string operator()(const ast::Self&) const { return "self"; }
  std::string operator()(const ast::Super&) const { return "super"; }
  std::string operator()(const ast::Call& e) const {
    std::string text = fmt::format("(call {} {}", show(*e.receiver), e.selector);
    for (const ast::Keyword& keyword : e.keywords) text += fmt::format(" {}:{}", keyword.name, show(*keyword.value));
    return text + ")";
  }
  std::string operator()(const ast::FunctionCall& e) const { return "(fn " + e.name + show_all(e.arguments) + ")"; }
  std::string operator()(const ast::RandomExpr& e) const { return fmt::format("(random {})", show(*e.bound)); }
  std::string operator()(const ast::NewExpr& e) const {
    return e.count ? fmt::format("(new {} {})", e.class_name, show(*e.count)) : fmt::format("(new {})", e.class_name);
  }
  std::string operator()(const ast::AllExpr& e) const { return fmt::format("(all {})", e.class_name); }
  std::string operator()(const ast::Unary& e) const {
    return fmt::format("({} {})", e.op == ast::UnaryOp::Not ? "!" : "neg", show(*e.operand));
  }
  std::string operator()(const ast::Chain& e) const {
    std::string text = "(" + show(*e.first);
    for (const auto& [op, operand] : e.rest) text += fmt::format(" {} {}", name(op), show(*operand));
    return text + ")";
  }
  std::string operator()(const ast::Magnitude& e) const { return fmt::format("(mag {})", show(*e.operand)); }
  std::string operator()(const ast::Assign& e) const {
    const std::string op = e.op ? std::string(name(*e.op)) + "=" : e.value_is_bare_call ? "=call" : "=";
    return fmt::format("({} {} {})", op, show(*e.target), show(*e.value));
  }
  std::string operator()(const ast::Step& e) const {
    return fmt::format("({} {})", e.delta > 0 ? "++" : "--", show(*e.target));
  }
  std::string operator()(const ast::Push& e) const {
    return fmt::format("({} {} {})", e.front ? "prepend" : "push", show(*e.value), show(*e.list));
  }
  std::string operator()(const ast::Pop& e) const {
    return fmt::format("({} {})", e.front ? "unprepend" : "pop", show(*e.list));
  }
  std::string operator()(const ast::Insert& e) const {
    return fmt::format("(insert {} {} {})", show(*e.value), show(*e.list), show(*e.index));
  }
  std::string operator()(const ast::Remove& e) const {
    return fmt::format("(remove {} {})", show(*e.base), show(*e.index));
  }
  std::string operator()(const ast::CopyList& e) const { return fmt::format("(copylist {})", show(*e.list)); }
  std::string operator()(const ast::Sort& e) const { return fmt::format("(sort {} {})", show(*e.list), e.selector); }
};

struct StmtText {
  std::string operator()(const ast::Block& s) const {
    std::string text = "{";
    for (const ast::StmtPtr& each : s.body) text += (text.size() > 1 ? " " : "") + show(*each);
    return text + "}";
  }
  std::string operator()(const ast::If& s) const {
    std::string text = "(if";
    for (const auto& [condition, then] : s.branches) text += fmt::format(" {} {}", show(*condition), show(*then));
    return text + (s.otherwise ? " else " + show(*s.otherwise) : "") + ")";
  }
  std::string operator()(const ast::While& s) const {
    return fmt::format("(while {} {})", show(*s.condition), show(*s.body));
  }
  std::string operator()(const ast::For& s) const {
    return fmt::format("(for {} {} {} {})", show(*s.start), show(*s.condition), show(*s.step), show(*s.body));
  }
  std::string operator()(const ast::Foreach& s) const {
    return fmt::format("(foreach {} {} {})", s.variable, show(*s.list), show(*s.body));
  }
  std::string operator()(const ast::ExprStmt& s) const { return show(*s.expr) + "."; }
  std::string operator()(const ast::Print& s) const {
    return (s.newline ? "(print" : "(printf") + show_all(s.items) + ")";
  }
  std::string operator()(const ast::Return& s) const {
    return s.value ? "(return " + show(*s.value) + ")" : "(return)";
  }
  std::string operator()(const ast::Free& s) const { return "(free " + show(*s.value) + ")"; }
  std::string operator()(const ast::Die& s) const { return "(die " + show(*s.value) + ")"; }
};

struct ConstantText {
  std::string operator()(std::int32_t value) const { return fmt::format("{}", value); }
  std::string operator()(double value) const { return number(value); }
  std::string operator()(const std::string& value) const { return "\"" + value + "\""; }
  template <std::size_t N>
  std::string operator()(const std::array<double, N>& value) const {
    return fmt::format("({})", fmt::join(value, " "));
  }
};

constexpr std::string_view kBefore = "NULL : Test { + to run: ";
constexpr std::string_view kAfter = "\n}\n";

// A body as line 1, column 1 of its file would need a header before it: the header is put on the line above instead.
Reading read_body(std::string_view text) { return Reading(fmt::format("{}\n{}{}", kBefore, text, kAfter)); }

std::string shift_lines(const Reading& reading, Severity severity) {
  std::string text;
  for (const Diagnostic& diagnostic : reading.diagnostics.all()) {
    if (diagnostic.severity != severity) continue;
    text += fmt::format("{}{}:{} {}", text.empty() ? "" : ", ", diagnostic.span.line - 1, diagnostic.span.column,
                        diagnostic.code);
  }
  return text;
}

}  // namespace

std::string show(const ast::Expr& expr) { return std::visit(ExprText{}, expr.node); }
std::string show(const ast::Stmt& stmt) { return std::visit(StmtText{}, stmt.node); }
std::string show(const ast::Constant& constant) { return std::visit(ConstantText{}, constant.value); }

std::string show(const ast::TypeRef& type) {
  constexpr std::string_view kNames[] = {"int",    "double", "vector", "matrix",  "string",
                                         "object", "list",   "hash",   "pointer", "data"};
  std::string text(kNames[static_cast<std::size_t>(type.kind)]);
  if (!type.class_name.empty()) text = type.class_name + " " + text;
  return type.array_size >= 0 ? fmt::format("{} {}", type.array_size, text) : text;
}

Reading::Reading(std::string text, bool embedded) {
  const std::uint32_t index = sources.add("test.tz", std::move(text), embedded);
  tokens = lex(sources, index, diagnostics);
  file = parse(tokens, defines, diagnostics, sources, embedded);
}

std::string Reading::places(Severity severity) const {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    if (diagnostic.severity != severity) continue;
    text += fmt::format("{}{}:{} {}", text.empty() ? "" : ", ", diagnostic.span.line, diagnostic.span.column,
                        diagnostic.code);
  }
  return text;
}

std::string statements(std::string_view text) {
  const Reading reading = read_body(text);
  if (reading.diagnostics.error_count() > 0) return "error " + shift_lines(reading, Severity::Error);
  std::string result;
  for (const ast::StmtPtr& each : reading.method().body) result += (result.empty() ? "" : " ") + show(*each);
  return result;
}

std::string expression(std::string_view text) {
  const std::string result = statements(fmt::format("return {}.", text));
  constexpr std::string_view kStart = "(return ";
  if (!result.starts_with(kStart)) return result;
  return result.substr(kStart.size(), result.size() - kStart.size() - 1);
}

std::string body_errors(std::string_view text) { return shift_lines(read_body(text), Severity::Error); }
std::string body_warnings(std::string_view text) { return shift_lines(read_body(text), Severity::Warning); }

}  // namespace breve::steve::test
