// The script side of a snapshot and of the world hash: every cell of the heap, by number instead of address.
#include <cstring>
#include <span>
#include <unordered_map>

#include "steve/machine/machine.hpp"

namespace breve::steve {

namespace {

constexpr std::uint64_t kNull = ~std::uint64_t{0};

/// Calls `visit` for every value that a container holds, in a fixed order.
template <class Visit>
void for_each_value(const Container& cell, Visit&& visit) {
  if (cell.tag == Tag::List) {
    for (const auto& element : static_cast<const ListCell&>(cell)) visit(element);
  } else if (cell.tag == Tag::Hash) {
    const auto& hash = static_cast<const HashCell&>(cell);
    for (std::uint32_t i = 0; i < hash.used; ++i) {
      if (!hash.entries[i].live()) continue;
      visit(hash.entries[i].key);
      visit(hash.entries[i].value);
    }
  } else {
    const auto& instance = static_cast<const Instance&>(cell);
    for (const ClassInfo* c = instance.cls; c; c = c->parent)
      for (const auto& v : c->variables) {
        if (v.type < StaticType::String || v.type > StaticType::Data) continue;
        const int count = v.array_size < 0 ? 1 : v.array_size;
        for (int i = 0; i < count; ++i)
          visit(Value::of(static_cast<Tag>(v.type), instance.slots[v.slot + static_cast<std::uint32_t>(i)].ref));
      }
  }
}

/// Calls `visit` with the bits of every slot that holds numbers. An int fills half a slot; the rest is not looked at.
template <class Visit>
void for_each_number(const Instance& instance, Visit&& visit) {
  for (const ClassInfo* c = instance.cls; c; c = c->parent)
    for (const auto& v : c->variables) {
      if (v.type >= StaticType::String && v.type <= StaticType::Data) continue;
      const int count = (v.array_size < 0 ? 1 : v.array_size) * slot_count(v.type);
      for (int i = 0; i < count; ++i) {
        Slot& slot = instance.slots[v.slot + static_cast<std::uint32_t>(i)];
        if (v.type == StaticType::Int) slot.bits = static_cast<std::uint32_t>(slot.i);
        visit(slot.bits);
      }
    }
}

/// Numbers for cells: containers first, the rest as they are met.
class Numbering {
 public:
  explicit Numbering(std::pmr::memory_resource* memory) : numbers_(memory), cells_(memory) {}
  std::uint64_t number(const Cell* cell) const { return numbers_.at(cell); }
  bool add(const Cell* cell) {
    const bool fresh = numbers_.emplace(cell, numbers_.size()).second;
    if (fresh) cells_.push_back(cell);
    return fresh;
  }
  const std::pmr::vector<const Cell*>& cells() const { return cells_; }

 private:
  std::pmr::unordered_map<const Cell*, std::uint64_t> numbers_;  // looked up only
  std::pmr::vector<const Cell*> cells_;
};

void put_head(ByteWriter& out, const Container& cell) {
  out.put(cell.tag);
  if (cell.tag == Tag::List) {
    const auto& list = static_cast<const ListCell&>(cell);
    out.put(list.serial);
  } else if (cell.tag == Tag::Hash) {
    out.put(static_cast<const HashCell&>(cell).serial);
  } else {
    const auto& instance = static_cast<const Instance&>(cell);
    out.put(instance.cls->id);
    out.put(instance.serial);
    out.put(instance.state);
    out.put(static_cast<std::uint8_t>(instance.auto_free));
    out.put(instance.id);
  }
}

void put_value(ByteWriter& out, const Value& v, const Numbering& numbering) {
  out.put(v.tag);
  switch (v.tag) {
    case Tag::Null: break;
    case Tag::Int: out.put(v.i); break;
    case Tag::Double: out.put(v.d); break;
    case Tag::Vector: out.put(v.vector()); break;
    default: out.put(v.ref ? numbering.number(v.ref) : kNull); break;
  }
}

/// Reads what Machine::save wrote of the cells: the heads of containers, what holds no references, then all contents.
class CellReader {
 public:
  CellReader(ByteReader& in, Heap& heap, const Program& program, std::span<StringCell* const> constants)
      : cells_(heap.memory()),
        instances_(heap.memory()),
        in_(in),
        heap_(heap),
        program_(program),
        constants_(constants) {}

