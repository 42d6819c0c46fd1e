// Script values as XML elements, for archives.
#pragma once

#include <deque>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "steve/machine/machine.hpp"

namespace breve::steve {

constexpr int kMostNested = 500;  // lists and hashes within each other

/// `poll` is called now and then, as in all below; it may throw.
std::string to_hex(std::string_view bytes, const Poll& poll);
/// @throws Error{File} for anything but pairs of hexadecimal digits
std::string from_hex(std::string_view digits, const Poll& poll);

/// Writes the values of one archive. Objects are named by the numbers in `objects`; any other is null.
class ValueWriter {
 public:
  ValueWriter(Machine& machine, const std::map<std::uint64_t, int>& numbers) : machine_(machine), numbers_(numbers) {}
  /// @throws Error{Argument} for lists and hashes nested too deeply
  void write(pugi::xml_node parent, const Value& value, int depth = 0);

 private:
  bool seen_before(pugi::xml_node node, std::uint64_t serial);

  Machine& machine_;
  const std::map<std::uint64_t, int>& numbers_;  // serial of an instance to its number in the archive
  std::map<std::uint64_t, int> containers_;      // serial of a list or hash to the number it got
};

/// Reads the values of one archive; `objects[n]` is the object with number n, null if there is none.
class ValueReader {
 public:
  ValueReader(Machine& machine, const std::map<int, Instance*>& objects) : machine_(machine), objects_(objects) {}
  /// The value that the first element in `parent` stands for.
  /// @throws Error{File} for anything that a ValueWriter does not write
  Value read_in(pugi::xml_node parent, int depth = 0);
  /// The value that this element stands for.
  Value read(pugi::xml_node element, int depth = 0);

 private:
  Value read_same(pugi::xml_node node, Tag tag) const;
  Value read_list(pugi::xml_node node, int depth);
  Value read_hash(pugi::xml_node node, int depth);

  Machine& machine_;
  const std::map<int, Instance*>& objects_;
  std::map<int, Value> containers_;
  std::deque<Pin> pins_;  // of the containers: a host that hears a warning may drop the variable that holds one
};

}  // namespace breve::steve
