/* Servers and requests of scripts: by callbacks of the host, recorded and replayed, and over the loopback interface. */
#include <arpa/inet.h>
#include <pthread.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "scene.h"

/* --- a network that the test plays -------------------------------------------------------------------------------- */

enum { kMost = 64 };
static struct {
  const char* method;
  const char* target;
  const char* body;
} asked[kMost];
static int asked_count, taken, closed, retained, fetches;
static char answers[8192]; /* "200 text|404 text|" */

static void forget(void) { asked_count = taken = closed = fetches = 0, answers[0] = 0; }
static void ask(const char* method, const char* target, const char* body) {
  asked[asked_count].method = method;
  asked[asked_count].target = target;
  asked[asked_count++].body = body;
}

static bool next(void* handle, breve_request* request) {
  (void)handle;
  if (taken == asked_count) return false;
  request->method = asked[taken].method;
  request->target = asked[taken].target;
  request->from = "10.0.0.7";
  request->body = asked[taken].body;
  request->body_size = strlen(asked[taken++].body);
  return true;
}
static void answer(void* handle, const breve_response* response) {
  const size_t used = strlen(answers);
  (void)handle;
  snprintf(answers + used, sizeof answers - used, "%u %.*s|", response->status, (int)response->body_size,
           (const char*)response->body);
}
static void close_server(void* handle) { (void)handle, ++closed; }
static bool listen_there(void* user, breve_world* world, uint32_t port, breve_server* server, breve_write_fn reason,
                         void* sink) {
  (void)user, (void)world;
  if (port == 13) return reason(sink, "it is unlucky", 13), false;
  server->next = next;
  server->answer = answer;
  server->close = close_server;
  server->url = "http://there:80";
  return true;
}
static char sent[65536]; /* the body of the last request */
static bool fetch(void* user, breve_world* world, const char* method, const char* url, const void* body, size_t size,
                  breve_write_fn write, void* sink) {
  static char text[sizeof sent + 256];
  (void)user, (void)world;
  ++fetches;
  snprintf(sent, sizeof sent, "%.*s", (int)size, (const char*)body);
  if (strstr(url, "nowhere")) return write(sink, "nobody is there", 15), false;
  snprintf(text, sizeof text, "%s %s %s %d", method, url, sent, fetches);
  write(sink, text, strlen(text));
  return true;
}
static void retain(void* user) { (void)user, ++retained; }
static void release(void* user) { (void)user, --retained; }

static const char* const program =
    "@use Control.\n@use Data.\n@use NetworkServer.\n"
    "Data : Parcel { + variables: weight (int). }\n"
    "Controller Host.\n"
    "Control : Host {\n"
    "  + variables: server, url (object). total (int). said (string).\n"
    "  + to init:\n"
    "    server = new NetworkServer.\n"
    "    server listen on-port 0.\n"
    "    url = new URL.\n"
    "  + to iterate:\n"
    "    super iterate.\n"
    "  + to add amount amount (int) and more (float):\n"
    "    total = total + amount.\n"
    "    return \"$amount $more\".\n"
    "  + to show:\n"
    "    return \"<b>$total</b>\".\n"
    "  + to fail:\n"
    "    die \"on purpose\".\n"
    "  + to only method-named name (string):\n"
    "    server expose method name.\n"
    "  + to get from address (string):\n"
    "    said = (url get url address).\n"
    "  + to put in address (string):\n"
    "    said = (url put put-data \"<a>\" to address).\n"
    "  + to send to port (int):\n"
    "    parcel (object).\n"
    "    parcel = new Parcel.\n"
    "    parcel::weight = 40.\n"
    "    parcel = (parcel send-over-network to \"127.0.0.1\" on port).\n"
    "    total = parcel::weight.\n"
    "  + to where:\n"
    "    return (server get-url).\n"
    "  + to accept-upload of thing (object) from where (string):\n"
    "    total = total + thing::weight.\n"
    "    said = where.\n"
    "    thing::weight++.\n"
    "    return thing.\n"
    "  + to parcel-text:\n"
    "    parcel (object).\n"
    "    parcel = new Parcel.\n"
    "    parcel::weight = 7.\n"
    "    return (parcel archive-as-xml-string).\n"
    "}\n";

