// Calls of functions that whoever embeds the language gives: typed slots become values, and the result gets the type
// that was declared for it.
#include "steve/code/foreign.hpp"

#include <array>
#include <span>

#include "steve/machine/machine.hpp"
#include "steve/machine/operators.hpp"
#include "steve/machine/profiler.hpp"

namespace breve::steve {

namespace {

Value value_of_slots(Heap& heap, char letter, const Slot* slots) {
  switch (letter) {
    case 'i': return Value::of(slots->i);
    case 'd': return Value::of(slots->d);
    case 'v': return Value::of(SlotType<Vector3>::from(slots));
    case 'm': return Value::of(Tag::Matrix, heap.matrix(SlotType<Matrix3>::from(slots)));
    case 's': return Value::of(Tag::String, slots->ref);
    case 'o': return Value::of(Tag::Object, slots->ref);
    case 'l': return Value::of(Tag::List, slots->ref);
    case 'h': return Value::of(Tag::Hash, slots->ref);
    case 'b': return Value::of(Tag::Data, slots->ref);
    default: return SlotType<Value>::from(slots);
  }
}

int slots_of_letter(char letter) {
  switch (letter) {
    case 'v': return SlotType<Vector3>::slots;
    case 'm': return SlotType<Matrix3>::slots;
    case 'a': return SlotType<Value>::slots;
    default: return 1;
  }
}

Value converted(Heap& heap, char letter, const Value& value, std::string_view what) {
  switch (letter) {
    case 'i': return Value::of(to_int(value, what));
    case 'd': return Value::of(to_double(value, what));
    case 'v': return Value::of(to_vector(value, what));
    case 'm': return Value::of(Tag::Matrix, heap.matrix(to_matrix(value, what)));
    case 's': return Value::of(Tag::String, to_string(heap, value, what));
    case 'o': return Value::of(Tag::Object, to_object(value, what));
    case 'l': return Value::of(Tag::List, to_list(value, what));
    case 'h': return Value::of(Tag::Hash, to_hash(value, what));
    case 'b': return Value::of(Tag::Data, to_data(value, what));
    default: return value;
  }
}

}  // namespace

void Machine::call_foreign(std::size_t number, Instance& self, const Slot* args) {
  const ForeignFunction& function = *program_->foreign()[number];
  refuse_in_stage("call a function of the host");
  const StackMark mark(*this);
  std::array<Value, ForeignFunction::kMostParameters> values;
  const std::string& letters = function.signature();
  const std::size_t count = function.parameter_count();
  for (std::size_t i = 0; i < count; ++i) {
    if (letters[i] == 'd') {  // in words: see Value
      values[i].head = Value::head_of(Tag::Double);
      values[i].d = args++->d;
      continue;
    }
    values[i] = value_of_slots(*heap_, letters[i], args);
    if (letters[i] == 'm') pins_.push_back(values[i]);  // no slot holds its cell
    args += slots_of_letter(letters[i]);
  }
  // A method is entered already, as the one that a program sees.
  const ProfileScope scope(profiler_, function.is_method() ? nullptr : &function, profiler_ ? running_line() : 0);
  const Value result = host_.call_foreign(function, self, std::span<const Value>(values.data(), count));
  if (letters.back() == 'd' && result.tag == Tag::Double) {  // in words: see Value
    result_.head = Value::head_of(Tag::Double);
    result_.d = result.d;
    return;
  }
  result_ = converted(*heap_, letters.back(), result, function.result_name());
}

}  // namespace breve::steve
