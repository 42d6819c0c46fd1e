// JSON-RPC: requests are answered, notifications are not, and nothing that an editor sends stops the server.
#include "lsp_server.hpp"

#include <exception>
#include <stdexcept>

#include "lsp.hpp"
#include "lsp_text.hpp"

namespace breve::command {

namespace {

using nlohmann::json;

// Of JSON-RPC and of the protocol.
constexpr int kParseError = -32700;
constexpr int kInvalidRequest = -32600;
constexpr int kMethodNotFound = -32601;
constexpr int kInvalidParams = -32602;
constexpr int kInternalError = -32603;
constexpr int kNotInitialized = -32002;

// Values are copied and freed by recursion. No message of the protocol is a tenth as deep.
constexpr int kDeepestMessage = 200;

using Answer = json (LspFeatures::*)(const json&);

const std::map<std::string, Answer, std::less<>>& answers() {
  static const std::map<std::string, Answer, std::less<>> kAnswers = {
      {"textDocument/hover", &LspFeatures::hover},
      {"textDocument/definition", &LspFeatures::definition},
      {"textDocument/references", &LspFeatures::references},
      {"textDocument/completion", &LspFeatures::completion},
      {"textDocument/signatureHelp", &LspFeatures::signature_help},
      {"textDocument/documentSymbol", &LspFeatures::document_symbols},
  };
  return kAnswers;
}

}  // namespace

int LspServer::run() {
  while (!exit_ && !gone_) {
    const Incoming incoming = transport_.read();
    switch (incoming.kind) {
      case Incoming::Kind::End: return shut_down_ ? 0 : 1;
      case Incoming::Kind::Malformed: fail(nullptr, kParseError, incoming.text); break;
      case Incoming::Kind::TooLarge: fail(nullptr, kInvalidRequest, incoming.text); break;
      case Incoming::Kind::Message: message(incoming.text); break;
    }
    // While keys are being typed faster than programs are read, only the last state is worth reading.
    if (changed_ && !exit_ && !transport_.more_waits()) publish();
  }
  return shut_down_ && !gone_ ? 0 : 1;
}

void LspServer::message(const std::string& text) {
  json message;
  try {
    message = json::parse(text, [](int depth, json::parse_event_t, json&) {
      if (depth > kDeepestMessage) throw std::length_error("this JSON is nested too deeply");
      return true;
    });
  } catch (const json::exception&) {
    return fail(nullptr, kParseError, "this is not JSON");
  } catch (const std::length_error& e) {
    return fail(nullptr, kParseError, e.what());
  }
  const bool named = message.is_object() && message.contains("method") && message["method"].is_string();
  const bool is_request = message.is_object() && message.contains("id");
  const json id = is_request ? message["id"] : json(nullptr);
  if (is_request && !(id.is_string() || id.is_number() || id.is_null()))
    return fail(nullptr, kInvalidRequest, "an id is a number or a string");
  if (!named) {
    // Answers to requests of ours would look so; there are none.
    if (is_request && (message.contains("result") || message.contains("error"))) return;
    return fail(id, kInvalidRequest, "a message has a method");
  }
  const std::string method = message["method"];
  const json params = message.value("params", json::object());
  try {
    if (is_request) return request(method, id, params);
    notification(method, params);
  } catch (const json::exception& e) {
    if (is_request) fail(id, kInvalidParams, std::string("these parameters do not fit: ") + e.what());
  } catch (const std::exception& e) {
    if (is_request) fail(id, kInternalError, e.what());
  }
}

void LspServer::request(const std::string& method, const json& id, const json& params) {
  if (method == "initialize") {
    if (initialized_) return fail(id, kInvalidRequest, "the server is initialized already");
    return send({{"jsonrpc", "2.0"}, {"id", id}, {"result", initialize(params)}});
  }
  if (!initialized_) return fail(id, kNotInitialized, "the first request must be 'initialize'");
  if (shut_down_) return fail(id, kInvalidRequest, "the server is shut down");
  if (method == "shutdown") {
    shut_down_ = true;
    return send({{"jsonrpc", "2.0"}, {"id", id}, {"result", nullptr}});
  }
  const auto answer = answers().find(method);
  if (answer == answers().end()) return fail(id, kMethodNotFound, "there is no method '" + method + "'");
  send({{"jsonrpc", "2.0"}, {"id", id}, {"result", (features_.*answer->second)(params)}});
}

json LspServer::initialize(const json& params) {
  const json text = params.value("capabilities", json::object()).value("textDocument", json::object());
  const json item = text.value("completion", json::object()).value("completionItem", json::object());
  features_.set_snippets(item.value("snippetSupport", false));
  initialized_ = true;
  constexpr int kIncremental = 2;
  return {{"serverInfo", {{"name", "breve"}, {"version", breve_version()}}},
          {"capabilities",
           {{"positionEncoding", "utf-16"},
            {"textDocumentSync", {{"openClose", true}, {"change", kIncremental}, {"save", true}}},
            {"hoverProvider", true},
            {"definitionProvider", true},
            {"referencesProvider", true},
            {"documentSymbolProvider", true},
            {"completionProvider", {{"triggerCharacters", {" ", ":", "@", "$", "("}}}},
            {"signatureHelpProvider", {{"triggerCharacters", {" "}}}}}}};
}

void LspServer::notification(const std::string& method, const json& params) {
  if (method == "exit") {
    exit_ = true;
    return;
  }
  if (!initialized_ || shut_down_) return;
  if (method == "textDocument/didOpen") {
    did_open(params);
  } else if (method == "textDocument/didChange") {
    did_change(params);
  } else if (method == "textDocument/didClose") {
    workspace_.close(params.at("textDocument").at("uri").get<std::string>());
    changed_ = true;
  } else if (method == "textDocument/didSave" || method == "workspace/didChangeWatchedFiles") {
    workspace_.forget_programs();
    changed_ = true;
  }
}

void LspServer::did_open(const json& params) {
  const json& document = params.at("textDocument");
  workspace_.open(document.at("uri").get<std::string>(), document.at("text").get<std::string>());
  changed_ = true;
}

// Each change is to the text that the one before left.
void LspServer::did_change(const json& params) {
  const std::string uri = params.at("textDocument").at("uri").get<std::string>();
  const std::string* before = workspace_.text(uri);
  if (before == nullptr) return;
  std::string text = *before;
  for (const json& change : params.at("contentChanges")) {
    const std::string added = change.at("text").get<std::string>();
    if (!change.contains("range")) {
      text = added;
      continue;
    }
    const auto offset = [&](const char* which) {
      const json& where = change.at("range").at(which);
      return offset_of(text, where.at("line").get<std::size_t>(), where.at("character").get<std::size_t>());
    };
    const std::size_t start = offset("start"), end = std::max(start, offset("end"));
    text.replace(start, end - start, added);
  }
  workspace_.change(uri, std::move(text));
  changed_ = true;
}

// Only what changed since the last time; for a file without any diagnostics left, an empty list is sent once.
void LspServer::publish() {
  changed_ = false;
  std::map<std::string, json> now = features_.diagnostics();
  for (const auto& [uri, list] : published_)
    if (now.find(uri) == now.end()) now.emplace(uri, json::array());
  for (auto& [uri, list] : now) {
    const auto before = published_.find(uri);
    if (before != published_.end() && before->second == list) continue;
    send({{"jsonrpc", "2.0"},
          {"method", "textDocument/publishDiagnostics"},
          {"params", {{"uri", uri}, {"diagnostics", list}}}});
    published_[uri] = list;
  }
  for (auto entry = published_.begin(); entry != published_.end();)
    entry = entry->second.empty() && !workspace_.is_open(entry->first) ? published_.erase(entry) : std::next(entry);
}

void LspServer::fail(const json& id, int code, const std::string& what) {
  send({{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", what}}}});
}

// Texts of programs may hold bytes that are not UTF-8: they are shown as the sign for that.
void LspServer::send(const json& message) {
  gone_ = !transport_.write(message.dump(-1, ' ', false, json::error_handler_t::replace)) || gone_;
}

int lsp(const LspOptions& options) {
  LspTransport transport;
  return LspServer(transport, options.paths).run();
}

}  // namespace breve::command
