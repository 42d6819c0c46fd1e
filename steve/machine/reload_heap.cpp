// The heap written anew under another program's classes: cells first, then what they hold, last what must be converted.
#include <cstring>

#include "steve/machine/operators.hpp"
#include "steve/machine/reload.hpp"

namespace breve::steve {

namespace {

bool is_reference(StaticType type) { return type >= StaticType::String && type <= StaticType::Data; }

std::uint32_t element_count(const VariableInfo& v) {
  return v.array_size < 0 ? 1 : static_cast<std::uint32_t>(v.array_size);
}

/// Calls `visit` for every reference that a container holds.
template <class Visit>
void for_each_reference(const Container& cell, Visit&& visit) {
  const auto value = [&](const Value& v) {
    if (v.is_reference() && v.ref) visit(v.ref);
  };
  if (cell.tag == Tag::List) {
    for (const auto& element : static_cast<const ListCell&>(cell)) value(element);
  } else if (cell.tag == Tag::Hash) {
    const auto& hash = static_cast<const HashCell&>(cell);
    for (std::uint32_t i = 0; i < hash.used; ++i) {
      if (!hash.entries[i].live()) continue;
      value(hash.entries[i].key);
      value(hash.entries[i].value);
    }
  } else {
    const auto& instance = static_cast<const Instance&>(cell);
    for (const auto slot : instance.cls->reference_slots)
      if (instance.slots[slot].ref) visit(instance.slots[slot].ref);
  }
}

}  // namespace

// --- cells -----------------------------------------------------------------------------------------------------------

void Reload::number(const Cell* cell) {
  if (numbers_.emplace(cell, cells_.size()).second) cells_.push_back(cell);
}

void Reload::number_cells() {
  const auto& heap = *machine_.heap_;
  for (const auto* cell : heap.containers()) number(cell);
  containers_ = cells_.size();
  for (const auto* cell : heap.containers()) for_each_reference(*cell, [this](const Cell* ref) { number(ref); });
  for (const auto* cell : heap.waiting()) number(cell);
  twins_.reserve(cells_.size());
}

void Reload::make_containers() {
  for (std::size_t i = 0; i < containers_; ++i) {
    if (cells_[i]->tag == Tag::List) {
      const auto& from = static_cast<const ListCell&>(*cells_[i]);
      auto* list = heap_->list(from.size);
      list->serial = from.serial;
      twins_.push_back(list);
    } else if (cells_[i]->tag == Tag::Hash) {
      auto* hash = heap_->hash();
      hash->serial = static_cast<const HashCell&>(*cells_[i]).serial;
      twins_.push_back(hash);
    } else {
      const auto& from = static_cast<const Instance&>(*cells_[i]);
      auto* instance = heap_->instance(class_of(from));
      instance->serial = from.serial;
      instance->state = from.state;
      instance->auto_free = from.auto_free;
      instance->id = from.id;
      if (from.state != Instance::State::Freed && !from.auto_free) heap_->retain(instance);  // by the table of objects
      twins_.push_back(instance);
    }
  }
}

void Reload::make_others() {
  std::unordered_map<std::string_view, StringCell*> constants;  // looked up only
  for (auto* constant : strings_)
    if (constant) constants.emplace(constant->view(), constant);
  for (std::size_t i = containers_; i < cells_.size(); ++i) {
    const Cell& cell = *cells_[i];
    if (cell.tag == Tag::String && cell.immortal) {
      const auto at = constants.find(static_cast<const StringCell&>(cell).view());
      if (at != constants.end()) {
        twins_.push_back(at->second);
        continue;
      }
    }
    twins_.push_back(make_other(cell));
  }
}

Cell* Reload::make_other(const Cell& cell) {
  switch (cell.tag) {
    case Tag::String: return heap_->string(static_cast<const StringCell&>(cell).view());
    case Tag::Matrix: return heap_->matrix(static_cast<const MatrixCell&>(cell).m);
    case Tag::Pointer: {
      auto* pointer = heap_->pointer(nullptr);
      pointer->serial = static_cast<const PointerCell&>(cell).serial;
      return pointer;
    }
    default: {
      const auto& from = static_cast<const DataCell&>(cell);
      auto* data = heap_->data({reinterpret_cast<const char*>(from.bytes.data()), from.bytes.size()});
      data->serial = from.serial;
      return data;
    }
  }
}

// --- contents --------------------------------------------------------------------------------------------------------

void Reload::fill(const Container& cell) {
  if (cell.tag == Tag::List) {
    auto& list = static_cast<ListCell&>(*twin(&cell));
    for (const auto& element : static_cast<const ListCell&>(cell)) heap_->push(list, twin(element));
  } else if (cell.tag == Tag::Hash) {
    const auto& from = static_cast<const HashCell&>(cell);
    auto& hash = static_cast<HashCell&>(*twin(&cell));
    for (std::uint32_t i = 0; i < from.used; ++i)
      if (from.entries[i].live()) heap_->set(hash, twin(from.entries[i].key), twin(from.entries[i].value));
  } else {
    const auto& from = static_cast<const Instance&>(cell);
    if (from.state != Instance::State::Freed) fill(from, static_cast<Instance&>(*twin(&cell)));
  }
}

void Reload::fill(const Instance& from, Instance& to) {
  const auto& plan = layout(*from.cls);
  for (const auto& move : plan.moves)
    if (!move.converts) copy(move, from, to);
  for (const auto* variable : plan.dropped)
    if (is_reference(variable->type)) drop(from.slots + variable->slot, element_count(*variable));
}

/// The counts of the old heap are the new one's until the collector's state is carried over; then they are released.
void Reload::drop(const Slot* slots, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!slots[i].ref) continue;
    dropped_.push_back(twin(slots[i].ref));
    heap_->retain(dropped_.back());
  }
}

