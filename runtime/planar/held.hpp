// Memory that a library takes from the C++ allocator, held in the world's memory as well, so that a limit bounds it.
// The block is never touched: it takes addresses, and no pages.
#pragma once

#include <cstddef>
#include <memory_resource>

namespace breve {

// Bytes that Box2D takes, by its sources: a body 184 bytes, a fixture with its shape and proxy about 330, two nodes of
// its trees 96, a contact 256, a joint up to 280, an entry of its growing list of pairs 8; rounded up for its blocks
// and lists.
inline constexpr std::size_t kPerWorld = 160'000, kPerBody = 768, kPerContact = 320, kPerJoint = 320, kPerPair = 16;

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
