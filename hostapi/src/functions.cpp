// Functions of the host: declarations for the compiler, and the calls that scripts make.
#include "functions.hpp"

#include <algorithm>
#include <array>

#include "classes.hpp"
#include "steve/machine/native.hpp"
#include "steve/syntax/words.hpp"

namespace breve::host {

namespace {

using steve::ForeignFunction;
using steve::RunError;
using steve::RunErrorKind;
using steve::Value;

class HostFunction final : public ForeignFunction {
 public:
  HostFunction(const breve_function& f, std::string signature)
      : ForeignFunction(f.name, std::move(signature), f.doc ? f.doc : ""), call_(f.call), user_(f.user) {}
  ~HostFunction() override {
    if (destroy_) destroy_(user_);
  }
  breve_status call(const breve_call& call, breve_value& result) const { return call_(user_, &call, &result); }
  /// From now on the function answers for the host's data.
  void own(void (*destroy)(void* user)) { destroy_ = destroy; }
  /// The code of the function is in this library.
  void keep(std::shared_ptr<const PluginLibrary> library) { library_ = std::move(library); }

 private:
  const breve_function_fn call_;
  void* const user_;
  void (*destroy_)(void* user) = nullptr;
  std::shared_ptr<const PluginLibrary> library_;
};

}  // namespace

char letter_of(std::uint32_t type, const std::string& what) {
  switch (type) {
    case BREVE_TYPE_NULL: return 'a';
    case BREVE_TYPE_INT: return 'i';
    case BREVE_TYPE_DOUBLE: return 'd';
    case BREVE_TYPE_VECTOR: return 'v';
    case BREVE_TYPE_MATRIX: return 'm';
    case BREVE_TYPE_STRING: return 's';
    case BREVE_TYPE_OBJECT: return 'o';
    case BREVE_TYPE_LIST: return 'l';
    case BREVE_TYPE_HASH: return 'h';
    case BREVE_TYPE_DATA: return 'b';
    default:
      fail(BREVE_ERROR_ARGUMENT,
           what + " is " + std::to_string(type) + ", which is not a type that host functions can have");
  }
}

namespace {

std::string signature_of(const breve_function& f) {
  const std::string name = "function '" + std::string(f.name) + "'";
  if (f.parameter_count > ForeignFunction::kMostParameters)
    fail(BREVE_ERROR_ARGUMENT, name + " has " + std::to_string(f.parameter_count) + " parameters (must be at most " +
                                   std::to_string(ForeignFunction::kMostParameters) + ")");
  if (f.parameter_count != 0) need(f.parameters, "breve_function.parameters");
  std::string signature;
  for (std::size_t i = 0; i < f.parameter_count; ++i)
    signature += letter_of(f.parameters[i], "parameter " + std::to_string(i + 1) + " of " + name);
  return signature + ':' + letter_of(f.result, "the result of " + name);
}

/// BREVE_ERROR_ARGUMENT unless a program can call a function by that name, and none has it yet.
void check_name(const breve_runtime& runtime, std::string_view name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto fits = [&](char c) { return letter(c) || (c >= '0' && c <= '9'); };
  const std::string quoted = "'" + std::string(name) + "'";
  if (name.empty() || !letter(name.front()) || !std::all_of(name.begin(), name.end(), fits))
    fail(BREVE_ERROR_ARGUMENT, quoted +
                                   " cannot name a function: a name is made of letters, digits and '_', and does "
                                   "not begin with a digit");
  if (steve::word_of(name) != steve::Word::None)
    fail(BREVE_ERROR_ARGUMENT, quoted + " cannot name a function: it is a reserved word");
  const auto functions = steve::functions();
  if (std::any_of(functions.begin(), functions.end(), [&](const auto& f) { return f.name == name; }))
    fail(BREVE_ERROR_ARGUMENT, "the language has a function " + quoted + " already: choose another name");
  const auto has = [&](const steve::ForeignFunctions& added) {
    return std::any_of(added.begin(), added.end(), [&](const auto& f) { return f->name() == name; });
  };
  if (has(runtime.functions))
    fail(BREVE_ERROR_ARGUMENT, "the runtime has a function " + quoted + " already: choose another name");
  if (runtime.loading && has(runtime.loading->functions))
    fail(BREVE_ERROR_ARGUMENT, "the plugin adds the function " + quoted + " twice");
}

/// As to_host; numbers, which most arguments are, without the bytes behind them.
void pass(breve_world& world, const Value& value, breve_value& to) {
  if (value.tag != steve::Tag::Int && value.tag != steve::Tag::Double) {
    to = to_host(world, value);
    return;
  }
  to.type = static_cast<std::uint32_t>(value.tag);
  to.reserved = 0;
  if (value.tag == steve::Tag::Int)
    to.as.integer = value.i;
  else
    to.as.number = value.d;
}

/// What the host says, or else the error that a call of its own met.
std::string message_of(const breve_world& world, breve_status status, const std::string& reason) {
  if (!reason.empty()) return reason;
  const breve_error* error = world.error.view();
  if (!error || error->status != static_cast<std::uint32_t>(status)) return breve_status_name(status);
  const std::string location =
      error->line != 0 ? " (" + std::string(error->file) + ":" + std::to_string(error->line) + ")" : "";
  return error->message + location;
}

/// The error of a call that the host made in its method, as it was: it knows the whole chain of calls.
[[noreturn]] void throw_again(const breve_error& error) {
  steve::ErrorReport report;
  report.kind = RunErrorKind::World;
  report.message = error.message;
  report.help = error.help;
  report.file = error.file;
  report.line = error.line;
  report.column = error.column;
  report.length = error.length;
  report.text = error.text;
  for (std::size_t i = error.frame_count; i-- > 0;) {
    const breve_frame& f = error.frames[i];
    report.trace.push_back({f.class_name, f.method, f.file, f.receiver, f.arguments, f.line, f.column, false});
  }
  const auto code = error.status == BREVE_ERROR_BUDGET        ? ErrorCode::Budget
                    : error.status == BREVE_ERROR_DEPTH       ? ErrorCode::Depth
                    : error.status == BREVE_ERROR_INTERRUPTED ? ErrorCode::Interrupted
                                                              : ErrorCode::Script;
  throw steve::ScriptError(code, std::move(report));
}

/// @param errors  how many the world had known when the call began
[[noreturn]] void fail_call(const breve_world& world, const ForeignFunction& function, breve_status status,
                            const std::string& reason, std::uint64_t errors) {
  if (status == BREVE_ERROR_MEMORY) throw std::bad_alloc();
  const auto kind = status == BREVE_ERROR_BUDGET        ? RunErrorKind::Budget
                    : status == BREVE_ERROR_DEPTH       ? RunErrorKind::Depth
                    : status == BREVE_ERROR_INTERRUPTED ? RunErrorKind::Interrupted
                                                        : RunErrorKind::World;
  if (!function.is_method()) throw RunError(kind, function.name() + ": " + message_of(world, status, reason));
  const breve_error* inner = world.error.view();
  const bool same =
      reason.empty() && world.error.count() != errors && inner && inner->status == static_cast<std::uint32_t>(status);
  if (same && inner->frame_count != 0) throw_again(*inner);
  throw RunError(kind, message_of(world, status, reason), same ? inner->help : "");
}

}  // namespace

Value call_function(breve_world& world, const ForeignFunction& function, steve::Instance& self,
                    std::span<const Value> arguments) {
  std::array<breve_value, ForeignFunction::kMostParameters> values;
  Answer reason;
  const CallbackScope busy(world);
  const std::uint64_t errors = world.error.count();
  try {
    for (std::size_t i = 0; i < arguments.size(); ++i) pass(world, arguments[i], values[i]);
    breve_call call{sizeof(breve_call),
                    &world,
                    handle_of(world, world.machine->id_of(&self)),
                    values.data(),
                    arguments.size(),
                    &Answer::add,
                    &reason,
                    nullptr};
    breve_value result;
    result.type = BREVE_TYPE_NULL;
    result.reserved = 0;
    breve_status status = BREVE_OK;
    if (function.is_method()) {
      const auto& method = static_cast<const HostMethod&>(function);
      const ActiveScope active(world, method, call);
      status = method.call(call, result);
      if (status != BREVE_OK) active.failed();
    } else {
      status = static_cast<const HostFunction&>(function).call(call, result);
    }
    if (status == BREVE_OK)
      return result.type == BREVE_TYPE_DOUBLE ? Value::of(result.as.number) : from_host(world, result);
    fail_call(world, function, status, without_zeros(reason.text()), errors);
  } catch (const StatusError& e) {  // of the result
    throw RunError(RunErrorKind::Type, function.result_name() + ": " + e.what());
  }
}

}  // namespace breve::host

using namespace breve::host;

breve_status breve_runtime_add_function(breve_runtime* runtime, const breve_function* function) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  return guard(runtime->error, [&] {
    need(function, "function");
    const auto f = read_config(function, breve_function_default(), "breve_function");
    need(f.name, "breve_function.name");
    need(reinterpret_cast<const void*>(f.call), "breve_function.call");
    const AddingScope adding(*runtime);
    check_name(*runtime, f.name);
    auto made = std::make_shared<HostFunction>(f, signature_of(f));
    if (runtime->loading) made->keep(runtime->loading->library);
    (runtime->loading ? runtime->loading->functions : runtime->functions).push_back(made);
    made->own(f.destroy);  // nothing fails any more
  });
}

breve_status breve_world_charge(breve_world* world, uint64_t iterations) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (world->running != 0) world->machine->charge(iterations);
  });
}

bool breve_world_has_budget(const breve_world* world) {
  return world && (world->config.budget != 0 || world->config.call_budget != 0);
}
