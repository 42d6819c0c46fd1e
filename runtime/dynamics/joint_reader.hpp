// Positions of joints where they are asked for joint by joint: bounds of one joint stand behind one another, and the
// angles of a ball joint are dear.
#pragma once

#include "runtime/dynamics/core.hpp"

namespace breve {

class JointReader {
 public:
  explicit JointReader(const Dynamics::Core& core) : core_(core) {}

  /// As long as nothing moves.
  const JointVector& position(JointIndex joint) {
    if (joint != last_) position_ = core_.read_position(core_.joints[joint]);
    last_ = joint;
    return position_;
  }

 private:
  const Dynamics::Core& core_;
  JointIndex last_ = kNoJoint;
  JointVector position_ = JointVector::Zero();
};

}  // namespace breve
