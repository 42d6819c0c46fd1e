// What a machine says to whoever embeds it: run-time errors with their traces, warnings, and what scripts print. It
// counts what is said, so that a program in a loop cannot flood its host, and says once what is to be said once.
#pragma once

#include <cstdint>
#include <functional>
#include <memory_resource>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>

#include "steve/code/bytecode.hpp"
#include "steve/code/program.hpp"
#include "steve/machine/machine_host.hpp"
#include "steve/machine/report.hpp"
#include "steve/machine/trace.hpp"

namespace breve::steve {

class Reporter {
 public:
  Reporter(const MachineHost& host, std::pmr::memory_resource* memory)
      : host_(host), warned_locations_(memory), warned_keys_(memory) {}

  /// An iteration or a call by the host begins: its share of printing and reports is whole again.
  void begin_run() { printed_ = told_ = 0; }
  /// RunError{Bounds} where an iteration or a call by the host has printed too much.
  void print(std::string_view text);

  /// Everything that is known about an error while these calls are active, outermost first.
  ErrorReport report(const RunError& error, std::span<const ActiveCall> calls, const Program& program) const;

  /// Reports a warning, or an error that does not stop the run. After the first thousand of an iteration or a call by
  /// the host, the host gets an empty text for each.
  /// @param text  makes the text, whole lines; called only where it is reported
  template <class Text>
  void tell(Severity severity, Text&& text) {
    const auto& to = severity == Severity::Error ? host_.error : host_.warn;
    if (!to) return;
    if (told_ > kMostTold) return to({});
    if (++told_ <= kMostTold) return to(text());
    warn_of_silence();
    to({});
  }
  /// True the first time that a world asks with this key, or with this place in its code.
  bool is_first(std::string_view key) {
    if (warned_keys_.contains(key)) return false;
    warned_keys_.emplace(key);
    return true;
  }
  bool is_first(const Instruction* location) { return warned_locations_.insert(location).second; }
  /// The code is going: other code may come to stand at its addresses.
  void forget_locations(std::span<const Instruction> code);
  void forget_locations() { warned_locations_.clear(); }

 private:
  static constexpr std::uint64_t kMostTold = 1000;
  void warn_of_silence() const;

  const MachineHost& host_;
  std::pmr::unordered_set<const Instruction*> warned_locations_;
  std::pmr::set<std::pmr::string, std::less<>> warned_keys_;
  std::uint64_t printed_ = 0;  // bytes, in this iteration or call by the host
  std::uint64_t told_ = 0;     // reports, likewise
};

}  // namespace breve::steve
