// breve.hpp in a host of C++20: its lists are made of std::span.
#include <gtest/gtest.h>

#include <span>

#include "breve/breve.hpp"

namespace {

constexpr const char* kText =
    "@use Control.\n@use Mobile.\nController Stage.\n"
    "Control : Stage {\n  + to init: 3 new Mobile.\n}\n";

TEST(BreveHpp20, ListsAreSpans) {
  breve::Runtime runtime = breve::Runtime::create().or_throw();
  breve::Program program = runtime.compile("stage.tz", kText).or_throw();
  breve::World world = runtime.world(program).or_throw();
  breve::Object room[8];
  const std::size_t count = world.objects("Mobile", std::span(room)).or_throw();
  ASSERT_EQ(count, 3U);
  const std::span<const breve::Object> mobiles(room, count);
  double numbers[24] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  EXPECT_TRUE(world.set_all(mobiles, BREVE_PROPERTY_LOCATION, std::span<const double>(numbers, 9)));
  EXPECT_TRUE(world.get_all(mobiles.last(2), BREVE_PROPERTY_POSE, std::span(numbers).first(14)));
  EXPECT_EQ(numbers[0], 4);
  EXPECT_EQ(numbers[7], 7);
  EXPECT_EQ(world.get_all(mobiles, BREVE_PROPERTY_POSE, std::span(numbers)).code(), BREVE_ERROR_ARGUMENT);
}

}  // namespace
