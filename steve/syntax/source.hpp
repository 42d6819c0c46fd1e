// Source files and places in them.
#pragma once

#include <cstdint>
#include <memory>
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

/// All files of one program. Indices, and references to a file and its text, stay valid; copies share the files.
class Sources {
 public:
  /// @throws std::length_error if the text has 4 GiB or more
  std::uint32_t add(std::string name, std::string text, bool embedded = false);
  const SourceFile& file(std::uint32_t index) const { return *files_[index]; }
  /// Forget the files behind the first `count`.
  void truncate(std::size_t count) { files_.resize(count); }
  std::size_t size() const { return files_.size(); }
  /// The text of the line of `span`, without its line end.
  std::string_view line_text(const Span& span) const;
  /// The place of `length` bytes at `offset`, with line and column worked out.
  Span span_at(std::uint32_t file, std::uint32_t offset, std::uint32_t length) const;

 private:
  std::vector<std::shared_ptr<const SourceFile>> files_;
};

}  // namespace breve::steve
