// How long work lets itself be ended.
#pragma once

#include <cstdint>
#include <functional>

namespace breve {

/// Called again and again by long work, at least a hundred times a second; it may throw to end the work. Empty: nobody
/// wants to end it.
using Poll = std::function<void()>;

/// The same in loops over many small things.
class EveryFew {
 public:
  explicit EveryFew(const Poll& poll) : poll_(poll) {}
  void count() {
    if (++counted_ % kFew == 0 && poll_) poll_();
  }

 private:
  static constexpr std::uint32_t kFew = 4096;
  const Poll& poll_;
  std::uint32_t counted_ = 0;
};

}  // namespace breve
