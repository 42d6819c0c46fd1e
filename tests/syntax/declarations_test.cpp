// Directives, constants, classes, variables, methods, documentation.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "reading.hpp"

namespace breve::steve::test {
namespace {

using Kind = ast::Directive::Kind;

TEST(Directives, EachFormIsRead) {
  const Reading reading(R"(
@include "a.tz"
@include "b.tz".
@path "/lib" @path "x".
@use Kiln.
  @use Part [version >= 1.5]. @use Other.
@plugin "lib.so"(start).
@nib_file "ui.nib".
Controller Test.
NULL : Test { }
)");
  EXPECT_EQ(reading.errors(), "");
  std::string text;
  for (const ast::Directive& each : reading.file.directives) {
    text += fmt::format("{}:{}{}{}{} ", static_cast<int>(each.kind), each.text, each.entry, each.version_op,
                        each.version_op.empty() ? "" : fmt::format("{}", each.version));
  }
  EXPECT_EQ(text, "0:a.tz 0:b.tz 2:/lib 2:x 1:Kiln 1:Part>=1.5 1:Other 3:lib.sostart 4:ui.nib 5:Test ");
  EXPECT_EQ(reading.file.directives.at(4).span.line, 5U);
}

TEST(Directives, ScanningFindsWhatLoadsFiles) {
  const Reading reading(R"(
#! @include "commented.tz" !#
@define X 5.
  @include "a.tz" @use Kiln.
NULL : T { + to f: print "@use Not". }
@path "p"
@plugin "x"(y).
)");
  std::string text;
  for (const ast::Directive& each : scan_directives(reading.tokens)) {
    text += fmt::format("{}:{}@{} ", static_cast<int>(each.kind), each.text, each.span.line);
  }
  EXPECT_EQ(text, "0:a.tz@4 1:Kiln@4 2:p@6 3:x@7 ");
}

TEST(Directives, MistakesAreReported) {
  const std::vector<std::pair<std::string, std::string>> rows{
      {"@use Kiln\n@use Part.", "1:10 missing-period"},
      {"Controller Test\nNULL : Test {}", "1:16 missing-period"},
      {"@define N 5", "1:12 missing-period"},
      {"@inclde \"x\".", "1:2 unknown-directive"},
      {"@include x.", "1:10 syntax"},
      {"@use \"x\".", "1:6 syntax"},
      {"@use Kiln [version > 2].", "1:22 syntax"},
      {"@use Kiln [version 2.0].", "1:20 syntax"},
      {"@define N n.", "1:11 syntax"},
      {"@define list 5.", "1:9 reserved-word"},
      {"@define N 5.\n@define N 6.", "2:9 redefinition"},
      {"@define N 5.\n@define N 5.0.", "2:9 redefinition"},
      {"@define N 5.\n@define N 5.", ""},
      {"nonsense", "1:1 syntax"},
      {"nonsense\n@use Kiln", "1:1 syntax, 2:10 missing-period"}};
  for (const auto& [text, errors] : rows) EXPECT_EQ(Reading(text).errors(), errors) << text;
}

TEST(Constants, EveryKindWithSigns) {
  const Reading reading(
      R"(@define A 5. @define B -5. @define C 2.5. @define D - .5. @define E "t\n". @define F (1, -2, 3.5).
@define G [ (1, 2, 3), (4, -5, 6), (7, 8, 9) ]. @define H 'a'. @define I -2147483648. @define J 1e3.)");
  EXPECT_EQ(reading.errors(), "");
  std::string text;
  for (const auto& [name, constant] : reading.defines.seen()) text += name + "=" + show(constant) + " ";
  EXPECT_EQ(text, "A=5 B=-5 C=2.5 D=-0.5 E=\"t\\n\" F=(1 -2 3.5) G=(1 2 3 4 -5 6 7 8 9) H=97 I=-2147483648 J=1000.0 ");
}

TEST(Constants, AreUsableOnlyAsOperands) {
  const std::string before = "@define N 5.\n";
  EXPECT_EQ(Reading(before + "NULL : T { + variables: a (N ints). }").errors(), "2:28 unknown-type");
  EXPECT_EQ(Reading(before + "NULL : T { + to f with w = N (int): }").errors(), "2:28 syntax");
  EXPECT_EQ(Reading(before + "NULL : T { + variables: N (int). }").errors(), "2:25 constant-as-name");
  EXPECT_EQ(Reading(before + "NULL : T { + to f: N = 5. }").errors(), "2:20 bad-target");
  EXPECT_EQ(Reading(before + "NULL : N { }").errors(), "2:8 constant-as-name");
  EXPECT_EQ(Reading(before + "@define M N.").errors(), "2:11 syntax");
}

TEST(Constants, OfTheLibraryAreHiddenByThoseOfTheProgram) {
  Sources sources;
  Diagnostics diagnostics;
  Defines defines;
  const auto read = [&](const char* name, const char* text, bool embedded) {
    return parse(lex(sources, sources.add(name, text, embedded), diagnostics), defines, diagnostics, sources, embedded);
  };
  const auto printed = [](const ast::File& file) { return show(*file.classes.at(0).methods.at(0).body.at(0)); };
  read("first.tz", "@define K 3.", true);
  EXPECT_EQ(printed(read("user.tz", "NULL : T { + to f: print K. }", false)), "(print (const K 3))");
  EXPECT_EQ(printed(read("user.tz", "@define K 4.\nNULL : T { + to f: print K. }", false)), "(print (const K 4))");
  EXPECT_EQ(printed(read("second.tz", "@define K 3.\nNULL : T { + to f: print K. }", true)), "(print (const K 3))");
  EXPECT_EQ(diagnostics.error_count(), 0U);
  read("other.tz", "@define K 5.", false);
  EXPECT_EQ(diagnostics.error_count(), 1U);
}

TEST(Constants, OfTheProgramAreNotSeenByTheLibrary) {
  Sources sources;
  Diagnostics diagnostics;
  Defines defines;
  parse(lex(sources, sources.add("user.tz", "@define x 5."), diagnostics), defines, diagnostics, sources);
  const ast::File file =
      parse(lex(sources, sources.add("library.tz", "NULL : T { + to f at x (int): print x. }", true), diagnostics),
            defines, diagnostics, sources, true);
  EXPECT_EQ(diagnostics.error_count(), 0U);
  EXPECT_EQ(show(*file.classes.at(0).methods.at(0).body.at(0)), "(print x)");
}

TEST(Classes, HeaderClauses) {
  const Reading reading("Object : Kiln (aka Kilns) [version 1.5] { }\nKiln : Oven [version 2.25] {}\nNULL:Root{}");
  EXPECT_EQ(reading.errors(), "");
  ASSERT_EQ(reading.file.classes.size(), 3U);
  const ast::Class& kiln = reading.file.classes[0];
  EXPECT_EQ(kiln.parent, "Object");
  EXPECT_EQ(kiln.name, "Kiln");
  EXPECT_EQ(kiln.alias, "Kilns");
  EXPECT_EQ(kiln.version, 1.5);
  EXPECT_EQ(kiln.name_span.column, 10U);
  EXPECT_EQ(kiln.alias_span.column, 20U);
  EXPECT_EQ(kiln.parent_span.column, 1U);
  EXPECT_EQ(reading.file.classes[1].version, 2.25);
  EXPECT_EQ(reading.file.classes[2].version, 1.0);
  EXPECT_EQ(reading.file.classes[2].parent, "NULL");
}

TEST(Classes, HeaderMistakes) {
  const std::vector<std::pair<std::string, std::string>> rows{
      {"Object : Kiln [version 1] {}", "1:24 syntax"},
      {"Object : Kiln [version 1.0] (aka Ks) {}", "1:29 syntax"},
      {"Object : list {}", "1:10 reserved-word"},
      {"Object : Kiln\n+ to f: return.\n}", "2:1 syntax"},
      {"Object : Kiln {\n+ to f: return.", "1:15 missing-brace"},
      {"Object : Kiln {\n+ to f: return.\nObject : Oven {\n}", "1:15 missing-brace"},
      {"Object : Kiln { 5 }", "1:17 syntax"},
      {"Object : Kiln {\n@use Oven.\n+ to f: n = . }", "2:1 syntax, 3:13 syntax"},
      {"Object : Kiln { } }", "1:19 stray-brace"},
      {"Object : Kiln {\n+ to f: return.\n}\n+ to g: n = 1 }", "3:1 stray-brace, 4:14 missing-period"}};
  for (const auto& [text, errors] : rows) EXPECT_EQ(Reading(text).errors(), errors) << text;
}

TEST(Variables, EveryType) {
  const Reading reading(R"(NULL : T {
  + variables:
    a, b (int). c (float). d (double). e (vector). f (matrix). g (string). h (object). i (Kiln object).
    j (list). k (hash). l (pointer). m (data).
    n (5 ints). o (2 floats). p (1 doubles). q (3 vectors). r (4 matrices). s (2 strings). t (2 objects).
    u (6 Kiln objects). v (2 lists). w (2 hashes). x (2 pointers).
})");
  EXPECT_EQ(reading.errors(), "");
  std::string text;
  for (const ast::Variable& each : reading.only_class().variables) text += each.name + ":" + show(each.type) + " ";
  EXPECT_EQ(
      text,
      "a:int b:int c:double d:double e:vector f:matrix g:string h:object i:Kiln object j:list k:hash l:pointer m:data "
      "n:5 int o:2 double p:1 double q:3 vector r:4 matrix s:2 string t:2 object u:6 Kiln object v:2 list w:2 hash "
      "x:2 pointer ");
}

TEST(Variables, Mistakes) {
  const std::vector<std::pair<std::string, std::string>> rows{
      {"a (flaot).", "2:4 unknown-type"},
      {"a (3 int).", "2:6 syntax"},
      {"a (ints).", "2:4 unknown-type"},
      {"a (3 data).", "2:6 unknown-type"},
      {"a (Kiln objects).", "2:4 unknown-type"},
      {"a (Kiln).", "2:4 unknown-type"},
      {"a = 5 (int).", "2:3 initial-value"},
      {"a int.", "2:3 syntax"},
      {"list (int).", "2:1 reserved-word"},
      {"a (int)\nb (int).", "2:8 missing-period"},
      {"a (.\nb (x).\nc (int).", "2:4 syntax, 3:4 unknown-type"}};
  for (const auto& [text, errors] : rows) {
    EXPECT_EQ(Reading("NULL : T { + variables:\n" + text + "\n}").errors(), errors) << text;
  }
}

TEST(Methods, HeadersOfEveryShape) {
  const Reading reading(R"(NULL : T {
  + to init: return.
  - to fire at target (object) with-power p = 2.5 (float) with-tag t = "std" (string) x x = -3 (int):
    spread (vector).
    hits, misses (int).
    hits = 1.
  =to last
    from a = (1, -2, 3) (vector)
    into b = [ (1,0,0), (0,1,0), (0,0,1) ] (matrix)
    with c (5 ints) to to (Kiln object): # nothing
})");
  EXPECT_EQ(reading.errors(), "");
  ASSERT_EQ(reading.only_class().methods.size(), 3U);
  std::string text;
  for (const ast::Method& method : reading.only_class().methods) {
    text += fmt::format("{}{}(", method.is_public ? "+" : "-", method.name);
    for (const ast::Parameter& each : method.parameters) {
      text += each.keyword + " " + each.variable + (each.default_value ? "=" + show(*each.default_value) : "") + " " +
              show(each.type) + ";";
    }
    text += ")";
    for (const ast::Variable& each : method.locals) text += each.name + ":" + show(each.type) + " ";
  }
  EXPECT_EQ(
      text,
      "+init()-fire(at target object;with-power p=2.5 double;with-tag t=\"std\" string;x x=-3 int;)spread:vector "
      "hits:int "
      "misses:int -last(from a=(1 -2 3) vector;into b=(1 0 0 0 1 0 0 0 1) matrix;with c 5 int;to to Kiln object;)");
  EXPECT_EQ(reading.method(1).body.size(), 1U);
  EXPECT_EQ(reading.method(1).name_span.line, 3U);
  EXPECT_EQ(reading.method(1).name_span.column, 8U);
}

