// A walk over the trees that notes each name, what kind of thing it names there, and what is known of the receiver.
#include "steve/analysis/uses.hpp"

#include <algorithm>

#include "steve/analysis/types.hpp"
#include "steve/compile/function_compiler.hpp"
#include "steve/syntax/words.hpp"

namespace breve::steve {

namespace {

class UseFinder {
 public:
  explicit UseFinder(const Model& model) : model_(model) {}

  std::vector<Use> find() {
    for (std::uint32_t i = 0; i < model_.files.size(); ++i)
      for (const ast::Directive& directive : model_.files[i].tree.directives) this->directive(i, directive);
    for (std::size_t i = 0; i < model_.symbols.size(); ++i) declaration(i);
    for (std::size_t i = 0; i < model_.classes.size(); ++i) class_(i);
    std::stable_sort(uses_.begin(), uses_.end(), [](const Use& a, const Use& b) {
      return a.span.file != b.span.file ? a.span.file < b.span.file : a.span.offset < b.span.offset;
    });
    return std::move(uses_);
  }

 private:
  Use& add(NameKind kind, const Span& span, std::string_view name, std::size_t symbol) {
    Use& use = uses_.emplace_back();
    use.kind = kind;
    use.span = span;
    use.span.length = static_cast<std::uint32_t>(name.size());
    use.name = name;
    use.symbol = symbol;
    if (symbol != kNoIndex) use.type = model_.symbols[symbol].type;
    return use;
  }

  void class_name(const Span& span, std::string_view name) {
    const std::size_t cls = model_.class_named(name);
    add(NameKind::Class, span, name, cls == kNoIndex ? kNoIndex : model_.classes[cls].symbol);
  }

  const Token* token_in(const Span& span, std::string_view text) const {
    const std::vector<Token>& tokens = model_.files[span.file].tokens;
    auto at = std::lower_bound(tokens.begin(), tokens.end(), span.offset,
                               [](const Token& token, std::uint32_t offset) { return token.span.offset < offset; });
    for (; at != tokens.end() && at->span.offset < span.offset + span.length; ++at)
      if (at->text == text && (at->kind == TokenKind::Name || at->kind == TokenKind::String)) return &*at;
    return nullptr;
  }

  void type_class(const ast::TypeRef& type) {
    if (type.class_name.empty() || type.span.line == 0) return;
    if (const Token* token = token_in(type.span, type.class_name)) class_name(token->span, token->text);
  }

  void directive(std::uint32_t file, const ast::Directive& tree) {
    using enum ast::Directive::Kind;
    if (tree.kind != Use && tree.kind != Include && tree.kind != Controller) return;
    const Token* const token = token_in(tree.span, tree.text);
    if (token == nullptr || tree.text.empty()) return;
    if (tree.kind == Controller) return class_name(token->span, token->text);
    Span span = token->span;
    if (token->kind == TokenKind::String) ++span.offset, ++span.column;
    add(NameKind::Module, span, token->text, module_named(tree.text + (tree.kind == Use ? ".tz" : ""), file));
  }

  // The file that ends with that path; of the class library only if the program has none.
  std::size_t module_named(const std::string& name, std::uint32_t from) const {
    std::size_t best = kNoIndex;
    for (std::uint32_t i = 0; i < model_.files.size(); ++i) {
      const std::string_view file = model_.sources.file(i).name;
      if (i == from || !file.ends_with(name)) continue;
      const bool whole = file.size() == name.size() ||
                         std::string_view("/:").find(file[file.size() - name.size() - 1]) != std::string_view::npos;
      if (whole && (best == kNoIndex || !model_.sources.file(i).embedded)) best = model_.files[i].symbol;
    }
    if (best != kNoIndex || !name.ends_with(".tz")) return best;
    const std::size_t cls = model_.class_named(std::string_view(name).substr(0, name.size() - 3));
    return cls == kNoIndex ? kNoIndex : model_.symbols[model_.classes[cls].symbol].parent;
  }

  void declaration(std::size_t number) {
    const SymbolInfo& symbol = model_.symbols[number];
    if (symbol.kind == NameKind::Module || symbol.name_span.line == 0) return;
    add(symbol.kind, symbol.name_span, symbol.name, number).declaration = true;
  }

