// The class library and the functions of the language, as the compiler gets them from whoever calls it: it knows
// neither by itself.
#pragma once

#include <span>
#include <string_view>

#include "steve/code/native.hpp"

namespace breve::steve {

/// A file of the class library.
struct LibraryFile {
  std::string_view name;  // "Shape.tz"
  std::string_view text;
  std::string_view classes;  // names and aliases defined in it, space-separated
  bool defines(std::string_view name_or_alias) const;
};

class LibrarySource {
 public:
  std::span<const LibraryFile> files;
  std::span<const Native> natives;    // methods of the library's classes
  std::span<const Native> functions;  // that scripts may call

  /// The file named "NAME.tz", or the one that defines class NAME. Null if there is none.
  const LibraryFile* find_file(std::string_view name) const;
};

}  // namespace breve::steve
