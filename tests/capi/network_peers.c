/* Peers of a server over the loopback interface that do not keep to the rules: slow ones, and ones that send too much.
 */
#include <arpa/inet.h>
#include <errno.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "scene.h"

static void say_nothing(void* sink, const char* bytes, size_t size) { (void)sink, (void)bytes, (void)size; }

/* All that comes until the other side closes, with a zero byte behind. */
static void receive(int socket, char* text, size_t room) {
  size_t size = 0;
  while (size + 1 < room) {
    const ssize_t got = recv(socket, text + size, room - size - 1, 0);
    if (got <= 0) break;
    size += (size_t)got;
  }
  text[size] = 0;
}

/* A raw connection to a server at "http://127.0.0.1:PORT"; -1 if there is none. */
static int connect_to(const char* url) {
  struct sockaddr_in address;
  const int peer = socket(AF_INET, SOCK_STREAM, 0);
  memset(&address, 0, sizeof address);
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons((uint16_t)strtol(strrchr(url, ':') + 1, NULL, 10));
  if (connect(peer, (struct sockaddr*)&address, sizeof address) == 0) return peer;
  close(peer);
  return -1;
}
static double seconds_now(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

/* Peers that send a byte now and then, more of them than a server has threads: in a header, or in a body. All are cut
   off when their time is over, however often they send, and the server is there for others. */
static void slow_peers_are_cut_off(void) {
  enum { kPeers = 20 };
  static const char* const begun[] = {"GET /x HTTP/1.1\r\nX-A: ", "POST / HTTP/1.1\r\nContent-Length: 900\r\n\r\n"};
  const struct timespec pause = {0, 20000000};
  breve_network network;
  breve_network_config config = breve_network_config_default();
  config.timeout = 1;
  if (!CHECK_STATUS(BREVE_OK, breve_network_open(&config, &network))) return;
  for (int kind = 0; kind < 2; ++kind) {
    breve_server server;
    breve_request request;
    const breve_response response = {200, "text/plain", "here", 4};
    char got[512];
    int peers[kPeers], raw;
    int open = kPeers;
    ssize_t size;
    const double start = seconds_now();
    memset(&server, 0, sizeof server);
    if (!CHECK(network.listen(network.user, NULL, 0, &server, say_nothing, NULL))) break;
    for (int i = 0; i < kPeers; ++i) {
      peers[i] = connect_to(server.url);
      CHECK(peers[i] >= 0 && send(peers[i], begun[kind], strlen(begun[kind]), MSG_NOSIGNAL) > 0);
    }
    while (open > 0 && seconds_now() - start < 30) {
      nanosleep(&pause, NULL);
      for (int i = 0; i < kPeers; ++i) {
        if (peers[i] < 0) continue;
        send(peers[i], "a", 1, MSG_NOSIGNAL | MSG_DONTWAIT);
        size = recv(peers[i], got, sizeof got, MSG_DONTWAIT);
        if (size > 0 || (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK))) continue;
        close(peers[i]);
        peers[i] = -1, --open;
      }
    }
    CHECK(open == 0);
    CHECK(seconds_now() - start < 10); /* one second and what a busy machine adds */

    raw = connect_to(server.url);
    CHECK(send(raw, "GET /x HTTP/1.1\r\n\r\n", 19, MSG_NOSIGNAL) == 19);
    while (!server.next(server.handle, &request) && seconds_now() - start < 60) nanosleep(&pause, NULL);
    server.answer(server.handle, &response);
    receive(raw, got, sizeof got);
    CHECK(strstr(got, " 200 ") != NULL && strstr(got, "here") != NULL);
    close(raw);
    server.close(server.handle);
  }
  CHECK_STATUS(BREVE_OK, breve_network_release(&network));
}

static void a_body_that_is_too_large_is_refused(void) {
  breve_network network;
  breve_server server;
  breve_network_config config = breve_network_config_default();
  static const char kHead[] = "POST / HTTP/1.1\r\nContent-Length: 1001\r\n\r\n";
  static char text[3000];
  char got[512];
  int raw;
  config.most_bytes = 1000;
  if (!CHECK_STATUS(BREVE_OK, breve_network_open(&config, &network))) return;
  memset(&server, 0, sizeof server);
  CHECK(network.listen(network.user, NULL, 0, &server, say_nothing, NULL));
  raw = connect_to(server.url);
  memset(text, 'x', sizeof text);
  memcpy(text, kHead, sizeof kHead - 1);
  CHECK(send(raw, text, sizeof kHead - 1 + 1001, MSG_NOSIGNAL) > 0);
  receive(raw, got, sizeof got);
  CHECK(strstr(got, " 413 ") != NULL);
  close(raw);
  server.close(server.handle);
  CHECK_STATUS(BREVE_OK, breve_network_release(&network));
}

void network_peers_suite(void) {
  RUN(slow_peers_are_cut_off);
  RUN(a_body_that_is_too_large_is_refused);
}
