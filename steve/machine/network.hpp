// The network of scripts. A machine reaches it through whoever embeds it, or not at all.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/base/ids.hpp"

namespace breve::steve {

/// What a peer asks of a server.
struct NetworkRequest {
  std::string method;  // "GET"
  std::string target;  // "/": the path as it was sent
  std::string body;
  std::string from;  // the peer's address
};

/// What it gets.
struct NetworkAnswer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
};

/// The network, as the host gives it to a world. A server is named by its address, "http://127.0.0.1:8080". It is of
/// use only to the object that opened it: an address is not a secret, and others can have it in a variable.
class Network {
 public:
  virtual ~Network() = default;
  /// The host lets scripts open servers or send requests; in a replay, it let them.
  virtual bool allowed() const = 0;
  /// The body of the answer; none with a reason.
  virtual std::optional<std::string> fetch(const std::string& method, const std::string& url, std::string_view body,
                                           std::string& why) = 0;
  /// Requests to this port, or to any free one if it is 0, wait from now on. The server's address; none with a reason.
  virtual std::optional<std::string> listen(std::uint16_t port, ObjectId owner, std::string& why) = 0;
  /// The first request that waits; none if there is none, or `owner` has no such server. Each one is answered before
  /// the next.
  virtual std::optional<NetworkRequest> next_request(const std::string& server, ObjectId owner) = 0;
  virtual void answer(const std::string& server, const NetworkAnswer& answer) = 0;
  /// Does nothing if `owner` has no such server.
  virtual void close(const std::string& server, ObjectId owner) = 0;
};

}  // namespace breve::steve
