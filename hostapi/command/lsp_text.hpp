// Texts as editors see them: lines and columns from 0, columns in UTF-16 units; and files as URIs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace breve::command {

/// Where the lines of a text begin. LF, CR and CRLF each end a line.
std::vector<std::size_t> line_starts(std::string_view text);

/// A line of a text without its end; empty if there is none.
std::string_view line_of(std::string_view text, const std::vector<std::size_t>& starts, std::size_t line);

/// UTF-16 units in the first `bytes` bytes of a line. A byte that is not UTF-8 counts as one unit.
std::size_t utf16_column(std::string_view line, std::size_t bytes);

/// The bytes that `units` UTF-16 units of a line take, at most all of it. Never cuts a character.
std::size_t byte_column(std::string_view line, std::size_t units);

/// The byte of a place that an editor names; places behind the end of a line or text are that end.
std::size_t offset_of(std::string_view text, std::size_t line, std::size_t units);

/// "file:///a%20b.tz" as "/a b.tz"; nothing if it is not the URI of a file.
std::optional<std::string> path_of_uri(std::string_view uri);
std::string uri_of_path(const std::string& path);

}  // namespace breve::command