static bool open_program(scene* s, const breve_network* network, const char* text) {
  breve_runtime_config config = breve_runtime_config_default();
  memset(s, 0, sizeof *s);
  config.user = &s->said;
  config.print = remember;
  config.network = *network;
  return CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &s->runtime)) &&
         CHECK_STATUS(BREVE_OK, breve_program_compile(s->runtime, "host.tz", text, strlen(text), &s->program)) &&
         CHECK_STATUS(BREVE_OK, breve_world_create(s->runtime, s->program, NULL, &s->world));
}
static bool open_with(scene* s, const breve_network* network) { return open_program(s, network, program); }
static bool open_there(scene* s) {
  breve_network network = {NULL, listen_there, fetch, retain, release};
  forget();
  return open_with(s, &network);
}
static breve_status call(scene* s, const char* method, const char* keyword, breve_value value) {
  const breve_keyword keywords[] = {{keyword, value}};
  return breve_object_call(s->world, breve_world_controller(s->world), method, keywords, 1, NULL);
}
static bool is_said(scene* s, const char* text) {
  const char* said = NULL;
  breve_value value = value_of(s, "said");
  return breve_value_text(s->world, &value, &said) == BREVE_OK && said && strcmp(said, text) == 0;
}

/* An object of weight 7, as a peer sends it. */
static const char* parcel_of(scene* s) {
  static char xml[4096];
  const char* text = NULL;
  breve_value value;
  CHECK_STATUS(BREVE_OK, breve_object_call(s->world, breve_world_controller(s->world), "parcel-text", NULL, 0, &value));
  CHECK_STATUS(BREVE_OK, breve_value_text(s->world, &value, &text));
  snprintf(xml, sizeof xml, "%s", text);
  return xml;
}

/* --- answers ------------------------------------------------------------------------------------------------------ */

static void requests_call_methods_of_the_program_between_iterations(void) {
  scene s;
  if (!open_there(&s)) return;
  ask("GET", "/add_3_0.5", "");
  ask("GET", "/show", "");
  CHECK(int_of(&s, "total") == 0);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "total") == 3);
  CHECK(strcmp(answers, "200 3 0.500000|200 <b>3</b>|") == 0);
  scene_close(&s);
  CHECK(closed == 1 && retained == 0);
}

/* A page is asked for, a number sent and an object uploaded every tenth iteration, of two thousand. */
static void a_world_serves_for_a_long_time(void) {
  enum { kIterations = 2000, kEach = 10 };
  scene s;
  if (!open_there(&s)) return;
  const char* const parcel = parcel_of(&s);
  for (int i = 0; i < kIterations; ++i) {
    forget();
    if (i % kEach == 0) {
      ask("GET", "/add_3_0.5", "");
      ask("POST", "/", parcel); /* of weight 7 */
      ask("GET", "/show", "");
      ask("GET", "/fly", "");
    }
    if (!CHECK_STATUS(BREVE_OK, breve_world_step(s.world))) break;
    char page[64];
    snprintf(page, sizeof page, "|200 <b>%d</b>|404 ", 10 * (i / kEach + 1));
    if (i % kEach == 0 && !CHECK(strstr(answers, page) != NULL)) break;
    if (i % kEach != 0 && !CHECK(answers[0] == 0)) break;
  }
  CHECK(int_of(&s, "total") == 10 * kIterations / kEach);
  CHECK(s.said.errors == 0);
  scene_close(&s);
  CHECK(closed == 1 && retained == 0);
}