  void read() {
    const auto containers = in_.get_count(9);
    for (std::size_t i = 0; i < containers; ++i) cells_.push_back(container());
    for (auto others = in_.get_count(2); others > 0; --others) cells_.push_back(leaf());
    for (std::size_t i = 0; i < containers; ++i) fill(*cells_[i]);
  }
  Cell* cell(std::uint64_t number) const {
    if (number >= cells_.size()) ByteReader::fail();
    return cells_[static_cast<std::size_t>(number)];
  }
  Cell* reference(Tag tag) {
    const auto number = in_.get<std::uint64_t>();
    if (number == kNull) return nullptr;
    Cell* found = cell(number);
    if (found->tag != tag) ByteReader::fail();
    return found;
  }
  std::span<Instance* const> instances() const { return instances_; }

 private:
  Value value() {
    const auto tag = in_.get<Tag>();
    switch (tag) {
      case Tag::Null: return Value();
      case Tag::Int: return Value::of(in_.get<std::int32_t>());
      case Tag::Double: return Value::of(in_.get<double>());
      case Tag::Vector: return Value::of(in_.get_vector());
      default: break;
    }
    if (tag > Tag::Data) ByteReader::fail();
    return Value::of(tag, reference(tag));
  }

  Cell* container() {
    const auto tag = in_.get<Tag>();
    if (tag == Tag::List) {
      auto* list = heap_.list();
      list->serial = in_.get<std::uint64_t>();
      return list;
    }
    if (tag == Tag::Hash) {
      auto* hash = heap_.hash();
      hash->serial = in_.get<std::uint64_t>();
      return hash;
    }
    if (tag != Tag::Object) ByteReader::fail();
    return instance();
  }

  Instance* instance() {
    const auto cls = in_.get<ClassId>();
    if (cls >= program_.classes().size()) ByteReader::fail();
    const ClassInfo& made = program_.cls(cls);
    promised_ += made.slot_count;
    if (promised_ > in_.left() / sizeof(Slot)) ByteReader::fail();
    auto* instance = heap_.instance(made);
    instance->serial = in_.get<std::uint64_t>();
    instance->state = in_.get<Instance::State>();
    instance->auto_free = in_.get_bool();
    instance->id = in_.get_object();
    if (instance->state > Instance::State::Freed) ByteReader::fail();
    if (instance->state != Instance::State::Freed && !instance->auto_free) heap_.retain(instance);
    instances_.push_back(instance);
    return instance;
  }

  Cell* leaf() {
    const auto tag = in_.get<Tag>();
    if (tag == Tag::String) return string();
    if (tag == Tag::Matrix) return heap_.matrix(in_.get_matrix());
    if (tag == Tag::Pointer) {
      auto* pointer = heap_.pointer(nullptr);  // what it pointed to, a file perhaps, is not part of a snapshot
      pointer->serial = in_.get<std::uint64_t>();
      return pointer;
    }
    if (tag != Tag::Data) ByteReader::fail();
    const auto serial = in_.get<std::uint64_t>();
    auto* data = heap_.data(in_.get_text());
    if (!data) ByteReader::fail();
    data->serial = serial;
    return data;
  }

  StringCell* string() {
    if (in_.get_bool()) {
      const auto number = in_.get<std::uint32_t>();
      if (number >= constants_.size() || !constants_[number]) ByteReader::fail();
      return constants_[number];
    }
    const auto capacity = in_.get<std::uint32_t>();
    const std::string_view text = in_.get_text();
    if (text.empty() || (capacity != 0 && (capacity < text.size() || capacity / 2 > text.size()))) ByteReader::fail();
    return capacity != 0 ? heap_.roomy_string(text, capacity) : heap_.string(text);
  }

