// Natives of NetworkServer and URL, and of what sends objects.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "runtime/store/request_target.hpp"
#include "steve/library/archive.hpp"
#include "steve/library/joints.hpp"
#include "steve/library/library.hpp"
#include "steve/library/requests.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;
using Kind = RequestTarget::Kind;

constexpr std::size_t kMostAtOnce = 100;  // requests of a server between two iterations
constexpr const char* kPage = "text/html; charset=utf-8";
constexpr const char* kArchive = "text/xml; charset=utf-8";

constexpr std::string_view kNotAllowed =
    "the network is not allowed here: the host allows it by breve_runtime_config.network, `breve run` by "
    "--allow-network";

/// Null if the host lets scripts use none.
Network* network_of(Machine& machine) {
  const auto& network = machine.host().network;
  return network && network->allowed() ? network.get() : nullptr;
}

Value text_value(Machine& machine, std::string_view text) {
  return Value::of(Tag::String, machine.heap().string(text));
}

// --- pages -----------------------------------------------------------------------------------------------------------

/// What answers the requests of a server.
struct Service {
  Machine& machine;
  std::string_view index_page, folder;
  ListCell* exposed;
  Instance* recipient;
};

NetworkAnswer failure(int status, std::string text) { return {status, "text/plain; charset=utf-8", std::move(text)}; }

/// Without this the text could be a part of the page's own commands.
std::string escaped(std::string_view text) {
  std::string page;
  for (const char c : text) {
    switch (c) {
      case '<': page += "&lt;"; break;
      case '>': page += "&gt;"; break;
      case '&': page += "&amp;"; break;
      default: page += c;
    }
  }
  return page;
}

NetworkAnswer page_in_file(const Service& service, const std::string& name) {
  try {
    const std::pmr::string text = read_file(service.machine, name);
    return {200, kPage, std::string(text)};
  } catch (const Error& error) {
    if (error.code() != ErrorCode::File) throw;
    return failure(404, "there is no such page\n");
  }
}

// --- methods ---------------------------------------------------------------------------------------------------------

/// A method that the program adds: the library has no method of that name, and the machine calls none.
bool is_own(const MethodInfo& method, std::string_view name) {
  if (name == "post-iterate" || name == "delete") return false;
  const ClassInfo* cls = method.owner;
  while (cls && !library_source().find_file(cls->name)) cls = cls->parent;
  return cls != method.owner && !(cls && cls->responds(method.name));
}

bool is_exposed(const Service& service, const MethodInfo& method, std::string_view name) {
  if (!service.exposed || service.exposed->size == 0) return is_own(method, name);
  return std::any_of(service.exposed->begin(), service.exposed->end(), [&](const Value& value) {
    return value.tag == Tag::String && view(static_cast<const StringCell*>(value.ref)) == name;
  });
}

NetworkAnswer call(const Service& service, const RequestTarget& target) {
  Machine& machine = service.machine;
  Instance* const controller = machine.controller();
  const MethodInfo* method =
      controller ? machine.find_method(*controller->cls, target.name, target.arguments.size()) : nullptr;
  if (!method || !is_exposed(service, *method, target.name))
    return failure(
        404, fmt::format("there is no method {} with {} arguments to call\n", target.name, target.arguments.size()));
  std::vector<Value> arguments;  // the frame of the called method holds them from the moment it starts
  for (const std::string& text : target.arguments) arguments.push_back(text_value(machine, text));
  Value result;
  if (!machine.call_guarded(*controller, *method, arguments, result))
    return failure(500, "the method failed with an error\n");
  const Pin pinned(machine, result);
  std::string text = machine.text(result);
  machine.charge(text.size());
  const bool is_page = text.starts_with('<');
  return {200, is_page ? kPage : "text/plain; charset=utf-8", std::move(text)};
}

