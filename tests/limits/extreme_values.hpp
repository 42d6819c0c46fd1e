// The arguments of extreme calls: the oddest of each type, and those that a selector takes.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace breve::limits {

constexpr std::size_t kOddities = 8;

/// An expression of that type: a largest, least or oddest one. The last is one that most methods take.
/// @param type  as breve.h names it: "int", "Image object"
/// @param number  < kOddities
std::string odd_value(std::string_view type, std::size_t number);

/// An expression that the method takes, so that a call does its work instead of refusing an argument.
/// @param keyword  "" for a function
/// @param parameter  the name that the method gives to the argument
std::string fitting_value(std::string_view selector, std::string_view keyword, std::string_view parameter,
                          std::string_view type);

}  // namespace breve::limits
