// Targets come from anybody: each byte is looked at, and what is not understood as a whole is invalid.
#include "runtime/store/request_target.hpp"

#include <algorithm>
#include <optional>

namespace breve {

namespace {

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Without percent signs. None if one is not followed by two digits, or if it hides a control character.
std::optional<std::string> decoded(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '%') {
      if (text.size() - i < 3 || digit_of(text[i + 1]) < 0 || digit_of(text[i + 2]) < 0) return std::nullopt;
      c = static_cast<char>(16 * digit_of(text[i + 1]) + digit_of(text[i + 2]));
      i += 2;
    }
    if (static_cast<unsigned char>(c) < ' ' || c == 127) return std::nullopt;
    plain += c;
  }
  return plain;
}

/// The parts between separators: one more than there are separators.
std::vector<std::string_view> parts_of(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    if (end == text.size()) return parts;
    begin = end + 1;
  }
}

/// Every folder on the way is a plain name.
bool is_plain_path(std::string_view path) {
  const auto parts = parts_of(path, '/');
  return path.find('\\') == std::string_view::npos && path.find(':') == std::string_view::npos &&
         std::none_of(parts.begin(), parts.end(), [](std::string_view part) { return part.empty() || part[0] == '.'; });
}

bool is_method_name(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
  });
}

RequestTarget method_of(std::string_view text) {
  RequestTarget target;
  const auto parts = parts_of(text, '_');
  if (parts.size() > RequestTarget::kMostArguments + 1) return {};
  for (const std::string_view part : parts) {
    auto plain = decoded(part);
    if (!plain) return {};
    target.arguments.push_back(std::move(*plain));
  }
  target.name = std::move(target.arguments.front());
  target.arguments.erase(target.arguments.begin());
  if (!is_method_name(target.name)) return {};
  target.kind = RequestTarget::Kind::Method;
  return target;
}

}  // namespace

RequestTarget parse_request_target(std::string_view target) {
  if (target.size() > RequestTarget::kMostBytes || !target.starts_with('/')) return {};
  const std::string_view path = target.substr(1, target.find_first_of("?#") - 1);
  if (path.empty()) return {RequestTarget::Kind::Start, {}, {}};
  const auto whole = decoded(path);
  if (!whole) return {};
  if (!whole->ends_with(".html")) return method_of(path);
  if (!is_plain_path(*whole)) return {};
  return {RequestTarget::Kind::Page, *whole, {}};
}

}  // namespace breve