static void what_is_not_exposed_is_not_called(void) {
  scene s;
  if (!open_there(&s)) return;
  ask("GET", "/end-simulation", ""); /* of the library */
  ask("GET", "/init", "");           /* called by the library */
  ask("GET", "/add_3", "");          /* another number of keywords */
  ask("GET", "/fly", "");
  ask("GET", "/..%2f..%2fetc/passwd.html", "");
  ask("GET", "/secret.html", ""); /* this world may read no files */
  ask("GET", "/a/b", "");
  ask("GET", "nothing", "");
  ask("GET", "/fail", "");
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(!breve_world_ended(s.world));
  CHECK(strncmp(answers, "404 ", 4) == 0);
  CHECK(strstr(answers, "200") == NULL);
  CHECK(strstr(answers, "500 ") != NULL && s.said.errors == 1);

  answers[0] = 0;
  CHECK_STATUS(BREVE_OK, call(&s, "only", "method-named", breve_value_string("show")));
  ask("GET", "/add_3_0.5", "");
  ask("GET", "/show", "");
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "total") == 0);
  CHECK(strstr(answers, "|200 <b>0</b>|") != NULL);
  scene_close(&s);
}

static void an_object_that_is_sent_reaches_accept_upload(void) {
  scene s;
  if (!open_there(&s)) return;
  ask("POST", "/", parcel_of(&s));
  ask("POST", "/", "<archive"); /* damaged */
  ask("PUT", "/", "");
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "total") == 7);
  CHECK(is_said(&s, "10.0.0.7"));
  CHECK(strncmp(answers, "200 <", 5) == 0); /* what accept-upload yields goes back */
  CHECK(strstr(answers, "|400 ") != NULL);
  scene_close(&s);
}

/* A peer that sends a NetworkServer with the address of the real one would answer in its place, or close it. */
static void an_uploaded_server_neither_takes_nor_closes_the_real_one(void) {
  static const char* const impostor =
      "<breve-archive version=\"1\" root=\"1\"><object id=\"1\" class=\"NetworkServer\"><variable "
      "class=\"NetworkServer\" "
      "name=\"serverURL\"><string>http://there:80</string></variable></object></breve-archive>";
  static const char* const damaged =
      "<breve-archive version=\"1\" root=\"1\"><object id=\"1\" class=\"NetworkServer\"><variable "
      "class=\"NetworkServer\" "
      "name=\"serverURL\"><string>http://there:80</string></variable></object><object id=\"2\" "
      "class=\"Parcel\"><variable "
      "class=\"Parcel\" name=\"weight\"><vector>1 2 3</vector></variable></object></breve-archive>";
  static const char* const controller =
      "<breve-archive version=\"1\" root=\"1\"><object id=\"1\" class=\"Host\"/></breve-archive>";
  scene s;
  if (!open_there(&s)) return;
  CHECK_STATUS(BREVE_OK, call(&s, "only", "method-named", breve_value_string("show")));
  ask("POST", "/", impostor);
  ask("POST", "/", damaged);
  ask("POST", "/", controller);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(closed == 0 && int_of(&s, "total") == 0);
  CHECK(strncmp(answers, "403 ", 4) == 0 && strstr(answers, "NetworkServer") != NULL);
  CHECK(strstr(answers, "|403 objects of class Host") != NULL);
  CHECK(strstr(answers, "200") == NULL && strstr(answers, "400") == NULL);

  /* Nor is there anything left that answers with a list of its own, which is empty and exposes all. */
  answers[0] = 0;
  ask("GET", "/add_3_0.5", "");
  ask("GET", "/show", "");
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(strncmp(answers, "404 ", 4) == 0 && strstr(answers, "|200 <b>0</b>|") != NULL);
  scene_close(&s);
  CHECK(closed == 1);
}

