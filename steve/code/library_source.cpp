// Finding a file of the class library by its name or by a class in it.
#include "steve/code/library_source.hpp"

#include <algorithm>

namespace breve::steve {

bool LibraryFile::defines(std::string_view word) const {
  for (std::string_view rest = classes; !rest.empty();) {
    const std::size_t space = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, space) == word) return true;
    rest.remove_prefix(std::min(space + 1, rest.size()));
  }
  return false;
}

const LibraryFile* LibrarySource::find_file(std::string_view name) const {
  std::string_view stem = name;
  if (stem.ends_with(".tz")) stem.remove_suffix(3);
  if (stem.empty()) return nullptr;
  for (const LibraryFile& file : files)
    if (file.name.substr(0, file.name.size() - 3) == stem) return &file;
  for (const LibraryFile& file : files)
    if (file.defines(stem)) return &file;
  return nullptr;
}

}  // namespace breve::steve
