// The network by HTTP, on cpp-httplib, which is seen here and nowhere else. A server's threads only receive: a request
// waits in a queue until the world takes it between two iterations, and its thread waits for the answer.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "http_connection.hpp"
#undef _res  // of <resolv.h>, which cpp-httplib includes: Eigen has parameters of that name
#include "internal.hpp"

namespace breve::host {

namespace {

constexpr std::size_t kMostWaiting = 64;  // requests of a server
constexpr std::size_t kMostThreads = 8;   // of a server

struct Settings {
  std::string address = "127.0.0.1";
  std::chrono::microseconds timeout{};
  std::size_t most_bytes = 0;
  bool remote = false;
  std::atomic<int> owners{1};
};

void say(breve_write_fn write, void* sink, const std::string& text) { write(sink, text.data(), text.size()); }

// --- servers ---------------------------------------------------------------------------------------------------------

/// A request between the thread that received it and the world.
struct Exchange {
  std::string method, target, from, body;
  std::string answer, type;
  int status = 503;
  bool answered = false;
};

using Clock = Connection::Clock;

/// The threads of a server. A connection's time begins when it is accepted, not when a thread is free for it.
class Workers final : public httplib::TaskQueue {
 public:
  /// @param begin  is called in the thread that runs a task, before it
  explicit Workers(std::function<void(Clock::time_point)> begin) : pool_(kMostThreads), begin_(std::move(begin)) {}
  void enqueue(std::function<void()> task) override {
    // One too many is closed at once, here: its time is over.
    if (waiting_ >= kMostWaiting) {
      begin_(Clock::time_point::min());
      return task();
    }
    ++waiting_;
    pool_.enqueue([this, task = std::move(task), accepted = Clock::now()] {
      --waiting_;
      begin_(accepted);
      task();
    });
  }
  void shutdown() override { pool_.shutdown(); }

 private:
  httplib::ThreadPool pool_;
  std::function<void(Clock::time_point)> begin_;
  std::atomic<std::size_t> waiting_{0};
};

/// cpp-httplib's server with a deadline for each connection as a whole, of one request.
class TimedServer final : public httplib::Server {
 public:
  TimedServer(std::chrono::microseconds timeout, std::size_t most_bytes) : timeout_(timeout), most_bytes_(most_bytes) {
    new_task_queue = [this] { return new Workers([this](Clock::time_point accepted) { begin(accepted); }); };
    set_payload_max_length(most_bytes);
  }
  ~TimedServer() override = default;
  TimedServer(const TimedServer&) = delete;
  TimedServer& operator=(const TimedServer&) = delete;
  void close() {
    closing_ = true;
    stop();
  }
  /// When the request that this thread serves must have its answer: the last tenth of the time is for sending it.
  Clock::time_point deadline() const {
    const std::lock_guard lock(mutex_);
    const auto accepted = accepted_.find(std::this_thread::get_id());
    const bool over = accepted == accepted_.end() || accepted->second == Clock::time_point::min();
    return over ? Clock::time_point::min() : accepted->second + timeout_ - timeout_ / 10;
  }

 private:
  void begin(Clock::time_point accepted) {
    const std::lock_guard lock(mutex_);
    accepted_[std::this_thread::get_id()] = accepted;
  }
  bool process_and_close_socket(socket_t socket) override {
    constexpr std::size_t kMostAround = 65536;  // bytes: the header
    const Clock::time_point end = deadline();
    // A body that is too large is read to its end, or to twice the size, so that the peer gets to see the answer.
    const std::size_t most = std::min(most_bytes_, SIZE_MAX / 4) * 2 + kMostAround;
    if (end == Clock::time_point::min()) {
      const Connection closed(socket, end, 0, closing_);
      return false;
    }
    Connection connection(socket, end + timeout_ / 10, most, closing_);
    bool closed = false;
    return process_request(connection, true, closed, nullptr);
  }

  const std::chrono::microseconds timeout_;
  const std::size_t most_bytes_;
  std::atomic<bool> closing_{false};
  mutable std::mutex mutex_;                               // of what follows
  std::map<std::thread::id, Clock::time_point> accepted_;  // when the connection that a thread serves was
};

class HttpServer {
 public:
  explicit HttpServer(const Settings& settings) : server_(settings.timeout, settings.most_bytes) {
    // Unlike its default, a port is not shared with another process.
    server_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    const httplib::Server::Handler receive = [this](const httplib::Request& request, httplib::Response& response) {
      serve(request, response);
    };
    server_.Get(".*", receive).Post(".*", receive).Put(".*", receive);
  }
  ~HttpServer() {
    {
      const std::lock_guard lock(mutex_);
      closing_ = true;
    }
    changed_.notify_all();
    server_.close();
    if (thread_.joinable()) thread_.join();
  }
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// False with a reason if the port is not free.
  bool start(const std::string& address, int port, std::string& why) {
    const int bound = port == 0 ? server_.bind_to_any_port(address) : server_.bind_to_port(address, port) ? port : -1;
    if (bound < 0) {
      why = fmt::format("port {} of {} is in use, or cannot be listened on", port, address);
      return false;
    }
    const bool six = address.find(':') != std::string::npos;
    url_ = six ? fmt::format("http://[{}]:{}", address, bound) : fmt::format("http://{}:{}", address, bound);
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    while (!server_.is_running()) std::this_thread::yield();  // stop() before that would be lost
    return true;
  }
  const std::string& url() const { return url_; }