/* An address is not a secret: an object of the program that has it in a variable is not the one that opened it. */
static void a_server_is_of_use_only_to_the_object_that_opened_it(void) {
  static const char* const two =
      "@use Control.\n@use NetworkServer.\nController Host.\n"
      "Control : Host {\n  + variables: server, other (object). total (int).\n"
      "  + to init:\n    other = new NetworkServer.\n    server = new NetworkServer.\n    server listen on-port 0.\n"
      "    server expose method \"show\".\n    other::serverURL = (server get-url).\n"
      "  + to show:\n    return \"shown\".\n  + to hide:\n    total++.\n    return \"hidden\".\n"
      "  + to end-other now n (int):\n    free other.\n}\n";
  const breve_network network = {NULL, listen_there, fetch, retain, release};
  scene s;
  forget();
  if (!open_program(&s, &network, two)) return;
  ask("GET", "/hide", "");
  ask("GET", "/show", "");
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(strncmp(answers, "404 ", 4) == 0 && strstr(answers, "|200 shown|") != NULL && int_of(&s, "total") == 0);
  CHECK_STATUS(BREVE_OK, call(&s, "end-other", "now", breve_value_int(1)));
  CHECK(closed == 0);
  answers[0] = 0;
  ask("GET", "/show", "");
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(strcmp(answers, "200 shown|") == 0);
  scene_close(&s);
  CHECK(closed == 1);
}

static void urls_are_fetched_and_failures_are_errors(void) {
  scene s;
  if (!open_there(&s)) return;
  CHECK_STATUS(BREVE_OK, call(&s, "get", "from", breve_value_string("http://there/x")));
  CHECK(is_said(&s, "GET http://there/x  1"));
  CHECK_STATUS(BREVE_OK, call(&s, "put", "in", breve_value_string("http://there/y")));
  CHECK(is_said(&s, "PUT http://there/y <a> 2"));
  CHECK_STATUS(BREVE_ERROR_SCRIPT, call(&s, "get", "from", breve_value_string("http://nowhere/")));
  CHECK(strstr(breve_world_last_error(s.world)->message, "nobody is there") != NULL);
  scene_close(&s);
}

/* Winners of a genetic algorithm go out after each generation, and come in as individuals of another. */
static void migrants_travel(void) {
  static const char* const search =
      "@use Control.\n@use GeneticAlgorithm.\n"
      "GeneticAlgorithmIndividual : Number {\n  + variables: n (int).\n"
      "  + to copy from other (object):\n    n = other::n.\n"
      "  + to mutate:\n    n = n + 0.\n  + to randomize:\n    n = 1.\n"
      "  + to crossover from-parent1 a (object) from-parent2 b (object):\n    n = a::n.\n}\n"
      "GeneticAlgorithm : Search {\n  + variables: most (int).\n"
      "  + to end-fitness-test of one (object):\n    one set-fitness to 1.\n    if one::n > most: most = one::n.\n"
      "  + to get-most:\n    return most.\n"
      "  + to report at-generation g (int) with-best-individual b (object) with-average-fitness f (double):\n}\n"
      "Controller Host.\nControl : Host {\n  + variables: ga (object). most (int). said (string).\n"
      "  + to init:\n    ga = new Search.\n    ga set-individual-class to \"Number\".\n"
      "    ga set-population-size to 4.\n    ga set-fitness-test-duration to 0.05.\n    ga set-mutation-percent to 0.\n"
      "    ga set-randomize-percent to 50.\n    ga set-migration-percent to 50.\n"
      "    ga set-migration-hosts to { { \"there\", 7 } }.\n"
      "  + to iterate:\n    super iterate.\n    most = (ga get-most).\n    said = (ga get-migration-url).\n}\n";
  const breve_network network = {NULL, listen_there, fetch, retain, release};
  static char bag[65536];
  char* number;
  scene s;
  forget();
  if (!open_program(&s, &network, search)) return;
  for (int i = 0; i < 20; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(fetches >= 2 && strstr(sent, "GAIndividualTransporter") != NULL && strstr(sent, "Number") != NULL);
  CHECK(is_said(&s, "http://there:80") && int_of(&s, "most") == 1);

  /* The same bag comes from elsewhere, with other genomes in it. */
  snprintf(bag, sizeof bag, "%s", sent);
  for (number = bag; (number = strstr(number, "name=\"n\"")) != NULL;) {
    number = strstr(number, "<int>");
    if (!CHECK(number != NULL)) break;
    number[strlen("<int>")] = '9';
  }
  ask("POST", "/", bag);
  for (int i = 0; i < 40; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(strncmp(answers, "200 ", 4) == 0);
  CHECK(int_of(&s, "most") == 9);
  scene_close(&s);
  CHECK(closed == 1);
}

/* --- record and replay -------------------------------------------------------------------------------------------- */

static char* tape;
static size_t tape_size;
static void append(void* sink, const char* bytes, size_t size) {
  (void)sink;
  tape = realloc(tape, tape_size + size);
  memcpy(tape + tape_size, bytes, size);
  tape_size += size;
}

static void a_recorded_run_replays_equal(void) {
  breve_replay replay;
  breve_network none = {0};
  uint64_t hash = 0, again = 1;
  scene s;
  if (!open_there(&s)) return;
  tape = NULL, tape_size = 0;
  CHECK_STATUS(BREVE_OK, breve_world_record_start(s.world, append, NULL));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  for (int i = 0; i < 5; ++i) {
    ask("GET", i % 2 ? "/show" : "/add_3_0.5", "");
    if (i == 3) ask("GET", "/add_100_1", "");
    CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  }
  CHECK_STATUS(BREVE_OK, breve_world_record_stop(s.world));
  CHECK(int_of(&s, "total") == 109);
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &hash));
  scene_close(&s);

  /* Without any network: the log has what came. */
  forget();
  if (!open_with(&s, &none)) return;
  CHECK_STATUS(BREVE_OK, breve_world_replay(s.world, tape, tape_size, NULL, NULL, &replay));
  CHECK(!replay.differs && replay.complete && replay.iterations == 6);
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &again));
  CHECK(int_of(&s, "total") == 109 && again == hash);
  CHECK(taken == 0);
  scene_close(&s);
  free(tape);
}

