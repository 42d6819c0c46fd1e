// What leads from the number that a host holds to the data of an object.
#pragma once

#include <cstdint>

#include "runtime/base/ids.hpp"
#include "runtime/kinematics/bodies.hpp"

namespace breve {

/// An entry for each slot of the table of objects.
struct ObjectHandle {
  std::uint32_t ticket = 0;  // 0: nobody lives here whom a host could name
  BodyIndex body = kNoBody;
  std::uint64_t user = 0;
  ClassId cls = kNoClass;
};

}  // namespace breve