NetworkAnswer list_of_methods(const Service& service) {
  const Instance* const controller = service.machine.controller();
  std::string page = "<!DOCTYPE html>\n<title>breve</title>\n<ul>\n";
  const SymbolTable& symbols = service.machine.program().symbols();
  for (const ClassInfo* cls = controller ? controller->cls : nullptr; cls; cls = cls->parent)
    for (const auto& method : cls->methods) {
      const std::string_view name = symbols.name(method->name);
      if (!is_exposed(service, *method, name)) continue;
      page += fmt::format("<li>{}", escaped(name));
      for (const ParameterInfo& parameter : method->parameters)
        page += fmt::format("_<i>{}</i>", escaped(symbols.name(parameter.variable)));
      page += "\n";
    }
  return {200, kPage, page + "</ul>\n"};
}

// --- objects ---------------------------------------------------------------------------------------------------------

/// Why a peer's text is not an object.
NetworkAnswer refusal(Machine& machine, std::string_view xml) {
  try {
    if (const std::string cls = class_refused_from_network(machine, xml); !cls.empty())
      return failure(403, fmt::format("objects of class {} cannot be sent: they reach outside of the world\n", cls));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::File) throw;
  }
  return failure(400, "this is not an object of this program\n");
}

/// An object that a peer has sent: through the controller's hook, to accept-upload, and what that yields back.
NetworkAnswer accept(const Service& service, const NetworkRequest& request) {
  Machine& machine = service.machine;
  Instance* const controller = machine.controller();
  const auto call_hook = [&](Instance& receiver, std::string_view name, std::span<const Value> arguments,
                             Value& result) {
    const MethodInfo* method = machine.find_method(*receiver.cls, name, arguments.size());
    return method && machine.call_guarded(receiver, *method, arguments, result);
  };
  if (!controller) return failure(503, "the program has no controller to receive it\n");
  Value sent, answered;
  const Value text[] = {text_value(machine, request.body)};
  if (!call_hook(*controller, "parse-xml-network-request", text, sent) || sent.tag != Tag::Object || !sent.ref)
    return refusal(machine, request.body);
  const Pin received(machine, sent);
  Instance* const recipient = service.recipient && service.recipient->live() ? service.recipient : controller;
  const Value arguments[] = {sent, text_value(machine, request.from)};
  if (!call_hook(*recipient, "accept-upload", arguments, answered)) return failure(500, "it was not accepted\n");
  const Pin pinned(machine, answered);
  auto* const object = answered.tag == Tag::Object ? static_cast<Instance*>(answered.ref) : nullptr;
  if (!object || !object->live()) return {200, kArchive, {}};
  return {200, kArchive, to_archive(machine, *object)};
}

NetworkAnswer answer_to(const Service& service, const NetworkRequest& request) {
  service.machine.charge(1 + request.body.size() + request.target.size());
  if (request.method != "GET") return accept(service, request);
  const RequestTarget target = parse_request_target(request.target);
  const std::string folder = service.folder.empty() ? "" : std::string(service.folder) + "/";
  switch (target.kind) {
    case Kind::Invalid: break;
    case Kind::Start:
      return service.index_page.empty() ? list_of_methods(service)
                                        : page_in_file(service, std::string(service.index_page));
    case Kind::Page: return page_in_file(service, folder + target.name);
    case Kind::Method: return call(service, target);
  }
  return failure(400, "this is not an address of this server\n");
}

// --- natives ---------------------------------------------------------------------------------------------------------

Text server_open(Machine& machine, Instance& self, std::int32_t port) {
  if (port < 0 || port > 65535)
    throw Error(ErrorCode::Argument, fmt::format("listen: there is no port {} (must be 0 to 65535)", port));
  std::string why(kNotAllowed);
  Network* const network = network_of(machine);
  const auto url = network ? network->listen(static_cast<std::uint16_t>(port), self.id, why) : std::nullopt;
  if (!url) machine.warn(fmt::format("listen: no server on port {}: {}", port, why));
  return machine.heap().string(url.value_or(""));
}

std::int32_t server_is_allowed(Machine& machine, Instance&) { return network_of(machine) ? 1 : 0; }

void server_close(Machine& machine, Instance& self, Text url) {
  if (const auto& network = machine.host().network) network->close(std::string(view(url)), self.id);
}

