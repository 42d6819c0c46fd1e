// What a request of HTTP names: the start page, a page in a file, or a method with its arguments.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace breve {

struct RequestTarget {
  enum class Kind { Invalid, Start, Page, Method };
  static constexpr std::size_t kMostBytes = 8192, kMostArguments = 32;

  Kind kind = Kind::Invalid;
  std::string name;                    // of the file, by a path without "..", or of the method
  std::vector<std::string> arguments;  // of the method
};

/// "/" is the start page; what ends in ".html" a file, "/walk/map.html"; anything else a method with arguments between
/// underscores, "/set-speed_3.5". What follows a '?' is ignored. %41 is the letter A, everywhere. Invalid: names that a
/// file or method cannot have, and paths that lead up, hide (".x") or begin elsewhere.
RequestTarget parse_request_target(std::string_view target);

}  // namespace breve
