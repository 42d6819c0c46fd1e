// Frames of running methods, on segments of slots that never move: a native's arguments stay where they are while it
// calls back into script.
#include <algorithm>
#include <cstring>

#include "steve/machine/machine.hpp"
#include "steve/machine/operators.hpp"
#include "steve/machine/profiler.hpp"

namespace breve::steve {

namespace {
constexpr std::size_t kFirstSegment = 4096;  // slots
}  // namespace

void Machine::next_segment(std::size_t slots) {
  const std::uint32_t next = segments_.empty() ? 0 : segment_ + 1;
  if (next < segments_.size() && segments_[next].second < slots) {
    for (std::size_t i = next; i < segments_.size(); ++i)
      memory_->deallocate(segments_[i].first, segments_[i].second * sizeof(Slot), alignof(Slot));
    segments_.resize(next);
  }
  if (next == segments_.size()) {
    const std::size_t size = std::max(slots, next == 0 ? kFirstSegment : segments_[next - 1].second * 2);
    segments_.reserve(segments_.size() + 1);
    segments_.emplace_back(static_cast<Slot*>(memory_->allocate(size * sizeof(Slot), alignof(Slot))), size);
  }
  segment_ = next;
  top_ = segments_[next].first;
  limit_ = top_ + segments_[next].second;
}

void Machine::fail_depth(const MethodInfo& method) const {
  throw RunError(RunErrorKind::Depth,
                 "methods call one another more than " + std::to_string(host_.depth_limit) + " deep: does '" +
                     program_->symbols().name(method.name) + "' call itself without end?",
                 "a recursion needs a case that ends it: the call chain below shows how it continues");
}

void Machine::unwind(std::size_t depth) {
  while (depth_ > depth) leave();
}

Value Machine::invoke(Instance& receiver, const MethodInfo& method, std::span<const Value> arguments) {
  if (nesting_ >= kMaxNesting)
    throw RunError(RunErrorKind::Depth, "calls between scripts and the library are nested more than " +
                                            std::to_string(kMaxNesting) + " deep");
  count_call();
  const std::size_t depth = depth_;
  const StackMark mark(*this);
  const Nest nest(nesting_);
  const auto write_all = [&](Slot* to) {
    for (std::size_t i = 0; i < arguments.size(); ++i)
      write_parameter(to, method.parameters[i], arguments[i], program_->symbols().name(method.parameters[i].keyword));
  };
  // A caller may not have looked at its own result yet: the library calls scripts also between two instructions.
  struct Kept {
    Machine& machine;
    std::size_t at;
    ~Kept() { machine.result_ = machine.pins_[at]; }
  };
  pins_.push_back(result_);
  const Kept kept{*this, pins_.size() - 1};
  pins_.push_back(Value::of(Tag::Object, &receiver));
  if (profiler_) profiler_->use(program_);
  const ProfileScope profiled(profiler_, Callee::of(method), 0);
  if (method.native) {
    need_room(kNativeRoom);
    Slot* args = top_;
    top_ += kNativeRoom;
    write_all(args);
    // No frame holds what a native was given, nor the texts that were made of it.
    for (const Value& argument : arguments) pins_.push_back(argument);
    for (const auto& parameter : method.parameters)
      if (parameter.type == StaticType::String) pins_.push_back(Value::of(Tag::String, args[parameter.slot].ref));
    Value result;
    try {
      method.native(*this, receiver, args, result);
    } catch (...) {
      if (depth > 0) throw;  // a script called: it tells the place
      rethrow(depth, nullptr);
    }
    return result;
  }
  Slot* base = enter(method, receiver)->base();
  std::memset(static_cast<void*>(base), 0, method.function->parameter_slots * sizeof(Slot));
  try {
    write_all(base);
  } catch (...) {
    unwind(depth);
    throw;
  }
  if (profiler_)
    execute<true>(depth);
  else
    execute<false>(depth);
  // Word by word, as it was written (interpreter.cpp).
  Value result;
  result.head = result_.head;
  for (int i = 0; i < 3; ++i) result.bits[i] = result_.bits[i];
  return result;
}

void Machine::write_parameter(Slot* base, const ParameterInfo& parameter, const Value& value, std::string_view what) {
  Slot* to = base + parameter.slot;
  write_value(to, parameter.type, value, what);
  if (parameter.class_name != kNoSymbol)
    if (const auto* cls = program_->find_class(program_->symbols().name(parameter.class_name)))
      check_class(static_cast<Instance*>(to->ref), *cls, what);
}

void Machine::write_value(Slot* to, StaticType type, const Value& value, std::string_view what) {
  switch (type) {
    case StaticType::Int: to->i = to_int(value, what); break;
    case StaticType::Double: to->d = to_double(value, what); break;
    case StaticType::Vector: {
      const auto v = to_vector(value, what);
      for (int i = 0; i < 3; ++i) to[i].d = v[i];
      break;
    }
    case StaticType::Matrix: {
      const auto m = to_matrix(value, what);
      for (int i = 0; i < 9; ++i) to[i].d = m.data()[i];
      break;
    }
    case StaticType::String: to->ref = to_string(*heap_, value, what); break;
    case StaticType::Object: to->ref = to_object(value, what); break;
    case StaticType::List: to->ref = to_list(value, what); break;
    case StaticType::Hash: to->ref = to_hash(value, what); break;
    case StaticType::Pointer: to->ref = to_pointer(value, what); break;
    case StaticType::Data: to->ref = to_data(value, what); break;
    case StaticType::Any:
    case StaticType::Null: std::memcpy(static_cast<void*>(to), &value, sizeof value); break;
  }
}

void Machine::write_default(Slot* to, const ParameterInfo& p) {
  if (p.default_fails)
    throw RunError(RunErrorKind::Conversion,
                   "the default of keyword '" + program_->symbols().name(p.keyword) + "' does not fit its type");
  switch (p.type) {
    case StaticType::Int: to->i = static_cast<std::int32_t>(p.default_numbers[0]); break;
    case StaticType::Double: to->d = p.default_numbers[0]; break;
    case StaticType::Vector: std::memcpy(static_cast<void*>(to), p.default_numbers.data(), 3 * sizeof(double)); break;
    case StaticType::Matrix: std::memcpy(static_cast<void*>(to), p.default_numbers.data(), 9 * sizeof(double)); break;
    case StaticType::String: to->ref = p.default_string == 0 ? nullptr : strings_[p.default_string - 1]; break;
    default: to->ref = nullptr; break;
  }
}

void Machine::visit_frames(const std::function<void(Cell*)>& visit) {
  for (Frame* frame = frame_; frame; frame = frame->caller) {
    visit(frame->self);
    for (const auto slot : frame->function->reference_slots) visit(frame->base()[slot].ref);
    for (const auto slot : frame->function->any_slots) {
      const auto& value = *reinterpret_cast<const Value*>(frame->base() + slot);
      if (value.is_reference()) visit(value.ref);
    }
  }
  for (const auto& pin : pins_)
    if (pin.is_reference()) visit(pin.ref);
  if (result_.is_reference()) visit(result_.ref);
}

void Machine::visit_roots(const std::function<void(Cell*)>& visit) { visit(session_); }

}  // namespace breve::steve
