// UTF-8 to UTF-16 and back, counted, never converted.
#include "lsp_text.hpp"

#include <algorithm>

namespace breve::command {

namespace {

struct Character {
  std::size_t bytes, units;
};

/// The character that begins at byte `i`. A byte that is not UTF-8 counts as one unit.
Character character_at(std::string_view text, std::size_t i) {
  const auto lead = static_cast<unsigned char>(text[i]);
  const std::size_t bytes = lead < 0xC0 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : lead < 0xF8 ? 4 : 1;
  if (bytes == 1 || i + bytes > text.size()) return {1, 1};
  for (std::size_t k = 1; k < bytes; ++k)
    if ((static_cast<unsigned char>(text[i + k]) & 0xC0U) != 0x80U) return {1, 1};
  return {bytes, bytes == 4 ? 2U : 1U};
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

bool stands_for_itself(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("-._~/").find(c) != std::string_view::npos;
}

}  // namespace

std::vector<std::size_t> line_starts(std::string_view text) {
  std::vector<std::size_t> starts{0};
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n' || (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n'))) starts.push_back(i + 1);
  return starts;
}

std::string_view line_of(std::string_view text, const std::vector<std::size_t>& starts, std::size_t line) {
  if (line >= starts.size()) return {};
  std::size_t end = line + 1 < starts.size() ? starts[line + 1] : text.size();
  while (end > starts[line] && (text[end - 1] == '\n' || text[end - 1] == '\r')) --end;
  return text.substr(starts[line], end - starts[line]);
}

std::size_t utf16_column(std::string_view line, std::size_t bytes) {
  std::size_t units = 0;
  for (std::size_t i = 0; i < std::min(bytes, line.size());) {
    const Character c = character_at(line, i);
    i += c.bytes;
    units += c.units;
  }
  return units;
}

std::size_t byte_column(std::string_view line, std::size_t units) {
  std::size_t i = 0;
  for (std::size_t seen = 0; i < line.size();) {
    const Character c = character_at(line, i);
    if (seen + c.units > units) break;
    i += c.bytes;
    seen += c.units;
  }
  return i;
}

std::size_t offset_of(std::string_view text, std::size_t line, std::size_t units) {
  const std::vector<std::size_t> starts = line_starts(text);
  if (line >= starts.size()) return text.size();
  return starts[line] + byte_column(line_of(text, starts, line), units);
}

std::optional<std::string> path_of_uri(std::string_view uri) {
  constexpr std::string_view kScheme = "file://";
  if (!uri.starts_with(kScheme)) return std::nullopt;
  uri.remove_prefix(kScheme.size());
  const std::size_t slash = uri.find('/');  // a host's name may stand before it
  if (slash == std::string_view::npos) return std::nullopt;
  std::string path;
  for (std::size_t i = slash; i < uri.size(); ++i) {
    const bool escape = uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0;
    path += escape ? static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2])) : uri[i];
    if (escape) i += 2;
  }
  return path.find('\0') == std::string::npos ? std::optional(path) : std::nullopt;
}

std::string uri_of_path(const std::string& path) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string uri = "file://";
  for (const char c : path) {
    if (stands_for_itself(c)) {
      uri += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    uri += '%';
    uri += kDigits[byte >> 4U];
    uri += kDigits[byte & 15U];
  }
  return uri;
}

}  // namespace breve::command
