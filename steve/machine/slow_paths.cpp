// What instructions do when the short way does not apply: conversions, members, containers, creation, printing.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "runtime/base/in_pieces.hpp"
#include "steve/machine/machine.hpp"
#include "steve/machine/operators.hpp"
#include "steve/machine/profiler.hpp"

namespace breve::steve {

Value Machine::null_default(StaticType type, std::uint32_t what, const Instruction* pc) {
  // NULL assigned to a typed variable stores the type's zero value, with one warning for each place.
  const auto& name = program_->code().texts.empty() ? std::string("value") : program_->code().texts[what];
  if (host_.strict)
    throw RunError(RunErrorKind::Conversion, "no value (NULL) for " + name,
                   "a method returns a value with 'return'; a missing key of a hash gives no value");
  if (reporter_.is_first(pc))
    warn("no value (NULL) is assigned to " + name +
         "; it becomes its type's zero value (a missing key of a hash and a method without 'return' give none)");
  switch (type) {
    case StaticType::Int: return Value::of(0);
    case StaticType::Double: return Value::of(0.0);
    case StaticType::Vector: return Value::of(Vector3(0, 0, 0));
    case StaticType::Matrix: return Value::of(Tag::Matrix, heap_->matrix(Matrix3::Zero()));
    case StaticType::List: return Value::of(Tag::List, heap_->list());
    case StaticType::Hash: return Value::of(Tag::Hash, heap_->hash());
    case StaticType::Any:
    case StaticType::Null: return {};
    default: return Value::of(static_cast<Tag>(type), nullptr);
  }
}

Value Machine::calculate(ast::BinaryOp op, const Value& x, const Value& y, bool absent_is_zero, const Instruction* pc) {
  const bool missing = (x.tag == Tag::Null && !absent_is_zero) || y.tag == Tag::Null;
  const Value result = binary(*heap_, op, x, y);
  if (!missing || op > ast::BinaryOp::Pow) return result;
  constexpr const char* kHelp = "a missing key of a hash and a method without 'return' give none";
  if (host_.strict) throw RunError(RunErrorKind::Conversion, "no value (NULL) is used in arithmetic", kHelp);
  if (reporter_.is_first(pc)) warn(fmt::format("no value (NULL) is used in arithmetic; it counts as 0 ({})", kHelp));
  return result;
}

Slot Machine::converted_reference(StaticType type, const Value& given, std::uint32_t what, bool strict,
                                  const Instruction* pc) {
  Slot slot{};
  if (static_cast<int>(given.tag) == static_cast<int>(type)) {
    slot.ref = given.ref;
  } else {
    Value value = given;
    if (value.tag == Tag::Null && !strict) value = null_default(type, what, pc);
    const auto& texts = program_->code().texts;
    write_value(&slot, type, value, texts.empty() ? std::string_view("value") : std::string_view(texts[what]));
  }
  if (slot.ref == nullptr && type == StaticType::List) slot.ref = heap_->list();
  if (slot.ref == nullptr && type == StaticType::Hash) slot.ref = heap_->hash();
  return slot;
}

// --- members of objects ----------------------------------------------------------------------------------------------

const VariableInfo* Machine::member_variable(const Instance& instance, Symbol name) const {
  const auto* variable = instance.cls->find_variable(name);
  if (variable && variable->array_size < 0) return variable;
  const auto& text = program_->symbols().name(name);
  if (variable)
    throw RunError(RunErrorKind::Type,
                   "'" + text + "' of class " + instance.cls->name + " is an array and cannot be used as a whole");
  std::vector<std::string_view> names;
  for (const ClassInfo* c = instance.cls; c; c = c->parent)
    for (const auto& v : c->variables) names.push_back(program_->symbols().name(v.name));
  const auto near = nearest(text, names);
  throw RunError(RunErrorKind::Type, "class " + instance.cls->name + " has no variable '" + text + "'",
                 !near.empty()                   ? "did you mean '" + near + "'?"
                 : responds(*instance.cls, text) ? "it is a method: write (object " + text + ")"
                                                 : "declare it under '+ variables:' of the class");
}

Instance& Machine::need_live(const Value& base, std::string_view name) const {
  auto* instance = base.object();
  if (!instance || !instance->live()) fail_member(name, instance);
  return *instance;
}

Value Machine::read_member(const Value& base, const MemberSite& site) {
  if (base.tag == Tag::Object) {
    auto& instance = need_live(base, program_->symbols().name(site.name));
    return get_variable(instance, *member_variable(instance, site.name));
  }
  return member(*heap_, base, strings_[site.string]);
}

bool Machine::write_member(Value& base, const MemberSite& site, const Value& value) {
  if (base.tag == Tag::Object) {
    auto& instance = need_live(base, program_->symbols().name(site.name));
    set_variable(instance, *member_variable(instance, site.name), value);
    return true;
  }
  if (base.tag == Tag::Hash) {
    set_member(*heap_, base, strings_[site.string], value);
    return true;
  }
  base = with_member(base, strings_[site.string], value);
  return false;
}

bool Machine::write_index(Value& base, const Value& key, const Value& value) {
  if (base.tag == Tag::Object) {
    if (key.tag != Tag::String)
      throw RunError(RunErrorKind::Type, "an object's variable is named by a string, not by " + a_type(key.tag));
    const auto name = program_->symbols().find(view(key.string()));
    auto& instance = need_live(base, view(key.string()));
    if (name == kNoSymbol)
      throw RunError(RunErrorKind::Type,
                     "class " + instance.cls->name + " has no variable '" + std::string(view(key.string())) + "'");
    set_variable(instance, *member_variable(instance, name), value);
    return true;
  }
  if (base.tag == Tag::List || base.tag == Tag::Hash) {
    set_index(*heap_, base, key, value);
    return true;
  }
  base = with_index(*heap_, base, key, value);
  return false;
}

Value Machine::read_index(const Value& base, const Value& key) {
  if (base.tag != Tag::Object) return index(*heap_, base, key);
  if (key.tag != Tag::String)
    throw RunError(RunErrorKind::Type, "an object's variable is named by a string, not by " + a_type(key.tag));
  auto& instance = need_live(base, view(key.string()));
  const auto name = program_->symbols().find(view(key.string()));
  if (name == kNoSymbol)
    throw RunError(RunErrorKind::Type,
                   "class " + instance.cls->name + " has no variable '" + std::string(view(key.string())) + "'");
  return get_variable(instance, *member_variable(instance, name));
}

Value Machine::guarded_index(const Value& base, const Value& key) {
  if (host_.strict) return read_index(base, key);
  try {
    return read_index(base, key);
  } catch (const RunError& error) {
    survive(ScriptError(error.code(), report(error, running())));
    return {};
  }
}

Value Machine::get_variable(const Instance& instance, const VariableInfo& variable) const {
  Slot* slot = instance.slots + variable.slot;
  auto& heap = *heap_;
  switch (variable.type) {
    case StaticType::Int: return Value::of(slot->i);
    case StaticType::Double: return Value::of(slot->d);
    case StaticType::Vector: return Value::of(Vector3(slot[0].d, slot[1].d, slot[2].d));
    case StaticType::Matrix: return Value::of(Tag::Matrix, heap.matrix(SlotType<Matrix3>::from(slot)));
    case StaticType::List:
      if (!slot->ref) heap.store(*slot, heap.list());
      break;
    case StaticType::Hash:
      if (!slot->ref) heap.store(*slot, heap.hash());
      break;
    default: break;
  }
  return Value::of(static_cast<Tag>(variable.type), slot->ref);
}

void Machine::set_variable(Instance& instance, const VariableInfo& variable, const Value& given) {
  if (!instance.live()) throw RunError(RunErrorKind::FreedObject, "a variable of a freed object cannot be set");
  const auto what = "variable '" + program_->symbols().name(variable.name) + "' of class " + instance.cls->name;
  if (variable.array_size >= 0)
    throw RunError(RunErrorKind::Type, what + " is an array and cannot be assigned as a whole");
  const Pin pin(*this, Value::of(Tag::Object, &instance));
  Value value = given;
  if (value.tag == Tag::Null) value = null_default(variable.type, 0, running());
  // Whoever hears the warning may free the object.
  if (!instance.live()) throw RunError(RunErrorKind::FreedObject, "a variable of a freed object cannot be set");
  Slot converted[9] = {};
  write_value(converted, variable.type, value, what);
  if (variable.class_name != kNoSymbol)
    if (const auto* cls = program_->find_class(program_->symbols().name(variable.class_name)))
      check_class(static_cast<Instance*>(converted[0].ref), *cls, what);
  Slot* slot = instance.slots + variable.slot;
  if (variable.type >= StaticType::String && variable.type <= StaticType::Data)
    heap_->store(*slot, converted[0].ref);
  else
    std::memcpy(static_cast<void*>(slot), converted,
                static_cast<std::size_t>(slot_count(variable.type)) * sizeof(Slot));
}

// --- creation, freeing, enumeration ----------------------------------------------------------------------------------

Value Machine::make_many(const Value& count, const ClassInfo& cls) {
  if (count.tag != Tag::Int)
    throw RunError(RunErrorKind::Type, "the number of new instances must be an int, not " + a_type(count.tag));
  if (count.i == 1) return Value::of(Tag::Object, create(cls));
  auto* list = heap_->list();
  const Pin pin(*this, Value::of(Tag::List, list));
  for (std::int32_t i = 0; i < count.i; ++i) heap_->push(*list, Value::of(Tag::Object, create(cls)));
  return Value::of(Tag::List, list);
}

/// A grid makes the object of a plain cell when a program asks for it, and `all` asks for all of them.
void Machine::make_cells_of(const ClassInfo& cls) {
  const ClassInfo *grids = program_->find_class("PatchGrid"), *patches = program_->find_class("Patch");
  if (!grids || !patches || !(cls.derives_from(*patches) || patches->derives_from(cls))) return;
  std::pmr::vector<ObjectId> found(heap_->memory());
  for (const auto id : world_.objects())
    if (program_->cls(world_.class_of(id)).derives_from(*grids)) found.push_back(id);
  if (found.empty()) return;
  const Value name = Value::of(Tag::String, heap_->string(cls.name));
  const Pin pin(*this, name);
  for (const auto id : found)
    if (Instance* grid = instance(id); grid && find_method(*grid->cls, "make-patches", 1))
      call(*grid, "make-patches", {&name, 1});
}

ListCell* Machine::all_of(const ClassInfo& cls) {
  make_cells_of(cls);
  constexpr std::uint64_t kOfObject = 4;
  charge_for(kOfObject * world_.object_count());
  auto* list = heap_->list();
  for (const auto id : world_.objects()) {
    if (!program_->cls(world_.class_of(id)).derives_from(cls)) continue;
    heap_->push(*list, Value::of(Tag::Object, reinterpret_cast<Instance*>(world_.user(id))));
  }
  return list;
}

void Machine::free_value(const Value& value) {
  if (value.tag == Tag::List && value.list()) {
    const auto* list = value.list();
    charge(list->size);  // one for each object, also where it is free already
    std::vector<Instance*> objects;
    for (const auto& element : *list)
      if (element.tag == Tag::Object && element.object()) objects.push_back(element.object());
    const Pin pin(*this, value);
    const StackMark mark(*this);
    for (auto* object : objects) pins_.push_back(Value::of(Tag::Object, object));
    constexpr std::size_t kBetweenPolls = 1024;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      if (i % kBetweenPolls == 0) poll();
      free_instance(*objects[i]);
    }
    return;
  }
  if (value.tag != Tag::Object) return;
  if (!value.object()) {
    warn("free of a null object");
    return;
  }
  free_instance(*value.object());
}

