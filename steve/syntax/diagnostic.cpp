// How a diagnostic is shown: place, message, the source line with a caret under it, help.
#include "steve/syntax/diagnostic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace breve::steve {

namespace {

constexpr std::size_t kWindow = 120;       // columns of source shown at most
constexpr std::size_t kLongestName = 200;  // nearest() does not try longer ones

// One source character as it is shown: a tab, a printable character, or the escape of a byte.
struct Cell {
  std::string text;
  std::size_t width = 1;  // columns
  std::size_t begin = 0;  // first byte in the line
  std::size_t end = 0;
};

// Length of the well-formed UTF-8 sequence at `i`, or 0.
std::size_t utf8_length(std::string_view text, std::size_t i) {
  const auto lead = static_cast<unsigned char>(text[i]);
  const std::size_t length = lead >= 0xC2 && lead < 0xE0   ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || i + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((static_cast<unsigned char>(text[i + k]) & 0xC0U) != 0x80U) return 0;
  }
  // C1 control characters are well formed, and yet not printable.
  if (lead == 0xC2 && static_cast<unsigned char>(text[i + 1]) < 0xA0) return 0;
  return length;
}

Cell cell_at(std::string_view line, std::size_t i) {
  const auto byte = static_cast<unsigned char>(line[i]);
  if (byte == '\t' || (byte >= 0x20 && byte < 0x7F)) return {std::string(1, line[i]), 1, i, i + 1};
  if (const std::size_t length = utf8_length(line, i); length > 0) {
    return {std::string(line.substr(i, length)), 1, i, i + length};
  }
  return {fmt::format("\\x{:02X}", byte), 4, i, i + 1};
}

// The bytes of the line that are shown: all of it, or a window with the caret a third from the left.
std::pair<std::size_t, std::size_t> window(std::string_view line, std::size_t caret) {
  if (line.size() <= kWindow) return {0, line.size()};
  std::size_t begin = caret > kWindow / 3 ? caret - kWindow / 3 : 0;
  begin = std::min(begin, line.size() - kWindow);
  const auto inside_character = [&](std::size_t i) {
    return i < line.size() && (static_cast<unsigned char>(line[i]) & 0xC0U) == 0x80U;
  };
  for (int k = 0; k < 3 && begin > 0 && inside_character(begin); ++k) --begin;
  return {begin, std::min(begin + kWindow, line.size())};
}

// The line with its number in front and, below it, carets under what is meant.
std::string picture(std::string_view line, const Span& span) {
  const std::size_t caret = std::min<std::size_t>(span.column - 1, line.size());
  const std::size_t last = std::min(caret + std::max<std::size_t>(span.length, 1), line.size());
  const auto [begin, end] = window(line, caret);
  std::string shown = begin > 0 ? "…" : "";
  std::string marks = begin > 0 ? " " : "";
  for (std::size_t i = begin; i < end;) {
    const Cell cell = cell_at(line, i);
    shown += cell.text;
    if (cell.end <= caret) {
      marks += cell.text == "\t" ? "\t" : std::string(cell.width, ' ');
    } else if (cell.begin < std::max(last, caret + 1)) {
      marks += std::string(cell.width, '^');
    }
    i = cell.end;
  }
  if (caret >= end) marks += '^';
  if (end < line.size()) shown += "…";
  return fmt::format("{:>5} | {}\n      | {}\n", span.line, shown, marks);
}

std::string_view name_of(Severity severity) {
  switch (severity) {
    case Severity::Error: return "error";
    case Severity::Warning: return "warning";
    case Severity::Note: return "note";
  }
  return "error";
}

// Edits (insert, delete, replace, swap neighbours) that lead from a to b; more than `limit` is reported as limit + 1.
std::size_t distance(std::string_view a, std::string_view b, std::size_t limit) {
  if ((a.size() > b.size() ? a.size() - b.size() : b.size() - a.size()) > limit) return limit + 1;
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = above[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U);
      row[j] = std::min({row[j - 1] + 1, above[j] + 1, replace});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, above);
    std::swap(above, row);
  }
  return std::min(above[b.size()], limit + 1);
}

// A text that quotes something endless keeps its beginning and its end.
void shorten(std::string& text) {
  constexpr std::size_t kLongestText = 400, kKept = 180;
  if (text.size() > kLongestText) text = text.substr(0, kKept) + " ... " + text.substr(text.size() - kKept);
}

}  // namespace

void Diagnostics::error(const Span& span, std::string code, std::string message, std::string help) {
  add({Severity::Error, std::move(code), std::move(message), std::move(help), span});
}

void Diagnostics::warning(const Span& span, std::string code, std::string message, std::string help) {
  add({Severity::Warning, std::move(code), std::move(message), std::move(help), span});
}

void Diagnostics::add(Diagnostic diagnostic) {
  shorten(diagnostic.message);
  shorten(diagnostic.help);
  const bool error = diagnostic.severity == Severity::Error;
  std::size_t& count = error ? errors_ : others_;
  ++count;
  if (count > kMost + 1) return;
  if (count == kMost + 1) {
    diagnostic.message = error ? "more errors follow" : "more warnings follow";
    diagnostic.help.clear();
  }
  all_.push_back(std::move(diagnostic));
}

std::string cut(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return std::string(text);
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0U) == 0x80U) --bytes;
  return std::string(text.substr(0, bytes)) + "…";
}

std::string format(const Diagnostic& diagnostic, const Sources& sources) {
  const Span& span = diagnostic.span;
  std::string text;
  const bool placed = span.line > 0 && span.file < sources.size();
  if (placed) text = fmt::format("{}:{}:{}: ", sources.file(span.file).name, span.line, span.column);
  text += fmt::format("{}: {}", name_of(diagnostic.severity), cut(diagnostic.message, kLongestMessage));
  if (diagnostic.code.starts_with("lint-")) text += fmt::format(" [{}]", diagnostic.code);  // what turns it off
  text += '\n';
  if (placed && span.column > 0) text += picture(sources.line_text(span), span);
  if (!diagnostic.help.empty()) text += fmt::format("help: {}\n", cut(diagnostic.help, kLongestMessage));
  return text;
}

std::string nearest(std::string_view name, const std::vector<std::string_view>& candidates) {
  if (name.size() > kLongestName) return {};
  std::size_t limit = name.size() / 3;
  std::string_view best;
  for (const std::string_view candidate : candidates) {
    const std::size_t edits = distance(name, candidate, limit);
    if (edits > limit || (!best.empty() && edits == limit)) continue;
    best = candidate;
    limit = edits;
  }
  return std::string(best);
}

}  // namespace breve::steve
