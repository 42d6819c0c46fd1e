// What a defect of the library does to its host: a status and a text. The defects are made by writing into a world.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "hostapi/src/internal.hpp"
#include "runtime/base/invariant.hpp"

namespace breve::host {
namespace {

constexpr const char* kProgram =
    "@use Control.\n"
    "Controller Main.\n"
    "Control : Main {\n"
    "  + variables:\n"
    "    kept (list).\n"
    "  + to init:\n"
    "    kept = { 1, 2 }.\n"
    "  + to drop:\n"
    "    kept = { 3 }.\n"
    "  + to drop-by-name:\n"
    "    callMethodNamed(self, \"drop\", {}).\n"
    "    print \"went on\".\n"
    "  + to say:\n"
    "    print \"said\".\n"
    "}\n";

struct Host {
  explicit Host(breve_print_fn print = nullptr) {
    breve_runtime_config config = breve_runtime_config_default();
    config.print = print;
    EXPECT_EQ(breve_runtime_create(&config, &runtime), BREVE_OK);
    EXPECT_EQ(breve_program_compile(runtime, "defects.tz", kProgram, std::string(kProgram).size(), &program), BREVE_OK);
    EXPECT_EQ(breve_world_create(runtime, program, nullptr, &world), BREVE_OK);
    controller = breve_world_controller(world);
  }
  ~Host() {
    EXPECT_EQ(breve_world_destroy(world), BREVE_OK);
    breve_program_destroy(program);
    breve_runtime_destroy(runtime);
  }
  breve_status call(const char* method) { return breve_object_call(world, controller, method, nullptr, 0, nullptr); }
  std::string text() const { return breve_world_last_error(world)->text; }

  breve_runtime* runtime = nullptr;
  breve_program* program = nullptr;
  breve_world* world = nullptr;
  breve_object controller{};
};

/// The controller's list, of which nobody has a reference by the books.
void forget_references(Host& host) {
  auto& instance = live_instance(*host.world, host.controller);
  const auto* kept = instance.cls->find_variable(host.world->program->symbols().find("kept"));
  ASSERT_NE(kept, nullptr);
  static_cast<steve::Cell*>(instance.slots[kept->slot].ref)->count = 0;
}

TEST(Defects, AFailedInvariantInAScriptIsAStatusWithItsPlace) {
  Host host;
  forget_references(host);
  EXPECT_EQ(host.call("drop"), BREVE_ERROR_INTERNAL);
  EXPECT_NE(host.text().find("defect of breve"), std::string::npos) << host.text();
  EXPECT_EQ(breve_world_last_error(host.world)->line, 9u) << host.text();
  EXPECT_EQ(host.call("say"), BREVE_OK);
}

// Errors of a script inside such a call do not stop the caller; a defect is not an error of the script.
TEST(Defects, ADefectStopsWhatErrorsOfScriptsDoNot) {
  Host host;
  forget_references(host);
  EXPECT_EQ(host.call("drop-by-name"), BREVE_ERROR_INTERNAL);
}

TEST(Defects, AnInvariantThatFailsNamesItsFile) {
  ErrorRecord record;
  EXPECT_EQ(guard(record, [] { invariant(false, "rows are parallel to contacts"); }), BREVE_ERROR_INTERNAL);
  EXPECT_EQ(std::string(record.view()->message).rfind("rows are parallel to contacts (defects.cpp:", 0), 0u)
      << record.view()->message;
}

TEST(Defects, AnExceptionThatNobodyExpectsIsAStatus) {
  Host host(
      [](void*, breve_world*, breve_channel, const char*, size_t) { throw std::logic_error("not of this house"); });
  EXPECT_EQ(host.call("say"), BREVE_ERROR_INTERNAL);
  EXPECT_NE(host.text().find("not of this house"), std::string::npos);
}

}  // namespace
}  // namespace breve::host
