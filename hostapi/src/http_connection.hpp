// A connection that a peer made to a server, with an end: whatever the peer does, and however slowly, it is over by
// then. The timeouts of cpp-httplib are those of a single read or write, so that a byte now and then would hold a
// thread for ever.
#pragma once

#include <arpa/inet.h>
#include <httplib.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <string>

namespace breve::host {

class Connection final : public httplib::Stream {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param deadline  reads and writes fail from then on
  /// @param most      bytes that are read in all
  /// @param closing   once it is true, reads and writes fail
  Connection(int socket, Clock::time_point deadline, std::size_t most, const std::atomic<bool>& closing)
      : socket_(socket), deadline_(deadline), left_(most), closing_(closing) {}
  ~Connection() override {
    shutdown(socket_, SHUT_RDWR);
    close(socket_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool is_readable() const override { return begin_ != end_ || waits_for(POLLIN); }
  bool is_writable() const override { return waits_for(POLLOUT); }
  ssize_t read(char* to, std::size_t size) override {
    if (begin_ == end_) {
      const ssize_t got = exchange(
          POLLIN, [&] { return recv(socket_, buffer_.data(), std::min(buffer_.size(), left_), MSG_DONTWAIT); });
      if (got <= 0) return got;
      begin_ = 0;
      end_ = static_cast<std::size_t>(got);
      left_ -= end_;
    }
    const std::size_t taken = std::min(size, end_ - begin_);
    std::copy_n(buffer_.data() + begin_, taken, to);
    begin_ += taken;
    return static_cast<ssize_t>(taken);
  }
  ssize_t write(const char* from, std::size_t size) override {
    return exchange(POLLOUT, [&] { return send(socket_, from, size, MSG_DONTWAIT | MSG_NOSIGNAL); });
  }
  void get_remote_ip_and_port(std::string& ip, int& port) const override { address(getpeername, ip, port); }
  void get_local_ip_and_port(std::string& ip, int& port) const override { address(getsockname, ip, port); }
  socket_t socket() const override { return socket_; }

 private:
  /// False once the time is over.
  bool waits_for(short event) const {
    constexpr auto kEvery = std::chrono::milliseconds(50);  // how often the end of the server is looked for
    while (!closing_) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline_ - Clock::now());
      if (left.count() <= 0) return false;
      pollfd waiting{socket_, event, 0};
      const int ready = poll(&waiting, 1, static_cast<int>(std::min(left, kEvery).count()));
      if (ready > 0) return true;
      if (ready < 0 && errno != EINTR) return false;
    }
    return false;
  }
  template <class Work>
  ssize_t exchange(short event, Work work) {
    while (waits_for(event)) {
      const ssize_t done = work();
      if (done >= 0 || (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)) return done;
    }
    return -1;
  }
  template <class Of>
  void address(Of of, std::string& ip, int& port) const {
    sockaddr_storage found{};
    socklen_t size = sizeof found;
    std::array<char, NI_MAXHOST> host{};
    std::array<char, NI_MAXSERV> service{};
    auto* const at = reinterpret_cast<sockaddr*>(&found);
    if (of(socket_, at, &size) != 0 || getnameinfo(at, size, host.data(), host.size(), service.data(), service.size(),
                                                   NI_NUMERICHOST | NI_NUMERICSERV) != 0)
      return;
    ip = host.data();
    std::from_chars(service.data(), service.data() + service.size(), port);
  }

  const int socket_;
  const Clock::time_point deadline_;
  std::size_t left_;  // bytes that may still be read
  const std::atomic<bool>& closing_;
  std::array<char, 4096> buffer_{};
  std::size_t begin_ = 0, end_ = 0;  // of what is in the buffer and was not read yet
};

}  // namespace breve::host