void Machine::sort(ListCell& list, Symbol symbol, Instance& self) {
  const auto* method = self.cls->find_method(symbol, 2);
  if (!method)
    throw RunError(RunErrorKind::UnknownMethod,
                   "unknown method: sort needs a method '" + program_->symbols().name(symbol) +
                       "' with two parameters in class " + self.cls->name,
                   "write one: + to " + program_->symbols().name(symbol) + " of a (object) with b (object):");
  const ProfileScope profiled(profiler_, Callee::act("sort"), profiler_ ? running_line() : 0);
  const Pin pin(*this, Value::of(Tag::List, &list));
  merge_sort(*heap_, list, [&](const Value& a, const Value& b) { return comes_before(self, *method, a, b); });
}

/// One comparison of a sort: a method called by position many times over. An error in it does not stop the run.
bool Machine::comes_before(Instance& self, const MethodInfo& method, const Value& a, const Value& b) {
  const auto& parameters = method.parameters;
  Value order;
  if (method.native || profiler_ || nesting_ >= kMaxNesting || !self.live() || parameters[0].class_name != kNoSymbol ||
      parameters[1].class_name != kNoSymbol) {
    const Value arguments[] = {a, b};
    if (!call_guarded(self, method, arguments, order)) return false;
  } else {
    const std::size_t depth = depth_;
    const Instruction* pc = running();
    try {
      try {
        count_call();
        const Nest nest(nesting_);
        Slot* base = enter(method, self)->base();
        try {
          write_argument(base, parameters[0], a);
          write_argument(base, parameters[1], b);
        } catch (...) {
          unwind(depth);
          throw;
        }
        execute<false>(depth);
      } catch (...) {
        rethrow(depth, pc);
      }
    } catch (const ScriptError& error) {
      if (error.code() != ErrorCode::Script && error.code() != ErrorCode::Depth) throw;
      survive(error);
      return false;
    }
    if (result_.tag == Tag::Double) return result_.d < 0;
    order = result_;
  }
  return order.tag != Tag::Null && to_double(order, "the result of the comparison") < 0;
}

