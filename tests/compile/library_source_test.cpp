// The compiler knows the class library that it is given, and no other.
#include <gtest/gtest.h>

#include <array>

#include "steve/compile/compile.hpp"

namespace breve::steve {
namespace {

struct NoModules final : ModuleResolver {
  std::optional<ModuleSource> resolve(std::string_view, std::string_view) override { return std::nullopt; }
};

void chirp(Machine&, Instance&, const Slot*, Value&) {}

constexpr std::array kFiles = {
    LibraryFile{"Birds.tz",
                "NULL : Object (aka Objects) {\n}\n"
                "Object : Bird (aka Birds) {\n"
                "  + to chirp at pitch (float):\n    @native \"bird.chirp\" (int).\n}\n",
                "Object Objects Bird Birds"},
};
constexpr std::array kNatives = {Native{"bird.chirp", &chirp, "d:i", Reach::World}};
constexpr std::array kFunctions = {Native{"whistle", &chirp, "i:n", Reach::World}};
const LibrarySource kBirds{kFiles, kNatives, kFunctions};

constexpr const char* kProgram =
    "@use Birds.\nController Main.\nBird : Main {\n  + to sing:\n    whistle(3).\n    return (self chirp at 440).\n}\n";

CompileResult compiled(const char* text, const LibrarySource& library) {
  NoModules none;
  return compile({"main.tz", text}, none, library);
}

/// The messages of all errors, one a line.
std::string errors(const char* text, const LibrarySource& library) {
  std::string all;
  const CompileResult result = compiled(text, library);
  for (const Diagnostic& d : result.diagnostics.all())
    if (d.severity == Severity::Error) all += d.code + ": " + d.message + '\n';
  return all;
}

TEST(LibrarySource, ProgramsUseTheClassesNativesAndFunctionsThatAreGiven) {
  const CompileResult result = compiled(kProgram, kBirds);
  ASSERT_TRUE(result.program) << errors(kProgram, kBirds);
  const ClassInfo* bird = result.program->find_class("Birds");
  ASSERT_NE(bird, nullptr);
  const MethodInfo* method = bird->find_method(result.program->symbols().find("chirp"), 1);
  ASSERT_NE(method, nullptr);
  EXPECT_EQ(method->native, &chirp);
  EXPECT_EQ(&result.program->library(), &kBirds);
}

TEST(LibrarySource, NothingElseIsThere) {
  EXPECT_NE(errors(kProgram, {}).find("cannot find 'Birds'"), std::string::npos) << errors(kProgram, {});
  EXPECT_NE(errors("@use Control.\n", kBirds).find("cannot find 'Control'"), std::string::npos);
  const LibrarySource silent{kFiles, {}, {}};
  EXPECT_NE(errors(kProgram, silent).find("no native method is called 'bird.chirp'"), std::string::npos);
  EXPECT_NE(errors(kProgram, silent).find("whistle"), std::string::npos);
}

TEST(LibrarySource, ASignatureThatDiffersFromTheDeclarationIsAnError) {
  constexpr std::array kOther = {Native{"bird.chirp", &chirp, "v:i", Reach::World}};
  const LibrarySource other{kFiles, kOther, kFunctions};
  EXPECT_NE(errors(kProgram, other).find("has the signature v:i, but is declared as d:i"), std::string::npos);
}

TEST(LibrarySource, AFileIsFoundByItsNameAndByEachClassInIt) {
  for (const char* name : {"Birds.tz", "Birds", "Bird", "Object", "Objects"})
    EXPECT_EQ(kBirds.find_file(name), kFiles.data()) << name;
  for (const char* name : {"", ".tz", "Bir", "Object Objects", "Bird Birds", "Birds.tz.tz"})
    EXPECT_EQ(kBirds.find_file(name), nullptr) << name;
}

}  // namespace
}  // namespace breve::steve
