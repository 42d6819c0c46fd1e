// What the guard did in a run: counted, told as it happens with --verbose, and summed up at the end.
#pragma once

#include <breve/breve.h>

#include <cstdint>
#include <map>
#include <string>

#include "output.hpp"

namespace breve::command {

class Interventions {
 public:
  /// Takes in those of the iteration that just ended.
  /// @param output  where each is printed; null: nowhere
  void take(const breve_world* world, Output* output);
  std::uint64_t count() const { return count_; }
  /// How many ended in that action: "reported", "refined" or "put to rest".
  std::uint64_t count(const std::string& action) const;
  /// A line for each action, reason and class of body; "" if there was none.
  std::string summary() const;

 private:
  struct What {
    std::string action, reason, who;
    auto operator<=>(const What&) const = default;
  };
  struct Seen {
    std::uint64_t times = 0;
    double first = 0;  // s
    double worst = 0;
  };
  std::map<What, Seen> seen_;
  std::uint64_t count_ = 0;
};

}  // namespace breve::command
