// The list of symbols: modules, each followed by what it declares in the order of its text, and last the functions.
#include <algorithm>

#include "steve/analysis/model.hpp"
#include "steve/analysis/signatures.hpp"
#include "steve/machine/native.hpp"

namespace breve::steve {

namespace {

class SymbolMaker {
 public:
  explicit SymbolMaker(Model& model) : model_(model) {}

  void make() {
    for (std::uint32_t file = 0; file < model_.files.size(); ++file) module(file);
    for (const Native& native : functions()) {
      const FunctionNote* note = function_note(native.name, native.signature.find(':'));
      function(native.name, native.signature, note, note ? note->note : "");
    }
    for (const auto& foreign : model_.foreign) function(foreign->name(), foreign->signature(), nullptr, foreign->doc());
    for (ClassModel& cls : model_.classes) {
      const std::size_t parent = model_.class_named(cls.tree->parent);
      if (parent != kNoIndex && &model_.classes[parent] != &cls) cls.parent = parent;
    }
    model_.controller = model_.class_named(controller_);
  }

 private:
  SymbolInfo& add(NameKind kind, const std::string& name, std::size_t parent, const Span& name_span, const Span& span) {
    SymbolInfo& symbol = model_.symbols.emplace_back();
    model_.types.emplace_back();
    symbol.kind = kind;
    symbol.name = name;
    symbol.parent = parent;
    symbol.name_span = name_span;
    symbol.span = span;
    symbol.library = library_;
    symbol.loaded = loaded_;
    symbol.owner = owner_;
    return symbol;
  }
  std::size_t last() const { return model_.symbols.size() - 1; }

  void module(std::uint32_t number) {
    FileModel& file = model_.files[number];
    const SourceFile& source = model_.sources.file(number);
    library_ = source.embedded;
    loaded_ = file.loaded;
    owner_.clear();
    const Span all = model_.sources.span_at(number, 0, static_cast<std::uint32_t>(source.text.size()));
    SymbolInfo& symbol = add(NameKind::Module, source.name, kNoIndex, model_.sources.span_at(number, 0, 0), all);
    symbol.signature = source.name;
    symbol.doc = file.tree.doc;
    file.symbol = last();
    std::vector<std::pair<std::string_view, const ast::Constant*>> constants;
    for (const auto& [name, constant] : model_.defines.seen())
      if (constant.span.file == number) constants.emplace_back(name, &constant);
    std::sort(constants.begin(), constants.end(),
              [](const auto& a, const auto& b) { return a.second->span.offset < b.second->span.offset; });
    auto next = constants.begin();
    for (const ast::Class& cls : file.tree.classes) {
      for (; next != constants.end() && next->second->span.offset < cls.span.offset; ++next)
        constant(file, *next->second, std::string(next->first));
      class_(cls, file.symbol);
    }
    for (; next != constants.end(); ++next) constant(file, *next->second, std::string(next->first));
    if (!file.loaded) return;
    for (const ast::Directive& directive : file.tree.directives)
      if (directive.kind == ast::Directive::Kind::Controller) controller_ = directive.text;
  }

  // The tokens from the '@' to the period around the constant's name.
  void constant(const FileModel& file, const ast::Constant& value, const std::string& name) {
    const auto at = std::find_if(file.tokens.begin(), file.tokens.end(), [&](const Token& token) {
      return token.kind == TokenKind::Name && token.span.offset == value.span.offset;
    });
    if (at == file.tokens.end() || at - file.tokens.begin() < 2) return;
    auto period = at;
    while (period->kind != TokenKind::End && !(period->kind == TokenKind::Punctuation && period->text == ".")) ++period;
    const Token& first = *(at - 2);
    Span whole = first.span;
    whole.length = period->span.offset + period->span.length - whole.offset;
    SymbolInfo& symbol = add(NameKind::Constant, name, file.symbol, at->span, whole);
    Span literal = (at + 1)->span;
    literal.length = period->span.offset - std::min(period->span.offset, literal.offset);
    symbol.value = text_of(model_.sources, literal);
    symbol.signature = "@define " + name + ' ' + symbol.value;
    symbol.doc = comment_behind(model_.sources, whole.file, whole.offset + whole.length);
    model_.constants.emplace(name, last());
  }