TEST(Methods, HeaderMistakes) {
  const std::vector<std::pair<std::string, std::string>> rows{
      {"+ to f x (int): return.", "2:8 syntax"},
      {"+ to f with x: return.", "2:14 missing-type"},
      {"+ to f with x (int)\n  n = 5.", "2:20 missing-colon"},
      {"+ to f\n  n (int).\n  n = 5.", "2:7 missing-colon"},
      {"+ to f\n  print 5.", "2:7 missing-colon"},
      {"+ to list: return.", "2:6 reserved-word"},
      {"+ to f object x (int): return.", "2:8 reserved-word"},
      {"+ to f with int (int): return.", "2:13 reserved-word"},
      {"+ to f with x = n (int): m = .", "2:17 syntax, 2:30 syntax"},
      {"+ to f with x: (int)\n  print 5.", "2:14 method-header"},
      {"+ to f(x (int)):\n  n = 5.", "2:7 method-header"},
      {"+ to f with x (itn): m = .", "2:16 unknown-type, 2:26 syntax"}};
  for (const auto& [text, errors] : rows) EXPECT_EQ(Reading("NULL : T {\n" + text + "\n}").errors(), errors) << text;
}

TEST(Methods, DeclarationsComeFirst) {
  const Reading reading("NULL : T { + to f:\n n (int).\n n = 1.\n m (list).\n m = n.\n}");
  EXPECT_EQ(reading.errors(), "4:2 late-declaration");
  EXPECT_EQ(reading.method().locals.size(), 2U);
  EXPECT_EQ(reading.method().body.size(), 2U);
  EXPECT_EQ(Reading("NULL : T {\n+ to f: return.\n+ variables:\n n (int).\n}").errors(), "3:1 syntax");
}