  bool next(breve_request* request) {
    const std::lock_guard lock(mutex_);
    if (waiting_.empty()) return false;
    current_ = std::move(waiting_.front());
    waiting_.pop_front();
    *request = {current_->method.c_str(), current_->target.c_str(), current_->from.c_str(), current_->body.data(),
                current_->body.size()};
    return true;
  }

  void answer(const breve_response& response) {
    {
      const std::lock_guard lock(mutex_);
      if (!current_) return;
      current_->status = static_cast<int>(response.status);
      current_->type = response.type ? response.type : "";
      if (response.body) current_->answer.assign(static_cast<const char*>(response.body), response.body_size);
      current_->answered = true;
      current_.reset();
    }
    changed_.notify_all();
  }

 private:
  /// In a thread of the server.
  void serve(const httplib::Request& request, httplib::Response& response) {
    const auto exchange = std::make_shared<Exchange>();
    exchange->method = request.method;
    exchange->target = request.target;
    exchange->from = request.remote_addr;
    exchange->body = request.body;
    const Clock::time_point deadline = server_.deadline();
    std::unique_lock lock(mutex_);
    if (waiting_.size() < kMostWaiting && !closing_) {
      waiting_.push_back(exchange);
      changed_.wait_until(lock, deadline, [&] { return exchange->answered || closing_; });
      if (!exchange->answered) std::erase(waiting_, exchange);
    }
    response.status = exchange->answered ? exchange->status : 503;
    if (exchange->answered) response.set_content(exchange->answer, exchange->type);
  }

  TimedServer server_;
  std::thread thread_;
  std::string url_;
  std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  std::deque<std::shared_ptr<Exchange>> waiting_;
  std::shared_ptr<Exchange> current_;
  bool closing_ = false;
};

HttpServer& server_at(void* handle) { return *static_cast<HttpServer*>(handle); }

bool listen(void* user, breve_world*, std::uint32_t port, breve_server* server, breve_write_fn reason, void* sink) {
  const auto& settings = *static_cast<const Settings*>(user);
  std::string why;
  try {
    auto opened = std::make_unique<HttpServer>(settings);
    if (port <= 0xffff && opened->start(settings.address, static_cast<int>(port), why)) {
      server->url = opened->url().c_str();
      server->next = [](void* handle, breve_request* request) { return server_at(handle).next(request); };
      server->answer = [](void* handle, const breve_response* response) { server_at(handle).answer(*response); };
      server->close = [](void* handle) { delete &server_at(handle); };
      server->handle = opened.release();
      return true;
    }
    if (port > 0xffff) why = fmt::format("there is no port {}", port);
  } catch (const std::exception& e) {
    why = e.what();
  }
  say(reason, sink, why);
  return false;
}

// --- requests to others ----------------------------------------------------------------------------------------------

/// "http://host:port" and the path behind it.
struct Address {
  std::string server, host, path;
};

std::optional<Address> address_of(const std::string& url) {
  constexpr std::string_view kScheme = "http://";
  if (!url.starts_with(kScheme)) return std::nullopt;
  for (const char c : url)
    if (static_cast<unsigned char>(c) <= ' ' || c == 127) return std::nullopt;  // would end the line of the request
  const std::size_t end = std::min(url.find_first_of("/?#", kScheme.size()), url.size());
  Address address{url.substr(0, end), url.substr(kScheme.size(), end - kScheme.size()),
                  url.substr(end, url.find('#', end) - end)};
  if (address.host.find('@') != std::string::npos) return std::nullopt;
  const std::size_t colon = address.host.rfind(':'), bracket = address.host.rfind(']');
  if (colon != std::string::npos && (bracket == std::string::npos || colon > bracket)) address.host.resize(colon);
  if (!address.path.starts_with('/')) address.path.insert(0, "/");
  if (address.host.empty()) return std::nullopt;
  return address;
}

bool is_this_machine(const std::string& host) { return host == "localhost" || host == "127.0.0.1" || host == "[::1]"; }

/// Copies of the sockets of a request, to end it while another thread connects, writes or reads. A copy keeps its
/// number until all is over, so that nobody else's socket is shut.
class Sockets {
 public:
  Sockets() = default;
  Sockets(const Sockets&) = delete;
  Sockets& operator=(const Sockets&) = delete;
  ~Sockets() {
    for (const int copy : copies_) close(copy);
  }
  void add(int socket) {
    const int copy = dup(socket);
    const std::lock_guard lock(mutex_);
    if (copy >= 0) copies_.push_back(copy);
  }
  void end() {
    const std::lock_guard lock(mutex_);
    for (const int copy : copies_) shutdown(copy, SHUT_RDWR);
  }