  void class_(std::size_t number) {
    const ClassModel& cls = model_.classes[number];
    const ast::Class& tree = *cls.tree;
    if (tree.parent != "NULL") class_name(tree.parent_span, tree.parent);
    if (!tree.alias.empty()) add(NameKind::Class, tree.alias_span, tree.alias, cls.symbol).declaration = true;
    const ast::TypeRef* last = nullptr;
    for (const ast::Variable& v : tree.variables) type_once(v.type, last);
    for (const MethodModel& method : cls.methods) {
      scope_ = {number, &method};
      for (const ast::Parameter& p : method.tree->parameters) type_class(p.type);
      for (const ast::Variable& v : method.tree->locals) type_once(v.type, last);
      for (const ast::StmtPtr& statement : method.tree->body) body(*statement);
    }
  }

  // Several variables share the type behind them.
  void type_once(const ast::TypeRef& type, const ast::TypeRef*& last) {
    if (last == nullptr || last->span.offset != type.span.offset || last->span.file != type.span.file) type_class(type);
    last = &type;
  }

  void body(const ast::Stmt& statement) {
    walk_statements(statement, [&](const ast::Stmt& s) {
      if (const auto* loop = std::get_if<ast::Foreach>(&s.node)) variable(loop->variable_span, loop->variable);
    });
    walk(statement, [&](const ast::Expr& e) { expression(e); });
  }

  void variable(const Span& span, std::string_view name) {
    const std::size_t symbol = model_.find_variable(scope_.cls, scope_.method, name);
    const NameKind kind = symbol == kNoIndex ? NameKind::Variable : model_.symbols[symbol].kind;
    Use& use = add(kind, span, name, symbol);
    if (symbol != kNoIndex && model_.types[symbol].kind == ast::TypeKind::Object)
      use.type = type_name(model_, model_.types[symbol]);
  }

  void expression(const ast::Expr& e) {
    if (const auto* name = std::get_if<ast::Name>(&e.node)) return variable(e.span, name->name);
    if (const auto* item = std::get_if<ast::ArrayItem>(&e.node)) return variable(e.span, item->name);
    if (const auto* constant = std::get_if<ast::ConstantExpr>(&e.node)) {
      const auto known = model_.constants.find(constant->name);
      add(NameKind::Constant, e.span, constant->name, known == model_.constants.end() ? kNoIndex : known->second);
    }
    if (const auto* text = std::get_if<ast::StringLit>(&e.node)) string(*text);
    if (const auto* member = std::get_if<ast::Member>(&e.node)) this->member(e, *member);
    if (const auto* call = std::get_if<ast::Call>(&e.node)) this->call(*call);
    if (const auto* function = std::get_if<ast::FunctionCall>(&e.node)) this->function(e, *function);
    if (const auto* made = std::get_if<ast::NewExpr>(&e.node)) class_named(made->class_span, made->class_name);
    if (const auto* all = std::get_if<ast::AllExpr>(&e.node)) class_named(all->class_span, all->class_name);
    if (const auto* sort = std::get_if<ast::Sort>(&e.node)) {
      Use& use = add(NameKind::Method, sort->selector_span, sort->selector, kNoIndex);
      receiver(use, {ast::TypeKind::Object, scope_.cls});
    }
  }

  // The name may be written as a string.
  void class_named(Span span, std::string_view name) {
    if (span.length > name.size()) ++span.offset, ++span.column;
    class_name(span, name);
  }

  void receiver(Use& use, const KnownType& type) {
    use.receiver = type;
    if (type.kind == ast::TypeKind::Object && type.cls != kNoIndex) use.type = type_name(model_, type);
  }

  // `$name`, `${name}`: the name stands one or two bytes behind the dollar.
  void string(const ast::StringLit& text) {
    for (const ast::StringLit::Part& part : text.parts) {
      if (part.expr != nullptr || part.name == "self") continue;
      Span span = part.span;
      const std::uint32_t skip = model_.sources.file(span.file).text[span.offset + 1] == '{' ? 2 : 1;
      span.offset += skip;
      span.column += skip;
      variable(span, part.name);
    }
  }

