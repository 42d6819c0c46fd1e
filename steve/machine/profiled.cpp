// What the machine tells its profiler: one place, so that the loop and the slow paths say it in few words.
#include "steve/machine/machine.hpp"
#include "steve/machine/profiler.hpp"

namespace breve::steve {

void Machine::set_profiler(Profiler* profiler) {
  profiler_ = profiler;
  world_.set_stage_observer(profiler);
}

std::uint32_t Machine::running_line() const { return frame_ ? span_of(*frame_, frame_->pc).line : 0; }

std::size_t Machine::profile_depth() const { return profiler_->depth(); }

void Machine::profile_call(const MethodInfo& method) { profiler_->enter(Callee::of(method), running_line()); }

void Machine::profile_leave() { profiler_->leave(); }

void Machine::profile_unwind(std::size_t depth) { profiler_->unwind(depth); }

void Machine::call_native_profiled(const Plan& plan, Instance& receiver, const Slot* caller) {
  const ProfileScope scope(profiler_, Callee::of(*plan.method), running_line());
  call_native(plan, receiver, caller);
}

void Machine::call_function_profiled(const Native& function, Instance& self, const Slot* args, Value& result) {
  const ProfileScope scope(profiler_, Callee::of(function), running_line());
  function.function(*this, self, args, result);
}

void Machine::reclaim_profiled() {
  const ProfileScope scope(profiler_, Callee::stage("garbage"), running_line());
  heap_->reclaim();
}

}  // namespace breve::steve