/* --- the loopback interface --------------------------------------------------------------------------------------- */

typedef struct peer {
  breve_network network;
  const char* method;
  const char* body;
  char url[128];
  char got[65536];
  size_t size;
  bool fine;
  volatile bool done;
} peer;

static void collect(void* sink, const char* bytes, size_t size) {
  peer* p = sink;
  for (size_t i = 0; i < size && p->size + 1 < sizeof p->got; ++i) p->got[p->size++] = bytes[i];
  p->got[p->size] = 0;
}
static void* visit(void* context) {
  peer* p = context;
  p->fine = p->network.fetch(p->network.user, NULL, p->method, p->url, p->body, strlen(p->body), collect, p);
  __atomic_store_n(&p->done, true, __ATOMIC_RELEASE);
  return NULL;
}

/* Visits an address while the world is stepped. */
static void visit_while_it_runs(scene* s, peer* p, const char* method, const char* base, const char* path,
                                const char* body) {
  pthread_t thread;
  p->method = method;
  p->body = body;
  p->size = 0, p->got[0] = 0, p->done = false;
  snprintf(p->url, sizeof p->url, "%s%s", base, path);
  if (!CHECK(pthread_create(&thread, NULL, visit, p) == 0)) return;
  while (!__atomic_load_n(&p->done, __ATOMIC_ACQUIRE)) CHECK_STATUS(BREVE_OK, breve_world_step(s->world));
  pthread_join(thread, NULL);
}