  void fill(Cell& cell) {
    if (cell.tag == Tag::List) {
      auto& list = static_cast<ListCell&>(cell);
      for (auto n = in_.get_count(); n > 0; --n) heap_.push(list, value());
    } else if (cell.tag == Tag::Hash) {
      auto& hash = static_cast<HashCell&>(cell);
      for (auto n = in_.get_count(); n > 0; --n) {
        const auto key = value();
        heap_.set(hash, key, value());
      }
    } else {
      fill_instance(static_cast<Instance&>(cell));
    }
  }

  void fill_instance(Instance& instance) {
    for_each_number(instance, [&](std::uint64_t& bits) { bits = in_.get<std::uint64_t>(); });
    for (const ClassInfo* c = instance.cls; c; c = c->parent)
      for (const auto& v : c->variables) {
        if (v.type < StaticType::String || v.type > StaticType::Data) continue;
        const int count = v.array_size < 0 ? 1 : v.array_size;
        for (int k = 0; k < count; ++k) {
          const auto read = value();
          if (static_cast<int>(read.tag) != static_cast<int>(v.type)) ByteReader::fail();
          heap_.store(instance.slots[v.slot + static_cast<std::uint32_t>(k)], read.ref);
        }
      }
  }

  std::pmr::vector<Cell*> cells_;
  std::pmr::vector<Instance*> instances_;
  ByteReader& in_;
  Heap& heap_;
  const Program& program_;
  std::span<StringCell* const> constants_;
  std::size_t promised_ = 0;  // slots that instances have: what the image must hold yet
};

}  // namespace

void Machine::save(ByteWriter& out) const {
  Numbering numbering(memory_);
  std::pmr::unordered_map<const Cell*, std::uint32_t> constants(memory_);
  for (std::uint32_t i = 0; i < strings_.size(); ++i)
    if (strings_[i]) constants.emplace(strings_[i], i);
  const auto containers = heap_->containers();
  for (const auto* cell : containers) numbering.add(cell);
  for (const auto* cell : containers)
    for_each_value(*cell, [&](const Value& v) {
      if (v.is_reference() && v.ref) numbering.add(v.ref);
    });
  for (const auto* cell : heap_->waiting()) numbering.add(cell);

  out.put(static_cast<std::uint64_t>(containers.size()));
  for (const auto* cell : containers) put_head(out, *cell);
  out.put(static_cast<std::uint64_t>(numbering.cells().size() - containers.size()));
  for (std::size_t i = containers.size(); i < numbering.cells().size(); ++i) {
    const Cell* cell = numbering.cells()[i];
    out.put(cell->tag);
    const auto constant = constants.find(cell);
    if (cell->tag == Tag::String) {
      out.put(static_cast<std::uint8_t>(constant != constants.end()));
      if (constant != constants.end()) {
        out.put(constant->second);
      } else {
        const auto& string = *static_cast<const StringCell*>(cell);
        out.put(string.room());
        out.put(string.view());
      }
    } else if (cell->tag == Tag::Matrix) {
      out.put(static_cast<const MatrixCell*>(cell)->m);
    } else if (cell->tag == Tag::Pointer) {
      out.put(static_cast<const PointerCell*>(cell)->serial);
    } else {
      const auto* data = static_cast<const DataCell*>(cell);
      out.put(data->serial);
      out.put(std::string_view(reinterpret_cast<const char*>(data->bytes.data()), data->bytes.size()));
    }
  }
  for (const auto* cell : containers) {
    if (cell->tag == Tag::List) out.put(static_cast<std::uint64_t>(static_cast<const ListCell*>(cell)->size));
    if (cell->tag == Tag::Hash) out.put(static_cast<std::uint64_t>(static_cast<const HashCell*>(cell)->count_live));
    if (cell->tag == Tag::Object) {
      const auto* instance = static_cast<const Instance*>(cell);
      for_each_number(*instance, [&](std::uint64_t& bits) { out.put(bits); });
    }
    for_each_value(*cell, [&](const Value& v) { put_value(out, v, numbering); });
  }
  out.put(session_ ? numbering.number(session_) : kNull);
  heap_->save_state(out, [&](const Cell* cell) { return numbering.number(cell); });
  out.put(controller_ ? numbering.number(controller_) : kNull);
}

void Machine::load(ByteReader& in) {
  auto heap = make_in<Heap>(memory_, memory_, *this);
  budget_heap(*heap);
  auto constants = make_constants(*heap, *program_);
  CellReader reader(in, *heap, *program_, constants);
  reader.read();
  auto* session = static_cast<HashCell*>(reader.reference(Tag::Hash));
  heap->retain(session);
  heap->load_state(in, [&reader](std::uint64_t number) { return reader.cell(number); });
  auto* controller = static_cast<Instance*>(reader.reference(Tag::Object));
  if (in.left() != 0) ByteReader::fail();
  check_loaded(session, controller);
  name_objects(reader.instances());
  result_ = Value();
  heap_ = std::move(heap);
  strings_ = std::move(constants);
  controller_ = controller;
  session_ = session;
}

void Machine::check_loaded(const HashCell* session, const Instance* controller) const {
  if (controller && (!controller->live() || controller->cls != program_->controller_class())) ByteReader::fail();
  for (std::uint32_t i = 0; session && i < session->used; ++i) {
    const HashCell::Entry& entry = session->entries[i];
    if (entry.live() && (entry.key.tag != Tag::String || !entry.key.ref)) ByteReader::fail();
  }
}

/// Every object of the world is one of these, and each of these that was not freed is an object of the world.
void Machine::name_objects(std::span<Instance* const> instances) {
  std::size_t live = 0;
  for (Instance* instance : instances) {
    if (!instance->live()) continue;
    const ObjectId id = instance->id;
    const ClassInfo& cls = *instance->cls;
    if (!world_.alive(id) || world_.user(id) != 0 || world_.class_of(id) != cls.id ||
        !world_.runs(id, cls.iterate != nullptr, cls.post_iterate != nullptr))
      ByteReader::fail();
    world_.set_user(id, reinterpret_cast<std::uint64_t>(instance));
    ++live;
  }
  if (live != world_.object_count()) ByteReader::fail();
}

void Machine::hash(Hasher& hasher) const {
  Numbering numbering(memory_);
  const auto add_reference = [&](const Value& v) {
    if (!v.ref) {
      hasher.add(kNull);
    } else if (is_container(v.tag)) {
      numbering.add(v.ref);
      hasher.add(numbering.number(v.ref));
    } else if (v.tag == Tag::String) {
      hasher.add(v.string()->view());
    } else if (v.tag == Tag::Matrix) {
      hasher.add(v.matrix()->m);
    } else if (v.tag == Tag::Data) {
      const auto& bytes = v.data()->bytes;
      hasher.add(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    } else {
      hasher.add(v.pointer()->serial);
    }
  };
  const auto add_value = [&](const Value& v) {
    hasher.add(static_cast<std::uint64_t>(v.tag));
    switch (v.tag) {
      case Tag::Null: break;
      case Tag::Int: hasher.add(static_cast<std::uint64_t>(static_cast<std::uint32_t>(v.i))); break;
      case Tag::Double: hasher.add(v.d); break;
      case Tag::Vector: hasher.add(v.vector()); break;
      default: add_reference(v); break;
    }
  };
  for (const auto id : world_.objects()) numbering.add(reinterpret_cast<const Instance*>(world_.user(id)));
  for (std::size_t i = 0; i < numbering.cells().size(); ++i) {
    const auto& cell = static_cast<const Container&>(*numbering.cells()[i]);
    hasher.add(static_cast<std::uint64_t>(cell.tag));
    if (cell.tag == Tag::Object) {
      const auto& instance = static_cast<const Instance&>(cell);
      hasher.add(static_cast<std::uint64_t>(instance.cls->id));
      hasher.add(instance.serial);
      hasher.add(static_cast<std::uint64_t>(instance.state) * 2 + (instance.auto_free ? 1 : 0));
      for_each_number(instance, [&](std::uint64_t bits) { hasher.add(bits); });
    }
    for_each_value(cell, add_value);
  }
  hasher.add(controller_ ? controller_->serial : 0);
}

}  // namespace breve::steve
