// Method names and messages as numbers: a queue of a million calls holds four bytes a name.
#pragma once

#include <cstdint>
#include <map>
#include <memory_resource>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/bytes.hpp"

namespace breve {

using NameId = std::uint32_t;
inline constexpr NameId kNoName = 0xffffffffU;

class NameTable {
 public:
  explicit NameTable(std::pmr::memory_resource* memory) : numbers_(memory), texts_(memory) {}

  NameId intern(std::string_view text) {
    if (const NameId known = find(text); known != kNoName) return known;
    const auto number = static_cast<NameId>(texts_.size());
    const auto entry = numbers_.emplace(text, number).first;
    try {
      texts_.push_back(&entry->first);
    } catch (...) {
      numbers_.erase(entry);
      throw;
    }
    return number;
  }
  NameId find(std::string_view text) const {
    const auto entry = numbers_.find(text);
    return entry == numbers_.end() ? kNoName : entry->second;
  }
  /// Valid for the life of the table.
  std::string_view text(NameId name) const { return *texts_[name]; }
  std::size_t size() const { return texts_.size(); }

  void save(ByteWriter& out) const {
    out.put(static_cast<std::uint64_t>(texts_.size()));
    for (const auto* text : texts_) out.put(std::string_view(*text));
  }
  void load(ByteReader& in) {
    const std::size_t count = in.get_count(sizeof(std::uint64_t));
    for (std::size_t i = 0; i < count; ++i) {
      if (intern(in.get_text()) != i) ByteReader::fail();
    }
  }

 private:
  std::pmr::map<std::pmr::string, NameId, std::less<>> numbers_;
  std::pmr::vector<const std::pmr::string*> texts_;  // map nodes do not move
};

}  // namespace breve
