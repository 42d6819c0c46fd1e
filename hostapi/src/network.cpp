// The network that a host's callbacks give, as the machine uses it: recorded, or replayed from a log.
#include <map>

#include "internal.hpp"

namespace breve::host {

namespace {

using steve::NetworkAnswer;
using steve::NetworkRequest;
using enum Inputs::Kind;

/// How many servers a world has open. The process has a bounded number of ports and threads.
constexpr std::size_t kMostServers = 16;

/// Closes the server once.
class OpenServer {
 public:
  OpenServer(const breve_server& server, ObjectId owner) : server_(server), owner_(owner) { server_.url = nullptr; }
  ~OpenServer() {
    if (server_.close) server_.close(server_.handle);
  }
  OpenServer(const OpenServer&) = delete;
  OpenServer& operator=(const OpenServer&) = delete;
  const breve_server& functions() const { return server_; }
  ObjectId owner() const { return owner_; }  // the object that opened it

 private:
  breve_server server_;
  ObjectId owner_;
};

std::string packed(const NetworkRequest& request) {
  LogWriter log;
  for (const std::string* part : {&request.method, &request.target, &request.from, &request.body}) log.text(*part);
  return log.bytes();
}

NetworkRequest unpacked(std::string_view bytes) {
  LogReader log(bytes);
  NetworkRequest request;
  for (std::string* part : {&request.method, &request.target, &request.from, &request.body}) *part = log.text();
  return request;
}

class HostNetwork final : public steve::Network {
 public:
  explicit HostNetwork(breve_world& world) : world_(world), callbacks_(world.runtime->config.network) {}

  bool allowed() const override {
    if (!is_replay()) return callbacks_.listen || callbacks_.fetch;
    const Inputs& inputs = *world_.inputs;
    return inputs.is_next(Opened) || inputs.is_next(NotOpened) || inputs.is_next(Fetched) || inputs.is_next(NotFetched);
  }
  std::optional<std::string> fetch(const std::string& method, const std::string& url, std::string_view body,
                                   std::string& why) override {
    if (is_replay()) return replayed(Fetched, NotFetched, why);
    Answer answer;
    const bool fetched = [&] {
      const CallbackScope busy(world_);
      return callbacks_.fetch && callbacks_.fetch(callbacks_.user, &world_, method.c_str(), url.c_str(), body.data(),
                                                  body.size(), &Answer::add, &answer);
    }();
    std::string text = callbacks_.fetch ? answer.text() : "the host lets scripts send no requests";
    note(fetched ? Fetched : NotFetched, text);
    if (fetched) return text;
    why = std::move(text);
    return std::nullopt;
  }

  std::optional<std::string> listen(std::uint16_t port, ObjectId owner, std::string& why) override {
    if (is_replay()) return replayed(Opened, NotOpened, why);
    std::optional<std::string> url = open(port, owner, why);
    note(url ? Opened : NotOpened, url ? *url : why);
    return url;
  }

  std::optional<NetworkRequest> next_request(const std::string& server, ObjectId owner) override {
    if (is_replay()) {
      const auto recorded = world_.inputs->next(Request);
      return recorded ? std::optional(unpacked(*recorded)) : std::nullopt;
    }
    std::optional<NetworkRequest> request = take(server, owner);
    note(request ? Request : Failed, request ? packed(*request) : std::string());
    return request;
  }

  void answer(const std::string& server, const NetworkAnswer& answer) override {
    const auto open = servers_.find(server);
    if (is_replay() || open == servers_.end()) return;
    const breve_server& functions = open->second->functions();
    if (!functions.answer) return;
    const breve_response response{static_cast<std::uint32_t>(answer.status), answer.type.c_str(), answer.body.data(),
                                  answer.body.size()};
    const CallbackScope busy(world_);
    functions.answer(functions.handle, &response);
  }

  void close(const std::string& server, ObjectId owner) override {
    if (is_replay()) return;
    const auto open = servers_.find(server);
    if (open != servers_.end() && open->second->owner() == owner) servers_.erase(open);
  }

 private:
  bool is_replay() const { return world_.inputs && world_.inputs->replaying(); }
  void note(Inputs::Kind kind, std::string_view bytes) {
    if (world_.inputs) world_.inputs->add(kind, bytes);
  }
  /// What succeeded when it was recorded, or why it did not.
  std::optional<std::string> replayed(Inputs::Kind well, Inputs::Kind badly, std::string& why) {
    const bool failed = world_.inputs->is_next(badly);
    const auto recorded = world_.inputs->next(failed ? badly : well);
    if (recorded && !failed) return std::string(*recorded);
    why = recorded ? std::string(*recorded) : "it was not done in the recorded run";
    return std::nullopt;
  }

  std::optional<std::string> open(std::uint16_t port, ObjectId owner, std::string& why) {
    if (servers_.size() >= kMostServers) {
      why = "16 servers are open, and a world may have no more: close those that are not needed";
      return std::nullopt;
    }
    if (!callbacks_.listen) {
      why = "the host lets scripts open no servers";
      return std::nullopt;
    }
    Answer reason;
    breve_server server{};
    const bool opened = [&] {
      const CallbackScope busy(world_);
      return callbacks_.listen(callbacks_.user, &world_, port, &server, &Answer::add, &reason);
    }();
    if (!opened) {
      why = reason.text();
      return std::nullopt;
    }
    std::string url = server.url ? server.url : "";
    auto whole = std::make_unique<OpenServer>(server, owner);
    if (url.empty() || !server.next) {
      why = "the host opened it without the required function or address";
      return std::nullopt;
    }
    servers_[url] = std::move(whole);
    return url;
  }

  std::optional<NetworkRequest> take(const std::string& server, ObjectId owner) {
    const auto open = servers_.find(server);
    if (open == servers_.end() || open->second->owner() != owner) return std::nullopt;
    const breve_server& functions = open->second->functions();
    breve_request asked{};
    const CallbackScope busy(world_);
    if (!functions.next(functions.handle, &asked)) return std::nullopt;
    NetworkRequest request;
    if (asked.method) request.method = asked.method;
    if (asked.target) request.target = asked.target;
    if (asked.from) request.from = asked.from;
    if (asked.body) request.body.assign(static_cast<const char*>(asked.body), asked.body_size);
    return request;
  }

  breve_world& world_;
  const breve_network& callbacks_;
  std::map<std::string, std::unique_ptr<OpenServer>> servers_;  // by their addresses
};

}  // namespace

std::shared_ptr<steve::Network> network_of(breve_world& world) { return std::make_shared<HostNetwork>(world); }

}  // namespace breve::host