  void class_(const ast::Class& tree, std::size_t module) {
    owner_.clear();
    SymbolInfo& symbol = add(NameKind::Class, tree.name, module, tree.name_span, tree.span);
    symbol.signature = signature_of(tree);
    symbol.doc = tree.doc;
    symbol.alias = tree.alias;
    if (tree.parent != "NULL") symbol.parent_class = tree.parent;
    const std::size_t number = model_.classes.size();
    ClassModel& cls = model_.classes.emplace_back();
    cls.tree = &tree;
    cls.symbol = last();
    cls.loaded = loaded_;
    model_.class_names.emplace(tree.name, number);
    if (!tree.alias.empty()) model_.class_names.emplace(tree.alias, number);
    owner_ = tree.name;
    cls.variables = model_.symbols.size();
    for (const ast::Variable& v : tree.variables) variable(NameKind::Variable, v, cls.symbol);
    for (const ast::Method& m : tree.methods) {
      model_.selectors.emplace(m.name, MethodIndex{number, cls.methods.size()});
      cls.methods.push_back(method(m, cls.symbol));
    }
    owner_.clear();
  }

  void variable(NameKind kind, const ast::Variable& tree, std::size_t parent) {
    Span whole = tree.span;
    if (tree.type.span.line != 0 && tree.type.span.offset > whole.offset)
      whole.length = tree.type.span.offset + tree.type.span.length - whole.offset;
    SymbolInfo& symbol = add(kind, tree.name, parent, tree.span, whole);
    symbol.type = type_text(model_.sources, tree.type);
    symbol.signature = tree.name + " (" + symbol.type + ')';
    symbol.doc = comment_behind(model_.sources, whole.file, whole.offset + whole.length);
    model_.types.back() = {tree.type.kind, kNoIndex};
  }

  MethodModel method(const ast::Method& tree, std::size_t cls) {
    MethodModel result;
    result.tree = &tree;
    result.symbol = model_.symbols.size();
    SymbolInfo& symbol = add(NameKind::Method, tree.name, cls, tree.name_span, tree.span);
    symbol.signature = signature_of(model_.sources, tree);
    symbol.doc = tree.doc;
    symbol.hidden = !tree.is_public;
    if (tree.native_result) symbol.type = type_text(model_.sources, *tree.native_result);
    if (tree.native_dynamic) symbol.type = "any";
    result.parameters = model_.symbols.size();
    for (const ast::Parameter& p : tree.parameters) parameter(p, result.symbol);
    result.locals = model_.symbols.size();
    for (const ast::Variable& v : tree.locals) variable(NameKind::Local, v, result.symbol);
    return result;
  }

  void parameter(const ast::Parameter& tree, std::size_t method) {
    Span whole = tree.keyword_span;
    const Span& end = tree.type.span.line != 0 ? tree.type.span : tree.variable_span;
    whole.length = end.offset + end.length - whole.offset;
    for (const NameKind kind : {NameKind::Keyword, NameKind::Parameter}) {
      const bool keyword = kind == NameKind::Keyword;
      SymbolInfo& symbol = add(kind, keyword ? tree.keyword : tree.variable, method,
                               keyword ? tree.keyword_span : tree.variable_span, whole);
      symbol.type = type_text(model_.sources, tree.type);
      symbol.signature = keyword ? signature_of(model_.sources, tree) : tree.variable + " (" + symbol.type + ')';
      if (tree.default_value) symbol.value = text_of(model_.sources, tree.default_value->span);
      model_.types.back() = {tree.type.kind, kNoIndex};
    }
  }

  void function(std::string_view name, std::string_view letters, const FunctionNote* note, std::string_view doc) {
    library_ = loaded_ = true;
    owner_.clear();
    SymbolInfo& symbol = add(NameKind::Function, std::string(name), kNoIndex, {}, {});
    symbol.signature = function_signature(name, letters, note);
    symbol.type = type_of_letter(letters.back());
    symbol.doc = doc;
    model_.functions.emplace(symbol.name, last());
  }

  Model& model_;
  bool library_ = false, loaded_ = false;
  std::string owner_, controller_;
};

}  // namespace

void make_symbols(Model& model) { SymbolMaker(model).make(); }

}  // namespace breve::steve
