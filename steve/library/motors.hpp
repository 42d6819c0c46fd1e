// Motors of joints, and the reports to programs about motors that do not fit.
#pragma once

#include "steve/library/joints.hpp"

namespace breve::steve {

/// Set what drives a linked joint; says once if its strength is cut.
void drive_joint(Machine& machine, Instance& joint, JointIndex index, const JointDrive& drive);
/// Says once that a motor aims at a speed and was never given any strength, and that a body weighs next to nothing for
/// its motor.
void check_motors(Machine& machine);

}  // namespace breve::steve
