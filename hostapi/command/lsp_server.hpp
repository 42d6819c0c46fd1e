// The server's side of the conversation: who may ask what when, and what every mistake is answered with.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "lsp_features.hpp"
#include "lsp_transport.hpp"
#include "lsp_workspace.hpp"

namespace breve::command {

class LspServer {
 public:
  LspServer(LspTransport& transport, std::vector<std::string> paths)
      : transport_(transport), workspace_(std::move(paths)), features_(workspace_) {}

  /// @return  the exit status: 0 if `exit` came after `shutdown`
  int run();

 private:
  using json = nlohmann::json;

  void message(const std::string& text);
  void request(const std::string& method, const json& id, const json& params);
  void notification(const std::string& method, const json& params);
  json initialize(const json& params);
  void did_open(const json& params);
  void did_change(const json& params);
  void publish();
  void send(const json& message);
  void fail(const json& id, int code, const std::string& what);

  LspTransport& transport_;
  LspWorkspace workspace_;
  LspFeatures features_;
  std::map<std::string, json> published_;  // what the editor shows
  bool initialized_ = false, shut_down_ = false, exit_ = false, changed_ = false, gone_ = false;
};

}  // namespace breve::command
