// The class library documents itself: its reference is made of these comments.
#include <gtest/gtest.h>

#include "steve/library/library.hpp"
#include "steve/syntax/parser.hpp"

namespace breve::steve {
namespace {

TEST(ClassLibrary, EveryClassAndMethodHasAComment) {
  Sources sources;
  Diagnostics diagnostics;
  Defines defines;
  std::size_t classes = 0, methods = 0;
  for (const LibraryFile& file : library_files()) {
    const std::uint32_t number = sources.add(std::string(file.name), std::string(file.text), true);
    const ast::File tree = parse(lex(sources, number, diagnostics), defines, diagnostics, sources, true);
    for (const ast::Class& cls : tree.classes) {
      ++classes;
      EXPECT_FALSE(cls.doc.empty()) << file.name << ": class " << cls.name;
      for (const ast::Method& method : cls.methods) {
        ++methods;
        const std::string where = std::string(file.name) + ":" + std::to_string(method.name_span.line);
        EXPECT_GT(method.doc.size(), 8U) << where << ": method " << method.name << " of " << cls.name;
        // A sentence, so that an index can show it: it begins with a capital, a number or `code`, and ends somewhere.
        const char first = method.doc.empty() ? ' ' : method.doc.front();
        EXPECT_FALSE(first >= 'a' && first <= 'z') << where << ": " << method.doc;
        EXPECT_NE(method.doc.find_last_of(".:"), std::string::npos) << where << ": " << method.doc;
      }
    }
  }
  EXPECT_GT(classes, 25U);
  EXPECT_GT(methods, 400U);
}

}  // namespace
}  // namespace breve::steve
