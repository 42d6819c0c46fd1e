// Where all bodies were before the last iteration, for hosts that draw between two of them.
#pragma once

#include <memory_resource>
#include <vector>

#include "runtime/world/world.hpp"

namespace breve::host {

class PreviousPoses {
 public:
  explicit PreviousPoses(std::pmr::memory_resource* memory) : poses_(memory) {}

  void keep(bool on) {
    on_ = on;
    if (!on) forget();
  }
  bool kept() const { return on_; }
  /// An iteration is about to begin.
  void record(const Bodies& bodies);
  void forget() { poses_.clear(); }
  /// The body was put elsewhere at once.
  void forget(BodyIndex body) {
    if (body < poses_.size()) poses_[body].owner = {};
  }
  /// Null if it is not known where it was.
  const Pose* of(BodyIndex body, ObjectId owner) const {
    return body < poses_.size() && poses_[body].owner == owner ? &poses_[body].pose : nullptr;
  }

 private:
  struct Entry {
    ObjectId owner;
    Pose pose;
  };
  std::pmr::vector<Entry> poses_;  // by body
  bool on_ = false;
};

}  // namespace breve::host
