// The language server, driven as an editor drives it.
#include "editor.hpp"

namespace breve::test {
namespace {

// Lines are counted from 0.
const std::string kProgram = R"(@use Control.
Controller Field.

Mobile : Bird {
  % A bird.
  + to fly to place (vector) with-speed speed = 1.5 (float):
    % Fly somewhere.
    print "größer 🐦 $place", speed.
}

Control : Field {
  + variables:
    bird (object).

  + to init:
    bird = new Bird.
    bird fly to (1, 2, 3).
}
)";

std::vector<std::string> labels(const json& completion) {
  std::vector<std::string> names;
  for (const json& item : completion.at("items")) names.push_back(item.at("label"));
  return names;
}

TEST(LanguageServer, SaysWhatItCanAndEndsWhenAsked) {
  Editor editor;
  const json result = editor.result("initialize", {{"capabilities", json::object()}});
  EXPECT_EQ(result["serverInfo"]["name"], "breve");
  EXPECT_EQ(result["capabilities"]["textDocumentSync"]["change"], 2);
  editor.notify("initialized", json::object());
  EXPECT_TRUE(editor.result("shutdown", nullptr).is_null());
  editor.notify("exit", nullptr);
  EXPECT_EQ(editor.status(), 0);
}

TEST(LanguageServer, WithoutShutdownTheEndIsAFailure) {
  Editor closed;
  closed.initialize();
  closed.hang_up();
  EXPECT_EQ(closed.status(), 1);
  Editor left;
  left.notify("exit", nullptr);
  EXPECT_EQ(left.status(), 1);
}

TEST(LanguageServer, ShowsErrorsAsTheyAreTypedAndTakesThemAway) {
  Editor editor;
  editor.initialize();
  EXPECT_EQ(editor.open("main.tz", kProgram), json::array());
  // `bird` becomes `burd` on line 16.
  const json range = {{"start", {{"line", 16}, {"character", 5}}}, {"end", {{"line", 16}, {"character", 6}}}};
  const json errors = editor.change("main.tz", {{{"range", range}, {"text", "u"}}});
  ASSERT_EQ(errors.size(), 1U) << errors;
  EXPECT_EQ(errors[0]["severity"], 1);
  EXPECT_EQ(errors[0]["code"], "unknown-variable");
  EXPECT_EQ(errors[0]["range"]["start"], (json{{"line", 16}, {"character", 4}}));
  EXPECT_EQ(errors[0]["range"]["end"], (json{{"line", 16}, {"character", 8}}));
  EXPECT_NE(errors[0]["message"].get<std::string>().find("did you mean 'bird'?"), std::string::npos) << errors;
  EXPECT_EQ(editor.change("main.tz", {{{"range", range}, {"text", "i"}}}), json::array());
  EXPECT_EQ(editor.change("main.tz", {{{"text", "Object : A {"}}}).size(), 1U);
  editor.notify("textDocument/didClose", {{"textDocument", {{"uri", editor.uri("main.tz")}}}});
  EXPECT_EQ(editor.diagnostics(editor.uri("main.tz")), json::array());
}

TEST(LanguageServer, SeveralChangesApplyInOrder) {
  Editor editor;
  editor.initialize();
  editor.open("main.tz", "# one\n# two\n");
  const json first = {{"start", {{"line", 0}, {"character", 0}}}, {"end", {{"line", 1}, {"character", 0}}}};
  const json then = {{"start", {{"line", 0}, {"character", 2}}}, {"end", {{"line", 9}, {"character", 9}}}};
  editor.notify("textDocument/didChange",
                {{"textDocument", {{"uri", editor.uri("main.tz")}, {"version", 2}}},
                 {"contentChanges", {{{"range", first}, {"text", "@"}}, {{"range", then}, {"text", "x."}}}}});
  const json errors = editor.diagnostics(editor.uri("main.tz"));  // the text is "@#x." now
  ASSERT_GE(errors.size(), 1U) << errors;
  EXPECT_EQ(errors[0]["range"]["start"]["line"], 0);
}

TEST(LanguageServer, ColumnsAreInUtf16) {
  Editor editor;
  editor.initialize();
  editor.open("main.tz", kProgram);
  // In `    print "größer 🐦 $place"` the name begins behind 4 + 6 + 1 + 7 + 2 + 1 + 1 units.
  const json hover = editor.result("textDocument/hover", editor.at("main.tz", 7, 23));
  ASSERT_TRUE(hover.is_object()) << hover;
  EXPECT_EQ(hover["range"]["start"]["character"], 22) << hover;
  EXPECT_EQ(hover["range"]["end"]["character"], 27) << hover;
  EXPECT_NE(hover["contents"]["value"].get<std::string>().find("place (vector)"), std::string::npos) << hover;
}

TEST(LanguageServer, HoverShowsSignatureAndDocumentation) {
  Editor editor;
  editor.initialize();
  editor.open("main.tz", kProgram);
  const auto shown = [&](int line, int character) {
    const json hover = editor.result("textDocument/hover", editor.at("main.tz", line, character));
    return hover.is_null() ? std::string("nothing") : hover["contents"]["value"].get<std::string>();
  };
  EXPECT_EQ(shown(16, 10),
            "```steve\nfly to place (vector) with-speed speed = 1.5 (float)\n```\nof class Bird\n\nFly somewhere.\n");
  EXPECT_NE(shown(15, 5).find("seems to hold: Bird object"), std::string::npos) << shown(15, 5);
  EXPECT_NE(shown(3, 2).find("Real : Mobile"), std::string::npos);
  EXPECT_NE(shown(15, 12).find("A new object"), std::string::npos);
  EXPECT_EQ(shown(2, 0), "nothing");
  EXPECT_EQ(shown(999, 0), "nothing");
}

TEST(LanguageServer, DefinitionsLeadIntoTheProgramAndTheClassLibrary) {
  Editor editor;
  editor.initialize();
  editor.open("main.tz", kProgram);
  const json own = editor.result("textDocument/definition", editor.at("main.tz", 16, 10));
  ASSERT_EQ(own.size(), 1U);
  EXPECT_EQ(own[0]["uri"], editor.uri("main.tz"));
  EXPECT_EQ(own[0]["range"]["start"], (json{{"line", 5}, {"character", 7}}));
  const json library = editor.result("textDocument/definition", editor.at("main.tz", 3, 2));
  ASSERT_EQ(library.size(), 1U);
  const std::string uri = library[0]["uri"];
  ASSERT_NE(uri.find("/Mobile.tz"), std::string::npos);
  const std::filesystem::path path = uri.substr(7);
  std::ifstream file(path);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_NE(text.find("Real : Mobile"), std::string::npos);
  // Shown in the editor it is itself, and no program with errors.
  editor.notify("textDocument/didOpen", {{"textDocument", {{"uri", uri}, {"version", 1}, {"text", text}}}});
  EXPECT_EQ(editor.diagnostics(uri), json::array());
  const int line = library[0]["range"]["start"]["line"];
  const json parent = editor.result(
      "textDocument/definition", {{"textDocument", {{"uri", uri}}}, {"position", {{"line", line}, {"character", 1}}}});
  ASSERT_EQ(parent.size(), 1U);
  EXPECT_NE(parent[0]["uri"].get<std::string>().find("/Real.tz"), std::string::npos);
}

TEST(LanguageServer, CompletesSelectorsKeywordsAndClassesInHalfWrittenStatements) {
  Editor editor;
  editor.initialize();
  editor.open("main.tz", kProgram);
  const auto offered = [&](const std::string& typed) {
    editor.notify(
        "textDocument/didChange",
        {{"textDocument", {{"uri", editor.uri("main.tz")}, {"version", 3}}},
         {"contentChanges",
          {{{"range", {{"start", {{"line", 16}, {"character", 0}}}, {"end", {{"line", 17}, {"character", 0}}}}},
            {"text", typed + "\n"}}}}});
    return editor.result("textDocument/completion", editor.at("main.tz", 16, static_cast<int>(typed.size())));
  };
  const json selector = offered("    bird fl");
  ASSERT_EQ(labels(selector), std::vector<std::string>{"fly"});
  EXPECT_EQ(selector["items"][0]["textEdit"]["newText"], "fly to ${1:place}");
  EXPECT_EQ(selector["items"][0]["textEdit"]["range"]["start"]["character"], 9);
  EXPECT_EQ(selector["items"][0]["insertTextFormat"], 2);
  EXPECT_EQ(labels(offered("    bird fly ")), (std::vector<std::string>{"to", "with-speed"}));
  EXPECT_EQ(labels(offered("    bird = new Bi")), std::vector<std::string>{"Bird"});
  EXPECT_EQ(labels(offered("    # bird ")), std::vector<std::string>{});
}

TEST(LanguageServer, ABlankAsksOnlyWhereANameMustFollow) {
  Editor editor;
  editor.initialize();
  editor.open("main.tz", kProgram);
  json at = editor.at("main.tz", 15, 11);  // behind `bird = `
  EXPECT_FALSE(editor.result("textDocument/completion", at)["items"].empty());
  at["context"] = {{"triggerKind", 2}, {"triggerCharacter", " "}};
  EXPECT_TRUE(editor.result("textDocument/completion", at)["items"].empty());
  at["position"] = {{"line", 16}, {"character", 9}};  // behind `bird `
  EXPECT_FALSE(editor.result("textDocument/completion", at)["items"].empty());
}

TEST(LanguageServer, HelpsWithTheKeywordsOfACall) {
  Editor editor;
  editor.initialize();
  editor.open("main.tz", kProgram);
  const json help = editor.result("textDocument/signatureHelp", editor.at("main.tz", 16, 20));
  ASSERT_TRUE(help.is_object());
  EXPECT_EQ(help["signatures"][0]["label"], "fly to place (vector) with-speed speed = 1.5 (float)");
  EXPECT_EQ(help["signatures"][0]["activeParameter"], 0);
  EXPECT_EQ(help["signatures"][0]["parameters"][1]["label"], "with-speed speed = 1.5 (float)");
  EXPECT_TRUE(editor.result("textDocument/signatureHelp", editor.at("main.tz", 2, 0)).is_null());
}

TEST(LanguageServer, OutlinesAFileAndFindsUses) {
  Editor editor;
  editor.initialize();
  editor.open("main.tz", kProgram);
  const json outline =
      editor.result("textDocument/documentSymbol", {{"textDocument", {{"uri", editor.uri("main.tz")}}}});
  ASSERT_EQ(outline.size(), 2U);
  EXPECT_EQ(outline[0]["name"], "Bird");
  EXPECT_EQ(outline[0]["children"][0]["name"], "fly");
  EXPECT_EQ(outline[1]["children"][0]["name"], "bird");
  const json uses = editor.result("textDocument/references", editor.at("main.tz", 5, 8));
  ASSERT_EQ(uses.size(), 2U);
  EXPECT_EQ(uses[1]["range"]["start"]["line"], 16);
  json others = editor.at("main.tz", 5, 8);
  others["context"] = {{"includeDeclaration", false}};
  EXPECT_EQ(editor.result("textDocument/references", others).size(), 1U);
}

TEST(LanguageServer, FilesOfOneProgramAreTakenFromTheEditorBeforeTheDisk) {
  Editor editor;
  editor.initialize();
  std::ofstream(editor.folder() / "part.tz") << "Mobile : Old { }\n";
  const std::string main =
      "@use Control.\n@include \"part.tz\".\nController F.\nControl : F {\n  + to init: new Fresh.\n}\n";
  const json alone = editor.open("main.tz", main);
  ASSERT_EQ(alone.size(), 1U);
  EXPECT_EQ(alone[0]["code"], "lint-unknown-class");
  // The part alone names no controller, and uses a class of the main file: it is judged as part of that.
  editor.notify(
      "textDocument/didOpen",
      {{"textDocument",
        {{"uri", editor.uri("part.tz")}, {"version", 1}, {"text", "Mobile : Fresh {\n  + to hop: new F.\n}\n"}}}});
  EXPECT_EQ(editor.diagnostics(editor.uri("main.tz")), json::array());
  EXPECT_EQ(editor.diagnostics(editor.uri("part.tz")), json::array());
  const json definition = editor.result("textDocument/definition", editor.at("main.tz", 4, 18));
  ASSERT_EQ(definition.size(), 1U);
  EXPECT_EQ(definition[0]["uri"], editor.uri("part.tz"));
}

TEST(LanguageServer, MistakesInMessagesHaveDefinedAnswers) {
  Editor editor;
  const auto code_of = [](const json& message) { return message.value("error", json::object()).value("code", 0); };
  EXPECT_EQ(code_of(editor.ask("textDocument/hover", json::object())), -32002);
  editor.initialize();
  editor.open("main.tz", kProgram);
  EXPECT_EQ(code_of(editor.ask("no/such", json::object())), -32601);
  EXPECT_EQ(code_of(editor.ask("textDocument/hover", json::object())), -32602);
  EXPECT_EQ(code_of(editor.ask("textDocument/hover", json::array({1}))), -32602);
  EXPECT_EQ(code_of(editor.ask("textDocument/hover", {{"textDocument", 5}, {"position", "x"}})), -32602);
  EXPECT_EQ(code_of(editor.ask("initialize", json::object())), -32600);
  editor.send_text("this is not JSON");
  EXPECT_EQ(code_of(editor.answer(nullptr)), -32700);
  editor.send_text("[1, 2]");
  EXPECT_EQ(code_of(editor.answer(nullptr)), -32600);
  editor.send_text("{\"jsonrpc\":\"2.0\",\"id\":{},\"method\":\"shutdown\"}");
  EXPECT_EQ(code_of(editor.answer(nullptr)), -32600);
  editor.send_text(std::string(1 << 20, '['));
  EXPECT_EQ(code_of(editor.answer(nullptr)), -32700);
  editor.send_text("{\"jsonrpc\":\"2.0\",\"method\":\"\xFF\"}");
  EXPECT_EQ(code_of(editor.answer(nullptr)), -32700);
  editor.send_bytes("Content-Length: many\r\n\r\n");
  EXPECT_EQ(code_of(editor.answer(nullptr)), -32700);
  editor.send_bytes("nonsense\r\n");
  EXPECT_EQ(code_of(editor.answer(nullptr)), -32700);
  editor.notify("no/such", {{"x", 1}});
  editor.notify("textDocument/didChange", {{"textDocument", {{"uri", "file:///nowhere.tz"}}}, {"contentChanges", 1}});
  editor.notify("textDocument/didOpen", json::object());
  // After all this it still works.
  EXPECT_TRUE(editor.result("textDocument/hover", editor.at("main.tz", 16, 10)).is_object());
  EXPECT_TRUE(editor.result("shutdown", nullptr).is_null());
  EXPECT_EQ(code_of(editor.ask("textDocument/hover", editor.at("main.tz", 16, 10))), -32600);
}

TEST(LanguageServer, AMessageThatIsTooLargeIsReadOver) {
  Editor editor;
  editor.initialize();
  const std::size_t size = (std::size_t{64} << 20) + 1;
  editor.send_bytes("Content-Length: " + std::to_string(size) + "\r\n\r\n");
  const std::string piece(1 << 20, 'x');
  for (std::size_t sent = 0; sent < size; sent += piece.size())
    editor.send_bytes(piece.substr(0, std::min(piece.size(), size - sent)));
  EXPECT_EQ(editor.answer(nullptr)["error"]["code"], -32600);
  EXPECT_TRUE(editor.result("shutdown", nullptr).is_null());
}

TEST(LanguageServer, TextsThatAreNotUtf8OnDiskDoNotStopIt) {
  Editor editor;
  editor.initialize();
  std::ofstream(editor.folder() / "part.tz") << "Object : Latin {\n  % gr\xFC\xDF dich\n  + to hop: print 1.\n}\n";
  editor.open("main.tz", "@include \"part.tz\"\nController Latin.\n");
  const json hover = editor.result("textDocument/hover", editor.at("main.tz", 1, 12));
  ASSERT_TRUE(hover.is_object()) << hover;
  EXPECT_NE(hover["contents"]["value"].get<std::string>().find("dich"), std::string::npos);
}

}  // namespace
}  // namespace breve::test
