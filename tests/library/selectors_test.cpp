// Every selector that the table promises exists with its keywords, types and defaults, and is documented.
#include "tests/library/parsed_library.hpp"
#include "tests/library/selector_table.hpp"

namespace breve::steve {
namespace {

std::string type_text(const ast::TypeRef& type) {
  switch (type.kind) {
    case ast::TypeKind::Int: return "int";
    case ast::TypeKind::Double: return "float";
    case ast::TypeKind::Vector: return "vector";
    case ast::TypeKind::Matrix: return "matrix";
    case ast::TypeKind::String: return "string";
    case ast::TypeKind::Object: return type.class_name.empty() ? "object" : "object(" + type.class_name + ")";
    case ast::TypeKind::List: return "list";
    case ast::TypeKind::Hash: return "hash";
    case ast::TypeKind::Pointer: return "pointer";
    case ast::TypeKind::Data: return "data";
  }
  return "?";
}

/// The numbers of a default as the table writes it, or its text.
std::vector<double> numbers_in(const std::string& text) {
  std::string plain = text;
  for (char& c : plain)
    if (c == '(' || c == ')' || c == '[' || c == ']' || c == ',') c = ' ';
  std::stringstream in(plain);
  std::vector<double> numbers;
  for (double number; in >> number;) numbers.push_back(number);
  return numbers;
}

std::vector<double> numbers_in(const ast::Constant& constant) {
  if (const auto* i = std::get_if<std::int32_t>(&constant.value)) return {static_cast<double>(*i)};
  if (const auto* d = std::get_if<double>(&constant.value)) return {*d};
  if (const auto* v = std::get_if<std::array<double, 3>>(&constant.value)) return {v->begin(), v->end()};
  if (const auto* m = std::get_if<std::array<double, 9>>(&constant.value)) return {m->begin(), m->end()};
  return {};
}

void expect_parameter(const ast::Parameter& parameter, const std::string& promised) {
  const std::size_t equals = promised.find('=');
  const std::size_t colon = promised.find(':');
  std::string type = promised.substr(colon + 1, equals - colon - 1);
  if (type == "double") type = "float";
  EXPECT_EQ(parameter.keyword, promised.substr(0, colon));
  EXPECT_EQ(type_text(parameter.type), type);
  ASSERT_EQ(parameter.default_value.has_value(), equals != std::string::npos);
  if (!parameter.default_value) return;
  const std::string value = promised.substr(equals + 1);
  if (value.starts_with('"')) {
    const auto* text = std::get_if<std::string>(&parameter.default_value->value);
    ASSERT_NE(text, nullptr);
    EXPECT_EQ('"' + *text + '"', value);
  } else {
    EXPECT_EQ(numbers_in(*parameter.default_value), numbers_in(value));
  }
}

TEST(Selectors, EveryFileOfTheLibraryParsesWithoutAWordOfComplaint) {
  const ParsedLibrary& library = ParsedLibrary::get();
  for (const Diagnostic& diagnostic : library.diagnostics.all()) ADD_FAILURE() << format(diagnostic, library.sources);
}

TEST(Selectors, EveryRowOfTheTableExistsWithItsKeywordsTypesAndDefaults) {
  const std::vector<SelectorRow> table = selector_rows(BREVE_SELECTORS);
  ASSERT_GT(table.size(), 450U);
  for (const SelectorRow& row : table) {
    SCOPED_TRACE(row.cls + " " + row.selector);
    const ast::Class* cls = ParsedLibrary::get().find(row.cls);
    ASSERT_NE(cls, nullptr);
    EXPECT_EQ(cls->alias, row.alias);
    EXPECT_EQ(cls->parent, row.parent);
    const ast::Method* found = nullptr;  // in the class, or inherited
    for (const ast::Class* owner = cls; owner && !found; owner = ParsedLibrary::get().find(owner->parent))
      for (const ast::Method& method : owner->methods)
        if (method.name == row.selector && method.parameters.size() == row.keywords.size()) found = &method;
    if (!found) {
      ADD_FAILURE() << "no such method with " << row.keywords.size() << " keywords";
      continue;
    }
    for (std::size_t i = 0; i < row.keywords.size(); ++i) expect_parameter(found->parameters[i], row.keywords[i]);
  }
}

TEST(Selectors, EveryClassAndMethodIsDocumented) {
  for (const ast::File& file : ParsedLibrary::get().files)
    for (const ast::Class& cls : file.classes) {
      EXPECT_FALSE(cls.doc.empty()) << cls.name;
      for (const ast::Method& method : cls.methods) EXPECT_FALSE(method.doc.empty()) << cls.name << " " << method.name;
    }
}

TEST(Selectors, AFileIsFoundByItsNameItsClassesAndTheirAliases) {
  for (const char* name : {"Shape.tz", "Shape", "Shapes", "Cube", "Cubes", "PolygonCones"}) {
    const LibraryFile* file = library_source().find_file(name);
    ASSERT_NE(file, nullptr) << name;
    EXPECT_EQ(file->name, "Shape.tz");
  }
  EXPECT_EQ(library_source().find_file("Floor")->name, "Stationary.tz");
  EXPECT_EQ(library_source().find_file("Tracer.tz")->name, "Drawing.tz");
  EXPECT_EQ(library_source().find_file("NoSuchClass"), nullptr);
  EXPECT_EQ(library_source().find_file(""), nullptr);
  EXPECT_EQ(library_source().find_file(".tz"), nullptr);
}

TEST(Selectors, TheTableOfFilesNamesEveryClassInThem) {
  for (const ast::File& file : ParsedLibrary::get().files)
    for (const ast::Class& cls : file.classes) {
      EXPECT_NE(library_source().find_file(cls.name), nullptr) << cls.name;
      const std::string& other = cls.alias.empty() ? cls.name : cls.alias;
      EXPECT_EQ(library_source().find_file(other), library_source().find_file(cls.name)) << other;
    }
}

TEST(Selectors, ObjectDeclaresControllerAndBirthTimeFirst) {
  const ast::Class* object = ParsedLibrary::get().find("Object");
  ASSERT_NE(object, nullptr);
  ASSERT_GE(object->variables.size(), 2U);
  EXPECT_EQ(object->variables[0].name, "controller");
  EXPECT_EQ(object->variables[1].name, "birthTime");
}

}  // namespace
}  // namespace breve::steve
