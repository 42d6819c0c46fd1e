// Forces of one iteration: while this stands they act beside the forces that are set; then these are as they were.
#pragma once

#include "runtime/world/parts.hpp"

namespace breve {

class World::Parts::PushScope {
 public:
  explicit PushScope(Parts& parts);
  ~PushScope();
  PushScope(const PushScope&) = delete;
  PushScope& operator=(const PushScope&) = delete;

 private:
  struct Before {
    ObjectId object;
    Vector3 force, torque;          // that were set
    Vector3 all_force, all_torque;  // with what acts beside them
  };
  void give_back() noexcept;

  Parts& parts_;
  std::pmr::vector<Before> before_;
};

}  // namespace breve