TEST(Methods, FunctionCallsAreNoDeclarations) {
  const Reading reading("NULL : T { + to f: sleep(n). sleep (n). x (Kiln object). }");
  EXPECT_EQ(reading.method().body.size(), 2U);
  EXPECT_EQ(reading.errors(), "1:41 late-declaration");
}

TEST(Methods, NativeBodiesBelongToTheLibrary) {
  const std::string text = R"(NULL : T {
  + to a:
    % Says a.
    @native "t.a" (Kiln object).
  + to b with x (int): @native "t.b" (?).
  + to c: @native "t.c".
})";
  const Reading reading(text, true);
  EXPECT_EQ(reading.errors(), "");
  EXPECT_EQ(reading.method(0).native, "t.a");
  EXPECT_EQ(show(*reading.method(0).native_result), "Kiln object");
  EXPECT_EQ(reading.method(0).doc, "Says a.");
  EXPECT_FALSE(reading.method(0).native_dynamic);
  EXPECT_TRUE(reading.method(1).native_dynamic);
  EXPECT_FALSE(reading.method(2).native_result.has_value());
  EXPECT_FALSE(reading.method(2).native_dynamic);
  EXPECT_EQ(Reading(text).errors(), "4:5 syntax, 5:24 syntax, 6:11 syntax");
}