void server_answer(Machine& machine, Instance& self, Text url, Text index_page, Text folder, ListCell* exposed,
                   Instance* recipient) {
  if (!machine.host().network) return;
  Network& network = *machine.host().network;
  const std::string server(view(url));
  const ObjectId owner = self.id;
  // Copies: a method that is called may give the server other ones.
  const std::string start(view(index_page)), pages(view(folder));
  // It may also free the server, and these with it.
  const Pin list(machine, exposed ? Value::of(Tag::List, exposed) : Value());
  const Pin receiver(machine, recipient ? Value::of(Tag::Object, recipient) : Value());
  const Service service{machine, start, pages, exposed, recipient};
  for (std::size_t i = 0; i < kMostAtOnce; ++i) {
    const auto request = network.next_request(server, owner);
    if (!request) return;
    try {
      network.answer(server, answer_to(service, *request));
    } catch (...) {
      network.answer(server, failure(500, "the world has failed\n"));
      throw;
    }
  }
}

/// Send a request. RunError{World} if there is no answer.
std::string fetch(Machine& machine, const char* selector, const char* method, Text url, std::string_view body) {
  std::string why(kNotAllowed);
  Network* const network = network_of(machine);
  const auto answer = network ? network->fetch(method, std::string(view(url)), body, why) : std::nullopt;
  machine.poll();
  if (!answer) Machine::fail(RunErrorKind::World, fmt::format("{}: no answer from '{}': {}", selector, view(url), why));
  machine.charge(answer->size());
  return *answer;
}

Text url_get(Machine& machine, Instance&, Text url) {
  return machine.heap().string(fetch(machine, "get", "GET", url, {}));
}
Text url_put(Machine& machine, Instance&, Text text, Text url) {
  const std::string body(view(text));
  return machine.heap().string(fetch(machine, "put", "PUT", url, body));
}

/// A peer that is not there is a warning, not the end of the run.
Instance* send_object(Machine& machine, Instance& self, Text host, std::int32_t port) {
  if (port < 1 || port > 65535)
    throw Error(ErrorCode::Argument, fmt::format("send-over-network: there is no port {} (must be 1 to 65535)", port));
  const std::string url = fmt::format("http://{}:{}/", view(host), port), archive = to_archive(machine, self);
  std::string why(kNotAllowed);
  Network* const network = network_of(machine);
  const auto answer = network ? network->fetch("POST", url, archive, why) : std::nullopt;
  machine.poll();
  if (!answer) {
    machine.warn(fmt::format("send-over-network: {} was not sent to {}: {}", name_of(self), url, why));
    return nullptr;
  }
  machine.charge(answer->size());
  if (answer->empty()) return nullptr;
  try {
    return from_archive(machine, *answer, Origin::Network);
  } catch (const Error& error) {
    const ErrorCode code = error.code();
    if (code != ErrorCode::File && code != ErrorCode::Argument && code != ErrorCode::Image) throw;
    machine.warn(fmt::format("send-over-network: the answer of {} is not understood: {}", url, error.what()));
    return nullptr;
  }
}

constexpr Native kNetworkNatives[] = {
    native<server_open>("network-server.open", Reach::Network),
    native<server_is_allowed>("network-server.is-allowed"),
    native<server_close>("network-server.close"),
    native<server_answer>("network-server.answer-requests", Reach::Network),
    native<url_get>("url.get", Reach::Network),
    native<url_put>("url.put", Reach::Network),
    native<send_object>("object.send-over-network", Reach::Network),
    native<send_object>("data.send", Reach::Network),
};

}  // namespace

std::span<const Native> network_natives() { return kNetworkNatives; }

void serve_requests(Machine& machine) {
  const ClassInfo* const cls = machine.program().find_class("NetworkServer");
  if (!cls || !machine.host().network) return;
  for (const ObjectId id : machine.world().objects()) {
    const Instance* const server = machine.instance(id);
    if (server && server->live() && server->cls->derives_from(*cls)) machine.scheduled(id, "serve");
  }
}

}  // namespace breve::steve
