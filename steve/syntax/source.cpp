// Source files and places in them: where lines begin, and what a line holds.
#include "steve/syntax/source.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace breve::steve {

namespace {

// LF, CR and CRLF each end a line.
std::vector<std::uint32_t> line_starts(std::string_view text) {
  std::vector<std::uint32_t> lines{0};
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool lone_return = text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n');
    if (text[i] == '\n' || lone_return) lines.push_back(static_cast<std::uint32_t>(i + 1));
  }
  return lines;
}

}  // namespace

std::uint32_t Sources::add(std::string name, std::string text, bool embedded) {
  if (text.size() >= std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("source file too large: " + name);
  auto file = std::make_shared<SourceFile>();
  file->name = std::move(name);
  file->text = std::move(text);
  file->embedded = embedded;
  file->lines = line_starts(file->text);
  files_.push_back(std::move(file));
  return static_cast<std::uint32_t>(files_.size() - 1);
}

std::string_view Sources::line_text(const Span& span) const {
  if (span.file >= files_.size()) return {};
  const SourceFile& source = *files_[span.file];
  if (span.line == 0 || span.line > source.lines.size()) return {};
  const std::size_t begin = source.lines[span.line - 1];
  std::size_t end = span.line < source.lines.size() ? source.lines[span.line] : source.text.size();
  while (end > begin && (source.text[end - 1] == '\n' || source.text[end - 1] == '\r')) --end;
  return std::string_view(source.text).substr(begin, end - begin);
}

Span Sources::span_at(std::uint32_t file, std::uint32_t offset, std::uint32_t length) const {
  const std::vector<std::uint32_t>& lines = files_[file]->lines;
  const auto next = std::upper_bound(lines.begin(), lines.end(), offset);
  const auto line = static_cast<std::uint32_t>(next - lines.begin());
  return Span{file, offset, length, line, offset - lines[line - 1] + 1};
}

}  // namespace breve::steve