TEST(Documentation, BelongsToTheMethodElseToTheClass) {
  const Reading reading(R"(% The file.
@use Kiln.

% A class.
NULL : T {
  % More on it.
  + section Drawing
  + variables:
    % Unusual.
    n (int).
  % Before f.
  + to f:
    % Inside f.
    n = 1.
    % Later.
    n = 2.
  % Before g.
  + to g:
    % Only words.
  + to h: return.
  % After h.
})");
  EXPECT_EQ(reading.errors(), "");
  EXPECT_EQ(reading.file.doc, "The file.");
  EXPECT_EQ(reading.only_class().doc, "A class.\nMore on it.\nUnusual.");
  EXPECT_EQ(reading.method(0).doc, "Before f.\nInside f.\nLater.");
  EXPECT_EQ(reading.method(1).doc, "Before g.\nOnly words.");
  EXPECT_EQ(reading.method(2).doc, "After h.");
}

TEST(Words, ReservedOnesNameNothing) {
  for (const char* word :
       {"Controller", "aka",      "version", "define",   "int",   "double",  "float",     "vector",  "matrix",
        "object",     "pointer",  "list",    "string",   "data",  "hash",    "ints",      "doubles", "floats",
        "vectors",    "matrices", "objects", "pointers", "lists", "strings", "hashes",    "new",     "random",
        "all",        "super",    "self",    "push",     "pop",   "prepend", "unprepend", "insert",  "remove",
        "sort",       "copylist", "use",     "include",  "path",  "plugin",  "nib_file"}) {
    EXPECT_EQ(Reading(fmt::format("NULL : T {{\n+ variables: {} (int).\n}}", word)).errors(), "2:14 reserved-word")
        << word;
    EXPECT_EQ(Reading(fmt::format("NULL : T {{\n+ to {}: return.\n}}", word)).errors(), "2:6 reserved-word") << word;
  }
  for (const char* word :
       {"in", "onto", "at", "with", "to", "variables", "section", "each", "interface", "NULL", "format", "newest"}) {
    EXPECT_EQ(
        Reading(fmt::format("NULL : T {{ + variables: {0} (int). + to {0} {0} {0} (int): {0} = {0} + 1. }}", word))
            .errors(),
        "")
        << word;
  }
}

}  // namespace
}  // namespace breve::steve::test
