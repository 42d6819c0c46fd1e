// An editor as the language server sees it: a process at the other end of two pipes.
#pragma once

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <deque>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace breve::test {

using nlohmann::json;

class Editor {
 public:
  Editor() {
    std::signal(SIGPIPE, SIG_IGN);
    int in[2], out[2];
    if (pipe(in) != 0 || pipe(out) != 0) throw std::runtime_error("no pipes");
    folder_ = std::filesystem::temp_directory_path() / ("breve_lsp_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    process_ = fork();
    if (process_ == 0) {
      dup2(in[0], STDIN_FILENO);
      dup2(out[1], STDOUT_FILENO);
      for (const int end : {in[0], in[1], out[0], out[1]}) close(end);
      setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
      execl(BREVE_COMMAND, "breve", "lsp", static_cast<char*>(nullptr));
      _exit(127);
    }
    close(in[0]);
    close(out[1]);
    to_ = in[1];
    from_ = out[0];
  }
  ~Editor() {
    hang_up();
    close(from_);
    if (process_ > 0) {
      kill(process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Editor(const Editor&) = delete;
  Editor& operator=(const Editor&) = delete;

  void send_bytes(const std::string& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t written = write(to_, bytes.data() + done, bytes.size() - done);
      if (written <= 0) return;
      done += static_cast<std::size_t>(written);
    }
  }
  void send_text(const std::string& body) {
    send_bytes("Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
  }
  void notify(const std::string& method, const json& params) {
    send_text(json{{"jsonrpc", "2.0"}, {"method", method}, {"params", params}}.dump());
  }
  /// The answer to a request, whole; what else comes first is kept for `next_notification`.
  json ask(const std::string& method, const json& params) {
    const int id = ++last_id_;
    send_text(json{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}}.dump());
    return answer(id);
  }
  json answer(const json& id) {
    for (;;) {
      const std::optional<json> message = read();
      if (!message) return "the server is gone";
      if (message->contains("id") && (*message)["id"] == id) return *message;
      notifications_.push_back(*message);
    }
  }
  json result(const std::string& method, const json& params) {
    const json whole = ask(method, params);
    EXPECT_TRUE(whole.contains("result")) << whole;
    return whole.contains("result") ? whole["result"] : json();
  }
  json next_notification() {
    if (notifications_.empty()) {
      const std::optional<json> message = read();
      return message ? *message : json("the server is gone");
    }
    json message = notifications_.front();
    notifications_.pop_front();
    return message;
  }
  /// The diagnostics that are published next, which must be of that file.
  json diagnostics(const std::string& uri) {
    const json message = next_notification();
    EXPECT_EQ(message.value("method", ""), "textDocument/publishDiagnostics") << message;
    const json params = message.value("params", json::object());
    EXPECT_EQ(params.value("uri", ""), uri) << message;
    return params.value("diagnostics", json::array());
  }

  void initialize() {
    const json capabilities = {{"textDocument", {{"completion", {{"completionItem", {{"snippetSupport", true}}}}}}}};
    result("initialize", {{"capabilities", capabilities}});
    notify("initialized", json::object());
  }
  /// Open a text and give its diagnostics.
  json open(const std::string& name, const std::string& text) {
    notify("textDocument/didOpen", {{"textDocument", {{"uri", uri(name)}, {"version", 1}, {"text", text}}}});
    return diagnostics(uri(name));
  }
  json change(const std::string& name, const json& changes) {
    notify("textDocument/didChange",
           {{"textDocument", {{"uri", uri(name)}, {"version", 2}}}, {"contentChanges", changes}});
    return diagnostics(uri(name));
  }
  json at(const std::string& name, int line, int character) const {
    return {{"textDocument", {{"uri", uri(name)}}}, {"position", {{"line", line}, {"character", character}}}};
  }
  std::string uri(const std::string& name) const { return "file://" + (folder_ / name).string(); }
  const std::filesystem::path& folder() const { return folder_; }

  void hang_up() {
    if (to_ >= 0) close(to_);
    to_ = -1;
  }
  /// The exit status; -1 if a signal ended it.
  int status() {
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  // A server that says nothing for this long is stuck.
  static constexpr int kPatience = 120'000;  // ms

  std::optional<json> read() {
    for (;;) {
      const std::size_t head = buffer_.find("\r\n\r\n");
      if (head != std::string::npos) {
        const std::size_t size = std::stoul(buffer_.substr(buffer_.find(':') + 1));
        if (buffer_.size() >= head + 4 + size) {
          const json message = json::parse(buffer_.substr(head + 4, size));
          buffer_.erase(0, head + 4 + size);
          return message;
        }
      }
      pollfd output{from_, POLLIN, 0};
      if (poll(&output, 1, kPatience) <= 0) return std::nullopt;
      char chunk[4096];
      const ssize_t count = ::read(from_, chunk, sizeof chunk);
      if (count <= 0) return std::nullopt;
      buffer_.append(chunk, static_cast<std::size_t>(count));
    }
  }

  std::filesystem::path folder_;
  pid_t process_ = 0;
  int to_ = -1, from_ = -1, last_id_ = 0;
  std::string buffer_;
  std::deque<json> notifications_;
};

}  // namespace breve::test