static void a_world_serves_over_loopback(void) {
  static const char* const served =
      "@use Control.\n@use NetworkServer.\nController Host.\nControl : Host {\n"
      "  + variables: server (object). total (int). said (string).\n"
      "  + to init:\n    server = new NetworkServer.\n    server listen on-port 0.\n    said = (server get-url).\n"
      "  + to twice of n (int):\n    total++.\n    return 2 * n.\n}\n";
  static peer p;
  breve_network_config limits = breve_network_config_default();
  const char* base = NULL;
  char address[64];
  breve_value value;
  scene s;
  limits.most_bytes = 1000;
  if (!CHECK_STATUS(BREVE_OK, breve_network_open(&limits, &p.network))) return;
  if (!open_program(&s, &p.network, served)) return;
  value = value_of(&s, "said");
  CHECK_STATUS(BREVE_OK, breve_value_text(s.world, &value, &base));
  snprintf(address, sizeof address, "%s", base);
  CHECK(strncmp(address, "http://127.0.0.1:", 17) == 0);

  for (int i = 0; i < 10; ++i) {
    visit_while_it_runs(&s, &p, "GET", address, "/twice_21", "");
    CHECK(p.fine && strcmp(p.got, "42") == 0);
  }
  CHECK(int_of(&s, "total") == 10);
  visit_while_it_runs(&s, &p, "GET", address, "/", "");
  CHECK(p.fine && strstr(p.got, "twice_<i>n</i>") != NULL);
  visit_while_it_runs(&s, &p, "GET", address, "/set-random-seed_1", "");
  CHECK(!p.fine && strstr(p.got, "404") != NULL);
  visit_while_it_runs(&s, &p, "GET", address, "/%zz", "");
  CHECK(!p.fine && strstr(p.got, "400") != NULL);
  visit_while_it_runs(&s, &p, "POST", address, "/", "<no archive>");
  CHECK(!p.fine && strstr(p.got, "400") != NULL);
  /* Other machines, other schemes, and addresses that hide a second line are refused before anything is sent. */
  for (int i = 0; i < 6; ++i) {
    static const char* const bad[] = {"http://192.0.2.1/",         "https://127.0.0.1/",          "file:///etc/passwd",
                                      "http://127.0.0.1@other.x/", "http://localhost:1/\r\nX: y", "http:///"};
    visit_while_it_runs(&s, &p, "GET", bad[i], "", "");
    CHECK(!p.fine && p.size > 0);
  }
  scene_close(&s);
  /* The server is gone with its world. */
  p.size = 0, p.done = false;
  snprintf(p.url, sizeof p.url, "%s/twice_1", address);
  visit(&p);
  CHECK(!p.fine);
  CHECK_STATUS(BREVE_OK, breve_network_release(&p.network));
}

typedef struct sender {
  scene s;
  int port;
  breve_status status;
  volatile bool done;
} sender;
static void* send_parcel(void* context) {
  sender* from = context;
  from->status = call(&from->s, "send", "to", breve_value_int(from->port));
  __atomic_store_n(&from->done, true, __ATOMIC_RELEASE);
  return NULL;
}

/* Two worlds, each in a thread of its own: the parcel arrives, and what accept-upload yields comes back. */
static void an_object_travels_from_world_to_world(void) {
  static sender from;
  breve_network network;
  breve_value value;
  const char* where = NULL;
  pthread_t thread;
  scene to;
  if (!CHECK_STATUS(BREVE_OK, breve_network_open(NULL, &network))) return;
  if (!open_with(&to, &network) || !open_with(&from.s, &network)) return;
  CHECK_STATUS(BREVE_OK, breve_object_call(to.world, breve_world_controller(to.world), "where", NULL, 0, &value));
  CHECK_STATUS(BREVE_OK, breve_value_text(to.world, &value, &where));
  from.port = (int)strtol(where + strlen("http://127.0.0.1:"), NULL, 10);
  if (!CHECK(pthread_create(&thread, NULL, send_parcel, &from) == 0)) return;
  while (!__atomic_load_n(&from.done, __ATOMIC_ACQUIRE)) CHECK_STATUS(BREVE_OK, breve_world_step(to.world));
  pthread_join(thread, NULL);
  CHECK_STATUS(BREVE_OK, from.status);
  CHECK(int_of(&to, "total") == 40 && is_said(&to, "127.0.0.1"));
  CHECK(int_of(&from.s, "total") == 41);
  scene_close(&from.s);
  scene_close(&to);
  CHECK_STATUS(BREVE_OK, breve_network_release(&network));
}

