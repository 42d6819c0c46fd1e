// Source files and places in them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace breve::steve {

/// A place in a source file: line and column count from 1; columns are bytes.
struct Span {
  std::uint32_t file = 0;    // index into Sources
  std::uint32_t offset = 0;  // of the first byte
  std::uint32_t length = 0;
  std::uint32_t line = 0;  // 0: no place
  std::uint32_t column = 0;
};

struct SourceFile {
  std::string name;  // as messages show it
  std::string text;
  bool embedded = false;             // part of the class library that lives in this library
  std::vector<std::uint32_t> lines;  // offset of each line's first byte
};

/// All files of one program. Indices stay valid.
class Sources {
 public:
  std::uint32_t add(std::string name, std::string text, bool embedded = false);
  const SourceFile& file(std::uint32_t index) const { return files_[index]; }
  std::size_t size() const { return files_.size(); }
  /// The text of the line of `span`, without its line end.
  std::string_view line_text(const Span& span) const;

 private:
  std::vector<SourceFile> files_;
};

}  // namespace breve::steve
