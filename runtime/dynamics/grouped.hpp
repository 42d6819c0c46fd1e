// Things by the number of their group, each group's in the order in which they came; for groups that are made anew all
// the time, in memory that stays.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <span>
#include <utility>
#include <vector>

namespace breve {

class Grouped {
 public:
  explicit Grouped(std::pmr::memory_resource* memory) : added_(memory), ends_(memory), sorted_(memory) {}

  void clear() { added_.clear(); }
  std::size_t size() const { return added_.size(); }
  void add(std::uint32_t group, std::uint32_t thing) { added_.emplace_back(group, thing); }

  /// After all were added.
  void sort(std::size_t groups) {
    ends_.assign(groups + 1, 0);
    for (const auto& [group, thing] : added_) ++ends_[group + 1];
    for (std::size_t i = 1; i <= groups; ++i) ends_[i] += ends_[i - 1];
    sorted_.resize(added_.size());
    // ends_[g] is where g's next goes, in the end where the next group begins.
    for (const auto& [group, thing] : added_) sorted_[ends_[group]++] = thing;
  }
  std::span<const std::uint32_t> of(std::size_t group) const {
    const std::size_t begin = group == 0 ? 0 : ends_[group - 1];
    return std::span(sorted_).subspan(begin, ends_[group] - begin);
  }

 private:
  std::pmr::vector<std::pair<std::uint32_t, std::uint32_t>> added_;
  std::pmr::vector<std::uint32_t> ends_, sorted_;
};

}  // namespace breve