bool Reload::accepts(const VariableInfo& variable, const Cell* object) const {
  if (!object || variable.class_name == kNoSymbol) return true;
  const auto* cls = program_->find_class(program_->symbols().name(variable.class_name));
  return !cls || static_cast<const Instance*>(object)->cls->derives_from(*cls);
}

void Reload::copy(const Move& move, const Instance& from, Instance& to) {
  const auto had = element_count(*move.from), has = element_count(*move.to);
  const auto count = std::min(had, has);
  const Slot* source = from.slots + move.from->slot;
  Slot* target = to.slots + move.to->slot;
  if (!is_reference(move.to->type)) {
    std::memcpy(static_cast<void*>(target), source,
                count * static_cast<std::size_t>(slot_count(move.to->type)) * sizeof(Slot));
    return;
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    Cell* ref = twin(source[i].ref);
    if (accepts(*move.to, ref)) {
      heap_->store(target[i], ref);
      continue;
    }
    drop(source + i, 1);
    warn(*to.cls, *move.to,
         "now takes objects of class " + program_->symbols().name(move.to->class_name) + " only; one of class " +
             static_cast<Instance*>(ref)->cls->name + " becomes null");
  }
  if (had > count) drop(source + count, had - count);
}

void Reload::carry_state() {
  ByteWriter out;
  machine_.heap_->save_state(out, [this](const Cell* cell) { return std::uint64_t{numbers_.at(cell)}; });
  ByteReader in(out.bytes().data(), out.bytes().size());
  heap_->load_state(in, [this](std::uint64_t number) { return twins_.at(static_cast<std::size_t>(number)); });
}

// --- variables of another type ---------------------------------------------------------------------------------------

void Reload::convert_variables() {
  for (std::size_t i = 0; i < containers_; ++i) {
    if (cells_[i]->tag != Tag::Object) continue;
    const auto& from = static_cast<const Instance&>(*cells_[i]);
    if (from.state == Instance::State::Freed) continue;
    for (const auto& move : layout(*from.cls).moves)
      if (move.converts) convert(move, from, static_cast<Instance&>(*twins_[i]));
  }
}

void Reload::convert(const Move& move, const Instance& from, Instance& to) {
  const auto what = "variable '" + program_->symbols().name(move.to->name) + "'";
  if ((move.from->array_size < 0) != (move.to->array_size < 0)) {
    warn(*to.cls, *move.to,
         move.to->array_size < 0 ? "was an array and is not one now: it starts at zero"
                                 : "is an array now and was not one before: it starts at zero");
    return;
  }
  const auto count = std::min(element_count(*move.from), element_count(*move.to));
  for (std::uint32_t i = 0; i < count; ++i) {
    const Slot* slot = from.slots + move.from->slot + i * static_cast<std::uint32_t>(slot_count(move.from->type));
    Value value;
    switch (move.from->type) {
      case StaticType::Int: value = Value::of(slot->i); break;
      case StaticType::Double: value = Value::of(slot->d); break;
      case StaticType::Vector: value = Value::of(SlotType<Vector3>::from(slot)); break;
      case StaticType::Matrix: value = Value::of(Tag::Matrix, heap_->matrix(SlotType<Matrix3>::from(slot))); break;
      default: value = Value::of(static_cast<Tag>(move.from->type), twin(slot->ref)); break;
    }
    // An empty list or hash, and a null object, are what a variable of any type starts with.
    if (value.is_reference() && !value.ref) continue;
    try {
      write(to.slots + move.to->slot + i * static_cast<std::uint32_t>(slot_count(move.to->type)), move.to->type, value,
            what);
    } catch (const RunError& error) {
      warn(*to.cls, *move.to, std::string("has another type now and starts at zero: ") + error.what());
    }
  }
}

void Reload::write(Slot* to, StaticType type, const Value& value, const std::string& what) {
  switch (type) {
    case StaticType::Int: to->i = to_int(value, what); break;
    case StaticType::Double: to->d = to_double(value, what); break;
    case StaticType::Vector: {
      const auto v = to_vector(value, what);
      std::memcpy(static_cast<void*>(to), v.data(), 3 * sizeof(double));
      break;
    }
    case StaticType::Matrix: {
      const auto m = to_matrix(value, what);
      std::memcpy(static_cast<void*>(to), m.data(), 9 * sizeof(double));
      break;
    }
    case StaticType::String: heap_->store(*to, to_string(*heap_, value, what)); break;
    case StaticType::Object: heap_->store(*to, to_object(value, what)); break;
    case StaticType::List: heap_->store(*to, to_list(value, what)); break;
    case StaticType::Hash: heap_->store(*to, to_hash(value, what)); break;
    case StaticType::Pointer: heap_->store(*to, to_pointer(value, what)); break;
    case StaticType::Data: heap_->store(*to, to_data(value, what)); break;
    case StaticType::Any:
    case StaticType::Null: break;
  }
}

}  // namespace breve::steve
