// The completions at a position, while the text is being written.
#include <gtest/gtest.h>

#include "looking.hpp"

namespace breve::steve::test {
namespace {

using Names = std::vector<std::string>;

TEST(Completions, AfterAReceiverOfKnownClassItsOwnSelectorsComeFirst) {
  const Names names = in_body("(new Bird) ~").completions();
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(names.front(), "fly");
  EXPECT_TRUE(in_body("(new Bird) ~").offers("set-velocity"));
  EXPECT_FALSE(in_body("(new Bird) ~").offers("watch-me"));
}

TEST(Completions, WhatIsTypedOfASelectorNarrowsThem) {
  EXPECT_EQ(in_body("(new Bird) fl~").completions(), Names{"fly"});
  EXPECT_EQ(in_body("(new Bird) FL~").completions(), Names{"fly"});
  EXPECT_EQ(in_body("(new Bird) set-rotational-v~").completions(), Names{"set-rotational-velocity"});
  EXPECT_EQ(in_body("(new Bird) set-rotational-v~").analysis->completions(0, 0).typed, 0U);
}

TEST(Completions, ATrailingDashIsPartOfWhatIsTyped) {
  EXPECT_TRUE(in_body("self set-~").offers("set-iteration-step"));
  EXPECT_FALSE(in_body("self set-~").offers("get-time"));
}

TEST(Completions, SelfIsOfTheClassAndSuperOfItsParent) {
  EXPECT_TRUE(in_body("self ~").offers("update-neighbors"));
  EXPECT_FALSE(in_body("self ~").offers("fly"));
  EXPECT_TRUE(in_body("super ~").offers("iterate"));
}

TEST(Completions, ClassesOfVariablesComeFromDeclarationsAndFromWhatIsAssigned) {
  EXPECT_TRUE(in_body("b ~").offers("fly"));      // the loop's variable, by the list's elements
  EXPECT_TRUE(in_body("first ~").offers("fly"));  // an element of that list
  EXPECT_TRUE(in_body("(first::leader) ~").offers("fly"));
  EXPECT_TRUE(in_body("birds ~").offers("fly"));                           // a call to a list goes to its elements
  EXPECT_TRUE(in_body("((new Bird) fly to (1, 2, 3)) ~").offers("rest"));  // it returns self
  EXPECT_TRUE(in_body("(b get-controller) ~").offers("update-neighbors"));
}

TEST(Completions, NumbersHaveNoSelectors) {
  EXPECT_EQ(in_body("5 ~").completions(), Names{});
  EXPECT_EQ(in_body("\"text\" ~").completions(), Names{});
}

TEST(Completions, InACallTheKeywordsThatAreNotGivenYet) {
  EXPECT_EQ(in_body("b fly ~").completions(), (Names{"to", "with-speed"}));
  EXPECT_EQ(in_body("b fly to (1, 2, 3) ~").completions(), Names{"with-speed"});
  EXPECT_EQ(in_body("b fly to (1, 2, 3) + heading w~").completions(), Names{"with-speed"});
  EXPECT_EQ(in_body("x = (b fly to (1, 2, 3) ~").completions(), Names{"with-speed"});
}

TEST(Completions, AKeywordsValueIsAnExpression) {
  const Looking looking = in_body("b fly to ~");
  EXPECT_TRUE(looking.offers("birds"));
  EXPECT_TRUE(looking.offers("SPEED"));
  EXPECT_TRUE(looking.offers("sqrt"));
  EXPECT_TRUE(looking.offers("random"));
  EXPECT_FALSE(looking.offers("foreach"));
}

TEST(Completions, AStatementBeginsWithVariablesAndStatements) {
  const Looking looking = in_body("~");
  for (const char* name : {"b", "birds", "first", "foreach", "print", "self", "push"})
    EXPECT_TRUE(looking.offers(name)) << name;
  EXPECT_EQ(looking.completions().front(), "b");
  EXPECT_TRUE(in_body("if birds: ~").offers("return"));
  EXPECT_TRUE(in_body("if birds: { b rest. ~").offers("return"));
  EXPECT_TRUE(in_body("if birds: { b rest. } ~").offers("return"));
  EXPECT_TRUE(in_body("if birds: b rest.\n else ~").offers("return"));
}

TEST(Completions, AForgottenPeriodDoesNotCarryOver) {
  EXPECT_TRUE(in_body("first = b\n    self upd~").offers("update-neighbors"));
  EXPECT_TRUE(in_body("first = b\n    b ~").offers("fly"));
}

TEST(Completions, BehindNewAndAllStandClasses) {
  EXPECT_EQ(in_body("x = new Bi~").completions(), (Names{"Bird", "Birds"}));
  const Looking looking = in_body("x = new ~");
  EXPECT_EQ(looking.completions().front(), "Bird");
  EXPECT_TRUE(looking.offers("Stationary"));  // of the class library, not loaded by the program
  EXPECT_FALSE(looking.offers("b"));
  EXPECT_TRUE(in_body("foreach b in all ~").offers("Bird"));
}

TEST(Completions, WordsInTheMiddleOfListStatements) {
  EXPECT_EQ(in_body("push b ~").completions(), Names{"onto"});
  EXPECT_EQ(in_body("foreach b ~").completions(), Names{"in"});
  EXPECT_EQ(in_body("insert b ~").completions(), Names{"at"});
  EXPECT_EQ(in_body("sort birds ~").completions(), Names{"with"});
  EXPECT_TRUE(in_body("sort birds with ~").offers("update-neighbors"));
  EXPECT_TRUE(in_body("push b onto ~").offers("birds"));
}

TEST(Completions, MembersOfObjectsAndVectors) {
  EXPECT_EQ(in_body("print b::le~").completions(), Names{"leader"});
  EXPECT_EQ(in_body("print (1, 2, 3)::~").completions(), (Names{"x", "y", "z"}));
  EXPECT_EQ(in_body("print b::heading::~").completions(), (Names{"x", "y", "z"}));
}

TEST(Completions, InsideStringsOnlyBehindADollar) {
  EXPECT_EQ(in_body("print \"$bird~\".").completions(), Names{"birds"});
  EXPECT_EQ(in_body("print \"${bird~}\".").completions(), Names{"birds"});
  EXPECT_EQ(in_body("print \"$bird~").completions(), Names{"birds"});
  EXPECT_EQ(in_body("print \"bird~\".").completions(), Names{});
}

TEST(Completions, NothingInComments) {
  EXPECT_EQ(in_body("# b~").completions(), Names{});
  EXPECT_EQ(in_body("#! b~ !#").completions(), Names{});
  EXPECT_EQ(in_body("% b~").completions(), Names{});
  EXPECT_TRUE(in_body("#! b !# b~").offers("birds"));
}

TEST(Completions, TypesInDeclarations) {
  const Looking variable("Object : A {\n  + variables:\n    v (~");
  EXPECT_TRUE(variable.offers("vector"));
  EXPECT_TRUE(variable.offers("Mobile object"));
  EXPECT_FALSE(variable.offers("sqrt"));
  EXPECT_EQ(Looking("Object : A {\n  + variables:\n    v (Mobile ~").completions(), Names{"object"});
  EXPECT_TRUE(Looking("Object : A {\n  + variables:\n    v (5 ~").offers("ints"));
  EXPECT_EQ(Looking("Object : A {\n  + to go to v (vecto~").completions(),
            (Names{"vector", "Vector object", "VectorImage object"}));
  EXPECT_TRUE(Looking("Object : A {\n  + to go:\n    v (ve~").offers("vector"));
}

TEST(Completions, MembersOfAClassBegin) {
  EXPECT_EQ(Looking("Object : A {\n  + ~").completions(), (Names{"to", "variables"}));
  EXPECT_EQ(Looking("Object : A {\n  + to go: print 1.\n  + t~").completions(), Names{"to"});
  const Looking method("Mobile : A {\n  + to ~\n}");
  EXPECT_TRUE(method.offers("iterate"));
  EXPECT_TRUE(method.offers("get-description"));
  EXPECT_TRUE(method.offers("set-color"));
}

TEST(Completions, DirectivesAndModules) {
  EXPECT_TRUE(Looking("@~").offers("use"));
  EXPECT_EQ(Looking("@inc~").completions(), Names{"include"});
  EXPECT_TRUE(Looking("@use ~").offers("Mobile"));
  EXPECT_TRUE(Looking("Controller ~.\nControl : Mine {}").offers("Mine"));
  EXPECT_TRUE(Looking("~").offers("Controller"));
}

TEST(Completions, AStatementOutsideOfAnyFile) {
  const Looking looking = in_body("");
  const auto names = [&](std::string_view cls, std::string_view text) {
    Names result;
    const auto found = looking.analysis->statement_completions(cls, text, static_cast<std::uint32_t>(text.size()));
    if (!found) return Names{"no class"};
    for (const Completion& item : found->items) result.push_back(item.name);
    return result;
  };
  EXPECT_EQ(names("Field", "print bird"), Names{"birds"});
  EXPECT_EQ(names("Field", "(new Bird) fl"), Names{"fly"});
  EXPECT_EQ(names("Birds", "friend fly to (0, 0, 0) wit"), Names{"with-speed"});
  EXPECT_EQ(names("", "self fl"), Names{"fly"});
  EXPECT_EQ(names("Fish", ""), Names{"no class"});
}

TEST(Completions, TheCallAroundAPlaceIsKnownWithItsKeyword) {
  const std::string text = world("b fly to (1, 2, ");
  const Looking looking{std::string(text)};
  const auto offset = static_cast<std::uint32_t>(text.find("b fly to (1, 2, ") + 15);
  const auto call = looking.analysis->call_at(0, offset);
  ASSERT_TRUE(call);
  ASSERT_EQ(call->methods.size(), 1U);
  EXPECT_EQ(looking.shown(call->methods[0]), "Bird.fly to place (vector) with-speed speed = 1.5 (float)");
  EXPECT_EQ(call->keyword, "to");
  EXPECT_FALSE(looking.analysis->call_at(0, 0));
}

// Whatever is cut off where, asking is safe.
TEST(Completions, AnyPrefixOfAProgramCanBeAskedAbout) {
  const std::string text = world("b fly to (1, 2, 3) with-speed |heading|.\n    print \"${birds{0}} $b\".\n");
  for (std::size_t end = 0; end < text.size(); end += 7) {
    const Looking looking{text.substr(0, end)};
    const auto offset = static_cast<std::uint32_t>(end);
    looking.analysis->completions(0, offset);
    looking.analysis->call_at(0, offset);
    looking.analysis->at(0, offset);
    looking.analysis->definitions(0, offset);
  }
}

TEST(Completions, EveryPlaceOfAProgramCanBeAskedAbout) {
  const std::string text = world("b fly to (1, 2, 3) with-speed |heading|.\n    print \"${birds{0}} $b\".\n");
  const Looking looking{std::string(text)};
  for (std::uint32_t offset = 0; offset <= text.size(); ++offset) {
    looking.analysis->completions(0, offset);
    looking.analysis->at(0, offset);
    looking.analysis->definitions(0, offset);
  }
}

}  // namespace
}  // namespace breve::steve::test