 private:
  std::mutex mutex_;
  std::vector<int> copies_;
};

bool is_interrupted(const breve_world* world) {
  try {
    if (world) world->machine->poll();
    return false;
  } catch (const steve::RunError&) {
    return true;
  }
}

/// Sends in a thread of its own, so that an interrupt of the world ends the wait.
httplib::Result sent(httplib::Client& client, const httplib::Request& request, const breve_world* world) {
  constexpr auto kEvery = std::chrono::milliseconds(5);  // how often an interrupt is looked for
  Sockets sockets;
  client.set_socket_options([&](int socket) {
    httplib::default_socket_options(socket);
    sockets.add(socket);
  });
  std::future<httplib::Result> sending = std::async(std::launch::async, [&] { return client.send(request); });
  while (sending.wait_for(kEvery) != std::future_status::ready)
    if (is_interrupted(world)) sockets.end();
  return sending.get();
}

/// The body of the answer. Throws Error{File} with the reason.
std::string fetched(const Settings& settings, const breve_world* world, const std::string& method,
                    const std::string& url, std::string_view body) {
  const auto refuse = [](const std::string& why) { throw Error(ErrorCode::File, why); };
  const std::optional<Address> address = address_of(url);
  if (!address) refuse("this is not an address such as http://localhost:8080/page");
  if (!settings.remote && !is_this_machine(address->host))
    refuse("the host lets scripts reach servers of this machine only");
  if (body.size() > settings.most_bytes) refuse("the request is too large");
  httplib::Client client(address->server);
  client.set_connection_timeout(settings.timeout);
  client.set_read_timeout(settings.timeout);
  client.set_write_timeout(settings.timeout);

  httplib::Request request;
  request.method = method;
  request.path = address->path;
  request.body.assign(body);
  if (!body.empty()) request.set_header("Content-Type", "text/xml; charset=utf-8");
  std::string answer;
  const auto deadline = std::chrono::steady_clock::now() + settings.timeout;
  bool too_large = false, too_late = false;
  request.content_receiver = [&](const char* bytes, std::size_t size, std::uint64_t, std::uint64_t) {
    too_large = size > settings.most_bytes - answer.size();
    too_late = std::chrono::steady_clock::now() > deadline;
    if (too_large || too_late) return false;
    answer.append(bytes, size);
    return true;
  };
  const httplib::Result result = sent(client, request, world);
  if (too_large) refuse("the answer is too large");
  if (too_late) refuse("the answer took too long");
  if (!result) refuse(httplib::to_string(result.error()));
  if (result->status < 200 || result->status > 299)
    refuse(fmt::format("the server answers with status {}", result->status));
  return answer;
}

bool fetch(void* user, breve_world* world, const char* method, const char* url, const void* body, std::size_t size,
           breve_write_fn write, void* sink) {
  try {
    say(write, sink,
        fetched(*static_cast<const Settings*>(user), world, method, url, {static_cast<const char*>(body), size}));
    return true;
  } catch (const std::exception& e) {
    say(write, sink, e.what());
    return false;
  }
}

void retain(void* user) { ++static_cast<Settings*>(user)->owners; }
void release(void* user) {
  auto* settings = static_cast<Settings*>(user);
  if (--settings->owners == 0) delete settings;
}

bool is_numeric(const std::string& address) {
  unsigned char bytes[sizeof(in6_addr)];
  return inet_pton(AF_INET, address.c_str(), bytes) == 1 || inet_pton(AF_INET6, address.c_str(), bytes) == 1;
}

}  // namespace
}  // namespace breve::host

using namespace breve::host;

breve_status breve_network_open(const breve_network_config* config, breve_network* network) {
  return guard([&] {
    need(network, "network");
    const auto given = read_config(config, breve_network_config_default(), "breve_network_config");
    for (const bool reserved : given.reserved)
      if (reserved) fail(BREVE_ERROR_ARGUMENT, "a reserved field is not false");
    if (!(given.timeout > 0 && given.timeout <= 3600))
      fail(BREVE_ERROR_ARGUMENT, "timeout must be above 0 and at most 3600");
    if (given.most_bytes == 0) fail(BREVE_ERROR_ARGUMENT, "most_bytes must be at least 1");
    auto settings = std::make_unique<Settings>();
    if (given.address) settings->address = given.address;
    if (!is_numeric(settings->address)) fail(BREVE_ERROR_ARGUMENT, "address is not numeric");
    settings->timeout = std::chrono::microseconds(static_cast<std::int64_t>(std::ceil(given.timeout * 1e6)));
    settings->most_bytes = static_cast<std::size_t>(given.most_bytes);
    settings->remote = given.remote;
    *network = {settings.release(), &listen, &fetch, &retain, &release};
  });
}

breve_status breve_network_release(breve_network* network) {
  if (!network) return BREVE_OK;
  if (network->release) network->release(network->user);
  *network = {};
  return BREVE_OK;
}
