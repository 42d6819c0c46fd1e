// The messages for a call that cannot be made: about its receiver, its method, its keywords.
#include <fmt/format.h>

#include <algorithm>

#include "steve/code/wording.hpp"
#include "steve/machine/brief.hpp"
#include "steve/machine/machine.hpp"
#include "steve/syntax/lexer.hpp"

namespace breve::steve {

namespace {

constexpr std::size_t kLongestReceiver = 50;
constexpr std::size_t kMostLocations = 3;

bool is_name(std::string_view text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  if (text.empty() || !letter(text.front())) return false;
  return std::all_of(text.begin(), text.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-'; });
}

/// The method in whose text a place stands; null if it is in none.
const MethodInfo* method_around(const Program& program, const Span& location) {
  const MethodInfo* found = nullptr;
  for (const auto& cls : program.classes()) {
    if (cls->span.file != location.file) continue;
    for (const auto& method : cls->methods) {
      if (method->span.offset > location.offset) continue;
      if (found == nullptr || method->span.offset > found->span.offset) found = method.get();
    }
  }
  return found;
}

}  // namespace

Machine::Receiver Machine::receiver_of_site(const Span& selector) const {
  Receiver receiver;
  if (frame_ == nullptr || selector.line == 0) return receiver;
  const Span call = span_of(*frame_, frame_->pc);
  if (call.file != selector.file || call.offset >= selector.offset) return receiver;
  const auto& source = program_->sources().file(call.file).text;
  std::uint32_t begin = call.offset, end = selector.offset;
  const auto blank = [&](std::uint32_t at) { return source[at] == ' ' || source[at] == '\t' || source[at] == '\n'; };
  while (end > begin && blank(end - 1)) --end;
  const auto count = [&](char c) { return std::count(source.begin() + begin, source.begin() + end, c); };
  for (auto open = count('(') - count(')'); begin < end && (blank(begin) || (open > 0 && source[begin] == '('));
       ++begin)
    if (source[begin] == '(') --open;
  if (begin >= end) return receiver;
  receiver.span = program_->sources().span_at(call.file, begin, end - begin);
  receiver.text = cut(std::string_view(source).substr(begin, end - begin), kLongestReceiver);
  if (!is_name(receiver.text)) return receiver;
  const auto name = program_->symbols().find(receiver.text);
  const auto& parameters = frame_->method->parameters;
  if (std::any_of(parameters.begin(), parameters.end(), [&](const auto& p) { return p.variable == name; })) {
    receiver.kind = Receiver::Kind::Parameter;
  } else if (name != kNoSymbol) {
    receiver.kind = Receiver::Kind::Variable;
    receiver.member = frame_->method->owner->find_variable(name);
  }
  return receiver;
}

// Where the program assigns to a variable of this instance: found in its text, since nobody keeps it otherwise. Null
// once much has been looked through: errors that do not stop a run may be many.
std::optional<std::string> Machine::where_assigned(const Receiver& receiver) const {
  std::vector<std::string> locations;
  std::size_t more = 0;
  const auto& sources = program_->sources();
  constexpr std::uint64_t kMostBytes = 8 << 20;  // of text that is looked through in the life of a machine
  for (std::uint32_t file = 0; file < sources.size(); ++file) {
    if (sources.file(file).embedded) continue;
    searched_ += sources.file(file).text.size();
    if (searched_ > kMostBytes) return std::nullopt;
    Diagnostics ignored;
    const auto tokens = lex(sources, file, ignored);
    for (std::size_t i = 1; i + 1 < tokens.size(); ++i) {
      if (tokens[i].text != receiver.text || tokens[i + 1].text != "=") continue;
      const auto* method = method_around(*program_, tokens[i].span);
      if (method == nullptr) continue;
      const bool member = tokens[i - 1].text == "::";
      if (!member && !frame_->self->cls->derives_from(*method->owner)) continue;
      if (locations.size() < kMostLocations) {
        locations.push_back(fmt::format("{}.{} ({}:{})", method->owner->name, program_->symbols().name(method->name),
                                        sources.file(file).name, tokens[i].span.line));
      } else {
        ++more;
      }
    }
  }
  if (more > 0) locations.push_back(fmt::format("{} more places", more));
  return joined(locations);
}

void Machine::fail_receiver(const Instance* receiver, std::uint32_t number) const {
  const auto& site = program_->code().sites[number];
  if (receiver == nullptr) fail_null_receiver(site);
  const auto& name = program_->symbols().name(site.selector);
  const Receiver who = receiver_of_site(site.span);
  const std::string object = fmt::format("{} {:#x}, which has been freed", receiver->cls->name, receiver->serial);
  const std::string help =
      who.kind == Receiver::Kind::Expression
          ? "a freed object counts as false: test it with 'if' before the call"
          : fmt::format("a freed object counts as false: test it first, as in   if {0}: {0} {1}", who.text, name);
  const std::string subject =
      who.text.empty()                        ? "its receiver refers to "
      : who.kind == Receiver::Kind::Variable  ? fmt::format("the variable '{}' refers to ", who.text)
      : who.kind == Receiver::Kind::Parameter ? fmt::format("the parameter '{}' refers to ", who.text)
                                              : fmt::format("{} is ", who.text);
  throw RunError(RunErrorKind::FreedObject, fmt::format("cannot call '{}': {}{}", name, subject, object), help,
                 who.span);
}

void Machine::fail_null_receiver(const CallSite& site) const {
  const auto& name = program_->symbols().name(site.selector);
  if (site.super_of)
    throw RunError(RunErrorKind::NullObject,
                   fmt::format("cannot call '{}' of 'super': class {} has no parent", name, site.super_of->name),
                   "remove the call, or give the class a parent");
  const Receiver who = receiver_of_site(site.span);
  const auto error = [&](const std::string& subject, const std::string& help) {
    return RunError(RunErrorKind::NullObject, fmt::format("cannot call '{}': {}", name, subject), help, who.span);
  };
  if (who.kind == Receiver::Kind::Parameter)
    throw error(fmt::format("the parameter '{}' is null: the caller passed no object", who.text),
                fmt::format("look at the call below; or test it first, as in   if {0}: {0} {1}", who.text, name));
  if (who.kind == Receiver::Kind::Expression)
    throw error((who.text.empty() ? std::string("its receiver") : who.text) + " is null: there is no object to call",
                "test the value with 'if' before the call");
  const std::string null = fmt::format("the variable '{}' is null: no object was assigned to it", who.text);
  const std::string cls = who.member && who.member->class_name != kNoSymbol
                              ? program_->symbols().name(who.member->class_name)
                              : std::string("CLASS");
  const auto found = who.member ? where_assigned(who) : std::nullopt;
  if (!found) throw error(null, fmt::format("assign an object before this line, as in   {} = new {}.", who.text, cls));
  const std::string& locations = *found;
  if (locations.empty())
    throw error(null, fmt::format("nothing assigns it yet: do so in 'init', as in   {} = new {}.", who.text, cls));
  throw error(null, fmt::format("it is assigned in {}: has that method been called for this object?", locations));
}

// The call that a Broadcast instruction is made for: the next one on the register that it fills.
const CallSite* Machine::broadcast_site() const {
  if (frame_ == nullptr) return nullptr;
  const auto& code = frame_->function->code;
  const auto here = static_cast<std::size_t>(frame_->pc - code.data());
  for (std::size_t at = here; at >= 2 && at < code.size(); ++at) {
    const Instruction& in = code[at];
    if (in.op == Op::Call && in.a == code[here - 2].b)
      return &program_->code().sites[static_cast<std::size_t>(in.imm())];
  }
  return nullptr;
}

void Machine::fail_call_on(const Value& value) const {
  const auto* site = broadcast_site();
  const Receiver who = site ? receiver_of_site(site->span) : Receiver();
  const std::string call =
      site ? fmt::format("cannot call '{}'", program_->symbols().name(site->selector)) : "cannot call a method";
  if (value.tag == Tag::Null)
    throw RunError(
        RunErrorKind::NullObject,
        fmt::format("{}: {} returned no value (NULL)", call, who.text.empty() ? "its receiver" : who.text),
        "a method returns a value with 'return'; a missing key of a hash and 'pop' of an empty list give no value",
        who.span);
  const std::string is = who.kind == Receiver::Kind::Variable    ? fmt::format("the variable '{}' is ", who.text)
                         : who.kind == Receiver::Kind::Parameter ? fmt::format("the parameter '{}' is ", who.text)
                         : is_name(who.text)                     ? fmt::format("'{}' is ", who.text)
                         : who.text.empty()                      ? "this is "
                                                                 : fmt::format("{} is ", who.text);
  const bool zero = value.tag == Tag::Int && value.i == 0;
  const std::string what = zero ? "0, which means no object" : typed_brief(value);
  throw RunError(RunErrorKind::Type, fmt::format("{}: {}{}", call, is, what),
                 "only objects, and lists of objects, have methods", who.span);
}

Instance* Machine::broadcast_member(const Value& element) const {
  if (element.tag == Tag::Object && element.object() && element.object()->live()) return element.object();
  const auto kind = element.tag != Tag::Object ? RunErrorKind::Type
                    : element.object()         ? RunErrorKind::FreedObject
                                               : RunErrorKind::NullObject;
  throw RunError(kind, "a method is called on every element of a list, and one element is " + typed_brief(element),
                 "every element must be a live object: remove other elements first, or call in a foreach loop");
}

// A variable of an object that is null or freed.
void Machine::fail_member(std::string_view name, const Instance* object) const {
  Receiver who;
  if (frame_ != nullptr) {
    const Span location = span_of(*frame_, frame_->pc);
    const std::string_view text =
        std::string_view(program_->sources().file(location.file).text).substr(location.offset, location.length);
    if (const auto at = text.find("::" + std::string(name)); at != std::string_view::npos)
      who = receiver_of_site(
          {location.file, location.offset + static_cast<std::uint32_t>(at), 1, location.line, location.column});
  }
  const std::string subject = who.text.empty()                        ? "its object"
                              : who.kind == Receiver::Kind::Parameter ? fmt::format("the parameter '{}'", who.text)
                              : who.kind == Receiver::Kind::Variable  ? fmt::format("the variable '{}'", who.text)
                                                                      : who.text;
  const std::string text = who.text.empty() ? "object" : who.text;
  if (object == nullptr)
    throw RunError(RunErrorKind::NullObject,
                   fmt::format("there is no '{}': {} is null, no object was assigned to it", name, subject),
                   fmt::format("assign an object first, or test it, as in   if {0}: print {0}::{1}", text, name),
                   who.span);
  throw RunError(
      RunErrorKind::FreedObject,
      fmt::format("there is no '{}' any more: {} refers to {} {:#x}, which has been freed", name, subject,
                  object->cls->name, object->serial),
      fmt::format("a freed object counts as false: test it first, as in   if {0}: print {0}::{1}", text, name),
      who.span);
}

void Machine::fail_unknown_class(std::string_view name) const {
  std::vector<std::string_view> names;
  for (const auto& cls : program_->classes()) names.push_back(cls->name);
  const auto near = nearest(name, names);
  throw RunError(RunErrorKind::UnknownClass, fmt::format("there is no class '{}'", name),
                 near.empty() ? "define it, or load its file with @use" : "did you mean '" + near + "'?");
}

void Machine::fail_call(const CallSite& site, const ClassInfo& cls, const MethodInfo* best) const {
  const ClassInfo* start = site.super_of ? site.super_of->parent : &cls;
  for (const ClassInfo* c = start; c && !best; c = c->parent)
    for (const auto& method : c->methods)
      if (method->name == site.selector && !best) best = method.get();
  if (!best) fail_unknown_method(site, start ? start : &cls);
  const Span call = frame_ && site.span.line != 0 ? span_of(*frame_, frame_->pc) : Span();
  const auto fault = call_fault(site, *best, program_->symbols(), program_->sources(), call);
  throw RunError(
      fault.kind == CallFault::Kind::MissingKeyword ? RunErrorKind::MissingKeyword : RunErrorKind::UnknownKeyword,
      fault.message, fault.help, fault.span);
}

void Machine::fail_unknown_method(const CallSite& site, const ClassInfo* start) const {
  const auto& name = program_->symbols().name(site.selector);
  throw RunError(RunErrorKind::UnknownMethod, fmt::format("class {} has no method '{}'", start->name, name),
                 unknown_method_help(name, start, *program_), site.span);
}

}  // namespace breve::steve
