// A host without exceptions, by breve.hpp: it compiles, gets its errors as values, and pays no memory for the wrapper:
// each call takes what the C function by itself takes.
#include <cstdio>
#include <cstdlib>
#include <new>

#include "breve/breve.hpp"

#if defined(__cpp_exceptions)
#error "compile this with -fno-exceptions"
#endif

namespace {

std::size_t allocations = 0;
int failures = 0;

void check(bool condition, const char* what, int line) {
  if (condition) return;
  ++failures;
  std::printf("no_exceptions.cpp:%d: not so: %s\n", line, what);
}
#define CHECK(condition) check(condition, #condition, __LINE__)

/// How often memory is asked for in a call that has been made before.
template <class Call>
std::size_t count(Call call) {
  for (int i = 0; i < 3; ++i) call();
  const std::size_t before = allocations;
  for (int i = 0; i < 10; ++i) call();
  return allocations - before;
}

template <class Wrapped, class Plain>
void check_equal(const char* what, Wrapped wrapped, Plain plain) {
  const std::size_t with = count(wrapped), without = count(plain);
  if (with == without) return;
  ++failures;
  std::printf("%s: 10 calls allocate %zu times, and %zu times in C\n", what, with, without);
}

constexpr const char* kText =
    "@use Control.\n@use Mobile.\nController Stage.\nControl : Stage {\n"
    "  + variables:\n    title (string).\n    mover (object).\n"
    "  + to init: title = \"a stage\". mover = new Mobile.\n"
    "  + to add first x (int) second y = 1 (int): return x + y.\n}\n";

void compare_calls(breve::World& world, breve_world* w) {
  const breve_object stage = world.controller();
  const auto add = world.prepare("add", {"second", "first"});
  CHECK(static_cast<bool>(add));
  CHECK(world.call(stage, add.value(), {1, 2}).value().integer() == 3);
  check_equal(
      "a prepared call",
      [&] {
        (void)world.call(stage, add.value(), {1, 2});
      },
      [&] {
        const breve_value arguments[] = {breve_value_int(1), breve_value_int(2)};
        breve_value result;
        breve_object_call_prepared(w, stage, add.value(), arguments, 2, &result);
      });
  check_equal(
      "a call by keywords",
      [&] {
        (void)world.call(stage, "add", {{"first", 41}});
      },
      [&] {
        const breve_keyword keyword = {"first", breve_value_int(41)};
        breve_value result;
        breve_object_call(w, stage, "add", &keyword, 1, &result);
      });
  check_equal(
      "a call that fails", [&] { (void)world.call(stage, "fly"); },
      [&] {
        breve_value result;
        breve_object_call(w, stage, "fly", nullptr, 0, &result);
      });
  check_equal(
      "a variable", [&] { (void)world.get(stage, "title").value().string(); },
      [&] {
        breve_value result;
        breve_object_get(w, stage, "title", &result);
      });
}

void compare_reading(breve::World& world, breve_world* w) {
  const breve_object mover = world.get(world.controller(), "mover").value().object();
  CHECK(count([&] { (void)world.pose(mover); }) == 0);
  CHECK(count([&] { (void)world.set_velocity(mover, {1, 2, 3}); }) == 0);
  CHECK(count([&] { (void)world.class_of(mover); }) == 0);
  breve_object room[8];
  CHECK(world.objects("Real", room).value() == 1 && room[0] == mover);
  check_equal(
      "a list into an array", [&] { (void)world.objects("Real", room); },
      [&] {
        std::size_t number = 0;
        breve_world_objects(w, "Real", room, 8, &number);
      });
}

}  // namespace

// No new handler: what asks here is ours alone.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size != 0 ? size : 1)) return memory;
  std::abort();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size != 0 ? size : 1);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

int main() {
  auto runtime = breve::Runtime::create();
  CHECK(static_cast<bool>(runtime));
  const auto bad = runtime.value().compile("bad.tz", "Controller");
  CHECK(!bad && bad.status().code() == BREVE_ERROR_COMPILE && !bad.text().empty());
  const auto program = runtime.value().compile("stage.tz", kText);
  CHECK(static_cast<bool>(program));
  auto made = runtime.value().world(program.value());
  CHECK(static_cast<bool>(made));
  breve::World world = std::move(made).value();
  CHECK(static_cast<bool>(world.step()));
  compare_calls(world, world.get());
  compare_reading(world, world.get());
  CHECK(breve::World().step().code() == BREVE_ERROR_ARGUMENT);
  return failures != 0;
}
