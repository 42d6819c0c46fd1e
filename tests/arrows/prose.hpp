// The prose of a file: the paragraphs of a page, the comments of a source, and the texts that it prints.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace breve::house {

/// Text that is read in one piece. Lines are joined with blanks; `starts` maps offsets in `text` to lines of the file.
struct Paragraph {
  std::string text;
  std::vector<std::pair<std::size_t, std::size_t>> starts;

  void add(std::size_t line, const std::string& words);
  std::size_t line_of(std::size_t offset) const;
};

/// Empty for a kind of file that has no prose.
std::vector<Paragraph> prose_of(const std::filesystem::path& file);

}  // namespace breve::house
