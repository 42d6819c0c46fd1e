// A step of bodies with joints and contacts takes no memory once it has seen what there is: every call of malloc and of
// operator new in it is counted.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "dynamics_walker.hpp"

namespace {
std::atomic<long> allocations{0};
}

// Eigen calls malloc and not operator new, which also ends in malloc: here both pass.
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

namespace breve::testing {
namespace {

TEST(DynamicsAllocation, TheCounterSeesVectors) {
  const long before = allocations;
  const articulated::Vector v = articulated::Vector::Zero(100);
  EXPECT_GT(allocations, before);
  EXPECT_EQ(v.size(), 100);
}

TEST(DynamicsAllocation, AWalkerTakesNoMemoryAfterWarmUp) {
  for (const Rung rung : {Rung::Fast, Rung::Balanced, Rung::Precise}) {
    Walker s(rung);
    for (int i = 0; i < 240; ++i) s.step();
    const long before = allocations;
    for (int i = 0; i < 60; ++i) s.step();
    EXPECT_EQ(allocations - before, 0) << name_of(rung);
  }
}

TEST(DynamicsAllocation, AStackTakesNoMemoryAfterWarmUp) {
  Physics s;
  s.body(2, Vector3(0, -2.5, 0), BodyKind::Stationary, Shape::box(Vector3(1000, 5, 1000)));
  for (int i = 0; i < 5; ++i) s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(0.02 * i, 0.5 + i, 0));
  s.run(2);
  const long before = allocations;
  s.run(1);
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace breve::testing