static void a_world_that_does_not_answer_is_not_waited_for_long(void) {
  breve_network network;
  breve_server server;
  breve_network_config config = breve_network_config_default();
  static peer p;
  config.timeout = 0.05;
  if (!CHECK_STATUS(BREVE_OK, breve_network_open(&config, &network))) return;
  memset(&server, 0, sizeof server);
  CHECK(network.listen(network.user, NULL, 0, &server, collect, &p));
  p.network = network;
  p.method = "GET", p.body = "";
  snprintf(p.url, sizeof p.url, "%s/x", server.url);
  visit(&p);
  CHECK(!p.fine);
  server.close(server.handle);
  CHECK_STATUS(BREVE_OK, breve_network_release(&network));
}

static void* interrupt_soon(void* context) {
  const struct timespec soon = {0, 50000000};
  nanosleep(&soon, NULL);
  breve_world_interrupt(context);
  return NULL;
}

/* A peer that takes the connection and never answers: the interrupt ends the wait, long before the timeout. */
static void an_interrupt_ends_a_fetch(void) {
  struct sockaddr_in address;
  socklen_t size = sizeof address;
  const int peer = socket(AF_INET, SOCK_STREAM, 0);
  breve_network network;
  breve_network_config config = breve_network_config_default();
  struct timespec begun, ended;
  pthread_t thread;
  char text[64];
  scene s;
  memset(&address, 0, sizeof address);
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (!CHECK(bind(peer, (struct sockaddr*)&address, sizeof address) == 0 && listen(peer, 4) == 0)) return;
  CHECK(getsockname(peer, (struct sockaddr*)&address, &size) == 0);
  snprintf(text, sizeof text, "http://127.0.0.1:%d/", ntohs(address.sin_port));
  config.timeout = 300;
  if (!CHECK_STATUS(BREVE_OK, breve_network_open(&config, &network))) return;
  if (!open_with(&s, &network)) return;
  clock_gettime(CLOCK_MONOTONIC, &begun);
  if (!CHECK(pthread_create(&thread, NULL, interrupt_soon, s.world) == 0)) return;
  CHECK_STATUS(BREVE_ERROR_INTERRUPTED, call(&s, "get", "from", breve_value_string(text)));
  clock_gettime(CLOCK_MONOTONIC, &ended);
  pthread_join(thread, NULL);
  CHECK(ended.tv_sec - begun.tv_sec < 30);
  scene_close(&s);
  close(peer);
  CHECK_STATUS(BREVE_OK, breve_network_release(&network));
}

static void bad_limits_are_refused(void) {
  breve_network network;
  breve_network_config config = breve_network_config_default();
  config.timeout = 0;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_network_open(&config, &network));
  config.timeout = 3601;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_network_open(&config, &network));
  config = breve_network_config_default();
  config.most_bytes = 0;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_network_open(&config, &network));
  config = breve_network_config_default();
  config.address = "localhost";
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_network_open(&config, &network));
  config = breve_network_config_default();
  config.reserved[3] = true;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_network_open(&config, &network));
}

void network_suite(void) {
  RUN(requests_call_methods_of_the_program_between_iterations);
  RUN(a_world_serves_for_a_long_time);
  RUN(what_is_not_exposed_is_not_called);
  RUN(an_object_that_is_sent_reaches_accept_upload);
  RUN(an_uploaded_server_neither_takes_nor_closes_the_real_one);
  RUN(a_server_is_of_use_only_to_the_object_that_opened_it);
  RUN(urls_are_fetched_and_failures_are_errors);
  RUN(migrants_travel);
  RUN(a_recorded_run_replays_equal);
  RUN(a_world_serves_over_loopback);
  RUN(an_object_travels_from_world_to_world);
  RUN(a_world_that_does_not_answer_is_not_waited_for_long);
  RUN(an_interrupt_ends_a_fetch);
  RUN(bad_limits_are_refused);
}
