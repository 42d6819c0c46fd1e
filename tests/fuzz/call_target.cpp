// Calls of every function of breve.h in any order, with any arguments, also from callbacks: no call crashes, hangs or
// leaks, each status is one that the header names for the function, and results are written only on BREVE_OK.
#include <algorithm>
#include <vector>

#include "call_functions.hpp"

namespace breve::fuzz {

namespace call_target {

/// Numbers of functions, each as often as its weight says.
std::vector<std::size_t> weighted() {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < all_functions().size(); ++i) numbers.insert(numbers.end(), all_functions()[i].weight, i);
  return numbers;
}

/// The share of a process's memory that one input may use: worlds, programs and analyses take time to make.
constexpr std::size_t kDeepest = 4, kFirstWorlds = 2;

}  // namespace call_target

std::span<const Function> all_functions() {
  static const std::vector<Function> all = [] {
    std::vector<Function> joined;
    for (const auto part :
         {runtime_functions(), world_functions(), object_functions(), bulk_functions(), value_functions(),
          body_functions(), joint_functions(), space_functions(), event_functions(), step_functions(),
          setting_functions(), view_functions(), analysis_functions()})
      joined.insert(joined.end(), part.begin(), part.end());
    return joined;
  }();
  return all;
}

std::span<Tally> tallies() {
  static std::vector<Tally> counts(all_functions().size());
  return counts;
}

Caller::Caller(Bytes bytes) : choices_(bytes), first_destroyed_(choices_.below(4)), backwards_(choices_.chance(50)) {}

void Caller::make_call() {
  static const std::vector<std::size_t> numbers = call_target::weighted();
  make_call(all_functions()[choices_.one_of(numbers)]);
}

void Caller::make_call(const Function& function) {
  if (depth_ == call_target::kDeepest) return;
  Demand demand;
  Demand* const outer = demand_;
  demand_ = &demand;
  ++depth_;
  if (chance(3)) allocations_until_failure_ = 1 + choices_.below(2000);
  const breve_status status = function.call(*this);
  if (depth_ == 1) allocations_until_failure_ = 0;
  --depth_;
  demand_ = outer;
  check(function, demand, status);
}

void Caller::check(const Function& function, const Demand& demand, breve_status status) {
  Tally& tally = tallies()[static_cast<std::size_t>(&function - all_functions().data())];
  ++tally.calls;
  tally.succeeded += status == BREVE_OK;
  tally.called_back += depth_ > 0;
  if (function.may_give & kPlain) return;
  const std::string what = std::string(function.name) + " gives " + breve_status_name(status);
  constexpr Statuses kAny = status_bit(BREVE_OK) | status_bit(BREVE_ERROR_ARGUMENT) | status_bit(BREVE_ERROR_MEMORY);
  const breve_error* error = demand.world     ? breve_world_last_error(demand.world)
                             : demand.runtime ? breve_runtime_last_error(demand.runtime)
                                              : nullptr;
  const char* told = error ? error->text : "";
  require(((kAny | function.may_give) & status_bit(status)) != 0, what + ", which it does not name", told);
  if (demand.null_handle) require(status == BREVE_ERROR_ARGUMENT, what + " for a NULL handle", told);
  if (demand.refusal) require(status != BREVE_OK, what + " for an argument that it has to refuse", told);
  if (status == BREVE_OK || (!demand.world && !demand.runtime)) return;
  require(error != nullptr, what + " and keeps no error");
  require(error->status == status, what + " and keeps another status", told);
  for (const char* text : {error->message, error->help, error->file, error->text}) read_text(text);
  for (std::size_t i = 0; i < error->frame_count; ++i)
    for (const char* text : {error->frames[i].class_name, error->frames[i].method, error->frames[i].file,
                             error->frames[i].receiver, error->frames[i].arguments})
      read_text(text);
}

void Caller::call_back(breve_world* speaker) {
  if (depth_ >= call_target::kDeepest || !chance(20)) return;
  if (speaker) speakers_.push_back(speaker);
  for (std::size_t calls = 1 + choices_.below(2); calls > 0; --calls) make_call();
  if (speaker) speakers_.pop_back();
}

void Caller::start() {
  for (breve_runtime*& runtime : runtimes_) {
    const breve_runtime_config config = runtime_config();
    require(breve_runtime_create(&config, &runtime) == BREVE_OK, "no runtime");
  }
  compile_text(0, choices_.one_of(call_programs()));
  if (chance(30)) compile_text(1, choices_.one_of(call_programs()));
  const auto create = std::find_if(all_functions().begin(), all_functions().end(), [](const Function& function) {
    return std::string_view(function.name) == "breve_world_create";
  });
  for (std::size_t i = 0; i < call_target::kFirstWorlds; ++i) make_call(*create);
}

void Caller::compile_text(std::size_t runtime, std::string_view text) {
  breve_program* made = nullptr;
  const breve_status status = breve_program_compile(runtimes_[runtime], "scene.tz", text.data(), text.size(), &made);
  if (status == BREVE_OK)
    programs_.push_back(made);
  else
    require(status == BREVE_ERROR_MEMORY, "a program does not compile",
            breve_runtime_last_error(runtimes_[runtime])->text);
}

void Caller::run() {
  start();
  while (!choices_.empty()) make_call();
  finish();
}

void Caller::finish() {
  if (backwards_) {
    std::reverse(worlds_.begin(), worlds_.end());
    std::reverse(programs_.begin(), programs_.end());
  }
  for (std::size_t i = 0; i < 4; ++i) switch ((first_destroyed_ + (backwards_ ? 4 - i : i)) % 4) {
      case 0:
        for (breve_world* world : worlds_)
          require(breve_world_destroy(world) == BREVE_OK, "a world cannot be destroyed");
        break;
      case 1:
        for (breve_program* program : programs_) breve_program_destroy(program);
        break;
      case 2:
        for (breve_analysis* analysis : analyses_) breve_analysis_destroy(analysis);
        break;
      default:
        for (breve_runtime* runtime : runtimes_)
          require(breve_runtime_destroy(runtime) == BREVE_OK, "a runtime cannot be destroyed");
    }
  for (const Ledger& ledger : ledgers_) {
    require(ledger.bytes == 0, "memory of a world was not given back");
    require(ledger.files == 0, "a file was not closed");
    require(ledger.modules == 0, "a module was not released");
    require(ledger.plugins == 0, "a plugin was not closed");
    require(ledger.retained == 0, "files were not released");
  }
}

void fuzz_call(Bytes bytes) {
  Caller caller(bytes);
  caller.run();
}

}  // namespace breve::fuzz
