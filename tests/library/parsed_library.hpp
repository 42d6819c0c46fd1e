// The embedded class library as the parser sees it, for the tests of this folder.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "steve/library/library.hpp"
#include "steve/syntax/parser.hpp"

namespace breve::steve {

struct ParsedLibrary {
  Sources sources;
  std::vector<ast::File> files;  // in the order of library_files()
  Diagnostics diagnostics;

  ParsedLibrary() {
    Defines defines;
    for (const LibraryFile& file : library_files()) {
      const std::uint32_t index = sources.add(std::string(file.name), std::string(file.text), true);
      const std::vector<Token> tokens = lex(sources, index, diagnostics);
      files.push_back(parse(tokens, defines, diagnostics, sources, true));
    }
  }

  const ast::Class* find(const std::string& name) const {
    for (const ast::File& file : files)
      for (const ast::Class& cls : file.classes)
        if (cls.name == name) return &cls;
    return nullptr;
  }

  static const ParsedLibrary& get() {
    static const ParsedLibrary parsed;
    return parsed;
  }
};

}  // namespace breve::steve
