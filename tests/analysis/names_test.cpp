// What names mean: symbols, definitions, references.
#include <gtest/gtest.h>

#include "looking.hpp"
#include "steve/analysis/signatures.hpp"
#include "steve/machine/native.hpp"

namespace breve::steve::test {
namespace {

TEST(Symbols, HoldSignaturesTypesAndDocumentation) {
  const Looking looking = in_body("");
  const SymbolInfo* cls = looking.symbol(NameKind::Class, "Bird");
  ASSERT_NE(cls, nullptr);
  EXPECT_EQ(cls->signature, "Mobile : Bird (aka Birds)");
  EXPECT_EQ(cls->parent_class, "Mobile");
  EXPECT_EQ(cls->alias, "Birds");
  EXPECT_EQ(cls->doc, "A bird.");
  EXPECT_FALSE(cls->library);
  const SymbolInfo* method = looking.symbol(NameKind::Method, "fly", "Bird");
  ASSERT_NE(method, nullptr);
  EXPECT_EQ(method->signature, "fly to place (vector) with-speed speed = 1.5 (float)");
  EXPECT_EQ(method->doc, "Fly somewhere.");
  EXPECT_FALSE(method->hidden);
  EXPECT_TRUE(looking.symbol(NameKind::Method, "rest", "Bird")->hidden);
  const SymbolInfo* keyword = looking.symbol(NameKind::Keyword, "with-speed", "Bird");
  ASSERT_NE(keyword, nullptr);
  EXPECT_EQ(keyword->value, "1.5");
  EXPECT_EQ(keyword->type, "float");
  EXPECT_EQ(looking.analysis->symbols()[keyword->parent].name, "fly");
  EXPECT_EQ(looking.symbol(NameKind::Parameter, "speed", "Bird")->type, "float");
  EXPECT_EQ(looking.symbol(NameKind::Variable, "heading", "Bird")->doc, "where it flies");
  EXPECT_EQ(looking.symbol(NameKind::Variable, "leader", "Bird")->type, "Bird object");
  EXPECT_EQ(looking.symbol(NameKind::Variable, "wings", "Bird")->signature, "wings (2 ints)");
  EXPECT_EQ(looking.symbol(NameKind::Local, "here", "Bird")->type, "vector");
  const SymbolInfo* constant = looking.symbol(NameKind::Constant, "SPEED");
  ASSERT_NE(constant, nullptr);
  EXPECT_EQ(constant->value, "5.5");
  EXPECT_EQ(constant->doc, "length units a second");
}

TEST(Symbols, ModulesComeFirstAndTheLibraryThatIsNotUsedIsMarked) {
  const Looking looking = in_body("");
  EXPECT_EQ(looking.analysis->symbols().front().kind, NameKind::Module);
  EXPECT_EQ(looking.analysis->symbols().front().name, "main.tz");
  EXPECT_TRUE(looking.symbol(NameKind::Class, "Mobile")->library);
  EXPECT_TRUE(looking.symbol(NameKind::Class, "Mobile")->loaded);
  EXPECT_FALSE(looking.symbol(NameKind::Class, "Stationary")->loaded);
}

TEST(Symbols, EveryFunctionOfTheLanguageIsExplained) {
  const Looking looking("");
  for (const Native& native : functions()) {
    const std::size_t parameters = native.signature.find(':');
    EXPECT_NE(function_note(native.name, parameters), nullptr) << native.name << " with " << parameters;
    const SymbolInfo* symbol = looking.symbol(NameKind::Function, native.name);
    ASSERT_NE(symbol, nullptr);
    EXPECT_FALSE(symbol->doc.empty()) << native.name;
  }
  EXPECT_EQ(looking.symbol(NameKind::Function, "angle")->signature, "angle(a (vector), b (vector))");
  EXPECT_EQ(looking.symbol(NameKind::Function, "angle")->type, "float");
}

TEST(Symbols, ErrorsDoNotHideTheRest) {
  const Looking looking(
      "Object : A {\n  + to one:\n    x = = 5.\n  + to two at t (float):\n    self .\n}\nObject : B {\n  + to "
      "three:\n");
  EXPECT_GT(looking.analysis->diagnostics().size(), 0U);
  EXPECT_NE(looking.symbol(NameKind::Method, "one", "A"), nullptr);
  EXPECT_NE(looking.symbol(NameKind::Method, "two", "A"), nullptr);
  EXPECT_NE(looking.symbol(NameKind::Method, "three", "B"), nullptr);
}

TEST(Names, AMethodIsThatOfTheReceiversClass) {
  EXPECT_EQ(in_body("b re~st.").definitions(), "Bird.rest");
  EXPECT_EQ(in_body("b set-co~lor to (1, 1, 1).").definitions(), "Real.set-color to newColor (vector)");
  EXPECT_EQ(in_body("super ite~rate.").definitions(), "Control.iterate");
}

TEST(Names, OfAnUnknownReceiverEveryMethodThatFits) {
  const std::string found = in_body("(getController()::x) get-time~.").definitions();
  EXPECT_NE(found, "nothing");
  const Looking looking(
      "Object : A {\n + to hop on x (int): print x.\n}\nObject : B {\n + to hop: print 1.\n + to try with "
      "o (object):\n  o ho~p on 1.\n}\n");
  EXPECT_EQ(looking.definitions(), "A.hop on x (int)");
}

TEST(Names, AReceiverWhoseClassDoesNotAnswerMayBeOfAnother) {
  EXPECT_EQ(in_body("self fl~y to (1, 2, 3).").definitions(),
            "Bird.fly to place (vector) with-speed speed = 1.5 (float)");
}

TEST(Names, KeywordsBelongToTheCalledMethod) {
  EXPECT_EQ(in_body("b fly t~o (1, 2, 3).").definitions(), "Bird.to place (vector)");
  const Looking looking = in_body("b fly to (1, 2, 3) with-~speed 3.");
  const auto reference = looking.at();
  ASSERT_TRUE(reference);
  EXPECT_EQ(reference->kind, NameKind::Keyword);
  EXPECT_EQ(reference->type, "Bird object");
}

TEST(Names, VariablesConstantsFunctionsClasses) {
  EXPECT_EQ(in_body("print bir~ds.").definitions(), "Field.birds (list)");
  EXPECT_EQ(in_body("print \"$bir~ds\".").definitions(), "Field.birds (list)");
  EXPECT_EQ(in_body("print \"${bir~ds}\".").definitions(), "Field.birds (list)");
  EXPECT_EQ(in_body("foreach ~b in birds: b rest.").definitions(), "Field.b (object)");
  EXPECT_EQ(in_body("print SPE~ED.").definitions(), "@define SPEED 5.5");
  EXPECT_EQ(in_body("print sq~rt(2).").definitions(), "sqrt(x (float))");
  EXPECT_EQ(in_body("first = new Bi~rd.").definitions(), "Mobile : Bird (aka Birds)");
  EXPECT_EQ(in_body("birds = 3 new Bir~ds.").definitions(), "Mobile : Bird (aka Birds)");
  EXPECT_EQ(in_body("print first::lead~er.").definitions(), "Bird.leader (Bird object)");
  EXPECT_EQ(in_body("print 5~5.").definitions(), "nothing");
}

TEST(Names, HeadersAndTypesNameClassesToo) {
  EXPECT_EQ(Looking("Mob~ile : A {}").definitions(), "Real : Mobile (aka Mobiles)");
  EXPECT_EQ(Looking("Controller Mi~ne.\nControl : Mine {}").definitions(), "Control : Mine");
  EXPECT_EQ(Looking("Object : A {\n + variables:\n  a, b (Mo~bile object).\n}").definitions(),
            "Real : Mobile (aka Mobiles)");
  EXPECT_EQ(Looking("@use Mob~ile.").definitions(), "library:Mobile.tz");
}

TEST(Names, DeclarationsSayThatTheyAre) {
  const Looking looking("Object : A {\n + to ho~p: print 1.\n}");
  const auto reference = looking.at();
  ASSERT_TRUE(reference);
  EXPECT_TRUE(reference->declaration);
  EXPECT_EQ(reference->signature, "hop");
}

TEST(Names, WordsAreExplained) {
  const Looking loop = in_body("fore~ach b in birds: b rest.");
  const auto word = loop.at();
  ASSERT_TRUE(word);
  EXPECT_EQ(word->kind, NameKind::Word);
  EXPECT_EQ(word->signature, "foreach item in list: statement");
  const Looking variable("Object : A {\n + variables:\n  a (vec~tor).\n}");
  const auto type = variable.at();
  ASSERT_TRUE(type);
  EXPECT_EQ(type->kind, NameKind::Type);
}

TEST(Names, InABrokenStatementTheyAreStillFound) {
  EXPECT_EQ(in_body("print bir~ds birds birds = .").definitions(), "Field.birds (list)");
}

TEST(References, AreInTheProgramsOwnFilesInOrder) {
  const Looking looking = in_body("b rest. first rest. self rest.");
  const auto& symbols = looking.analysis->symbols();
  const auto places = [&](const SymbolInfo* symbol) {
    std::string text;
    for (const Span& span : looking.analysis->references(static_cast<std::size_t>(symbol - symbols.data())))
      text += std::to_string(span.line) + ":" + std::to_string(span.column) + " ";
    return text;
  };
  EXPECT_EQ(places(looking.symbol(NameKind::Method, "rest", "Bird")), "21:8 23:12 36:27 37:7 37:19 37:30 ");
  EXPECT_EQ(places(looking.symbol(NameKind::Class, "Bird")), "5:10 5:20 9:13 18:18 34:15 ");
  EXPECT_EQ(places(looking.symbol(NameKind::Constant, "SPEED")), "2:9 ");
}

}  // namespace
}  // namespace breve::steve::test