  // The name is the last word of the expression.
  void member(const ast::Expr& e, const ast::Member& member) {
    const KnownType base = type_of(model_, scope_, *member.base);
    if (member.letter != 0 && base.kind != ast::TypeKind::Object) return;
    Span span = e.span;
    const auto length = static_cast<std::uint32_t>(member.name.size());
    if (e.parenthesised || span.length < length) return;
    span = model_.sources.span_at(span.file, span.offset + span.length - length, length);
    const std::size_t symbol =
        base.kind == ast::TypeKind::Object ? model_.find_member(base.cls, member.name) : kNoIndex;
    add(NameKind::Variable, span, member.name, symbol);
  }

  void call(const ast::Call& call) {
    const KnownType type = type_of(model_, scope_, *call.receiver);
    const std::vector<std::string_view> keywords = keywords_of(call);
    Use& use = add(NameKind::Method, call.selector_span, call.selector, kNoIndex);
    receiver(use, type);
    use.keywords = keywords;
    for (const ast::Keyword& keyword : call.keywords) {
      Use& one = add(NameKind::Keyword, keyword.span, keyword.name, kNoIndex);
      receiver(one, type);
      one.selector = call.selector;
      one.keywords = keywords;
    }
  }

  void function(const ast::Expr& e, const ast::FunctionCall& function) {
    const auto [first, last] = model_.functions.equal_range(function.name);
    const auto letters = function.arguments.size();
    std::size_t symbol = first == last ? kNoIndex : first->second;
    for (auto at = first; at != last; ++at) {
      const std::string& signature = model_.symbols[at->second].signature;
      const auto commas = static_cast<std::size_t>(std::count(signature.begin(), signature.end(), ','));
      if (letters > 0 && commas + 1 == letters) symbol = at->second;
    }
    add(NameKind::Function, e.span, function.name, symbol);
  }

  const Model& model_;
  Scope scope_;
  std::vector<Use> uses_;
};

}  // namespace

std::vector<Use> find_uses(const Model& model) { return UseFinder(model).find(); }

Scope scope_at(const Model& model, std::uint32_t file, std::uint32_t offset) {
  Scope scope;
  for (std::size_t i = 0; i < model.classes.size(); ++i) {
    const Span& span = model.classes[i].tree->span;
    if (span.file != file || span.line == 0 || span.offset > offset) continue;
    const std::uint32_t end = span.offset + span.length;
    const std::string& text = model.sources.file(file).text;
    const bool closed = end > 0 && end <= text.size() && text[end - 1] == '}';
    if (!closed || offset < end) scope.cls = i;
    if (closed && offset >= end) scope.cls = kNoIndex;
  }
  if (scope.cls == kNoIndex) return scope;
  for (const MethodModel& method : model.classes[scope.cls].methods)
    if (method.tree->span.offset <= offset) scope.method = &method;
  return scope;
}

Use guess_use(const Model& model, const Token& token) {
  Use use;
  use.span = token.span;
  use.name = token.text;
  const Scope scope = scope_at(model, token.span.file, token.span.offset);
  const Word word = word_of(token.text);
  if (word != Word::None) {
    const bool type = word >= Word::Int && word <= Word::Hashes;
    const bool directive = word >= Word::Use && word <= Word::NibFile;
    use.kind = type ? NameKind::Type : directive || word == Word::Define ? NameKind::Directive : NameKind::Word;
    return use;
  }
  if (const std::size_t symbol = model.find_variable(scope.cls, scope.method, token.text); symbol != kNoIndex) {
    use.kind = model.symbols[symbol].kind;
    use.symbol = symbol;
    use.type = model.symbols[symbol].type;
  } else if (const std::size_t cls = model.class_named(token.text); cls != kNoIndex) {
    use.kind = NameKind::Class;
    use.symbol = model.classes[cls].symbol;
  } else if (const auto constant = model.constants.find(token.text); constant != model.constants.end()) {
    use.kind = NameKind::Constant;
    use.symbol = constant->second;
  } else if (model.selectors.find(token.text) != model.selectors.end()) {
    use.kind = NameKind::Method;
  } else if (const auto function = model.functions.find(token.text); function != model.functions.end()) {
    use.kind = NameKind::Function;
    use.symbol = function->second;
  }
  return use;
}

}  // namespace breve::steve