void Machine::write_argument(Slot* base, const ParameterInfo& parameter, const Value& value) {
  const bool fits = static_cast<int>(value.tag) == static_cast<int>(parameter.type) && slot_count(parameter.type) == 1;
  if (fits)
    base[parameter.slot].bits = value.bits[0];
  else
    write_parameter(base, parameter, value, program_->symbols().name(parameter.keyword));
}

// --- text ------------------------------------------------------------------------------------------------------------

std::string Machine::text(const Value& value) {
  return steve::text(
      value, [this](Instance& instance) { return describe(instance); }, heap_.get());
}

std::string Machine::describe(Instance& instance) {
  const auto* method = instance.cls->get_description;
  if (!method || !instance.live()) return {};
  Value result;
  if (!call_guarded(instance, *method, {}, result) || result.tag != Tag::String) return {};
  return std::string(view(result.string()));
}

StringCell* Machine::interpolate(const std::vector<std::string>& texts, const Value* values, std::size_t count) {
  // A text that begins with another one adds to it.
  StringCell* begin = texts[0].empty() && values[0].tag == Tag::String ? values[0].string() : nullptr;
  std::size_t least = 0;  // what there is no room for is not begun
  for (std::size_t i = 0; i < count; ++i)
    if (values[i].tag == Tag::String) least += view(values[i].string()).size();
  heap_->check_room(least);
  const bool is_long = least > kPieceBytes;
  std::string out = begin ? texts[1] : texts[0];
  if (is_long) out.reserve(least);
  for (std::size_t i = begin ? 1 : 0; i < count; ++i) {
    if (values[i].tag == Tag::String) {
      const std::string_view more = view(values[i].string());
      heap_->check_room(out.size() + more.size());
      if (is_long)
        in_pieces(more.size(), 1, poller_,
                  [&](std::size_t from, std::size_t to) { out += more.substr(from, to - from); });
      else
        out += more;
    } else if (values[i].tag == Tag::Int)
      append_int(out, values[i].i);
    else if (values[i].tag == Tag::Double)
      append_double(out, values[i].d);
    else
      out += text(values[i]);
    out += texts[i + 1];
  }
  return begin ? heap_->append(begin, out) : heap_->string(out);
}

void Machine::print_value(const Value& value, int ending) {
  const ProfileScope profiled(profiler_, Callee::act("print"), profiler_ ? running_line() : 0);
  auto out = text(value);
  if (ending == 1) out += ' ';
  if (ending == 2) out += '\n';
  print(out);
}

Value Machine::random(const Value& bound) {
  auto& generator = world_.random();
  switch (bound.tag) {
    case Tag::Int: return Value::of(generator.below_or_equal(bound.i));
    case Tag::Double: return Value::of(bound.d * generator.uniform());
    case Tag::Vector: {
      Vector3 v;
      for (int i = 0; i < 3; ++i) v[i] = bound.v[i] * generator.uniform();
      return Value::of(v);
    }
    default:
      throw RunError(RunErrorKind::Type, "random[] takes an int, a double or a vector, not " + a_type(bound.tag));
  }
}

}  // namespace breve::steve
