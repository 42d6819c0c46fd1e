// Memory that a library takes from the C++ allocator, held in the world's memory as well, so that a limit bounds it.
// The block is never touched: it takes addresses, and no pages.
#pragma once

#include <cstddef>
#include <memory_resource>

namespace breve {

class Held {
 public:
  explicit Held(std::pmr::memory_resource* memory) : memory_(memory) {}
  ~Held() { drop(); }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  std::size_t bytes() const { return bytes_; }
  /// At least so many; std::bad_alloc if the world's memory does not allow it: what was held stays.
  void hold(std::size_t bytes) {
    if (bytes <= bytes_) return;
    const std::size_t wanted = bytes + bytes / 2;
    void* block = memory_->allocate(wanted);
    drop();
    block_ = block;
    bytes_ = wanted;
  }
  void drop() {
    if (block_) memory_->deallocate(block_, bytes_);
    block_ = nullptr;
    bytes_ = 0;
  }

 private:
  std::pmr::memory_resource* memory_;
  void* block_ = nullptr;
  std::size_t bytes_ = 0;
};

}  // namespace breve
