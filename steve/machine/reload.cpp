// Which class takes the place of which, whether that can be, and the moment of exchange.
#include "steve/machine/reload.hpp"

#include <algorithm>
#include <map>

#include "steve/compile/evaluate.hpp"
#include "steve/machine/profiler.hpp"

namespace breve::steve {

namespace {

/// The nearest class of the class library in the line: it decides what an object is besides its variables, a body or an
/// image. Null: a class that stands on none.
const ClassInfo* library_base(const Program& program, const ClassInfo& cls) {
  const ClassInfo* c = &cls;
  while (c && !program.sources().file(c->span.file).embedded) c = c->parent;
  return c;
}

std::string objects_of(const ClassInfo& cls, std::size_t count) {
  return std::to_string(count) + (count == 1 ? " object" : " objects") + " of class " + cls.name +
         (count == 1 ? " lives" : " live");
}

}  // namespace

Reload::Reload(Machine& machine, std::shared_ptr<const Program> program)
    : machine_(machine),
      program_(std::move(program)),
      strings_(machine.memory_),
      numbers_(machine.memory_),
      cells_(machine.memory_),
      twins_(machine.memory_),
      dropped_(machine.memory_) {}

std::vector<std::string> Reload::run() {
  find_classes();
  check_controller();
  heap_ = make_in<Heap>(machine_.memory_, machine_.memory_, machine_);
  machine_.budget_heap(*heap_);
  strings_ = machine_.make_constants(*heap_, *program_);
  number_cells();
  make_containers();
  make_others();
  for (std::size_t i = 0; i < containers_; ++i) fill(static_cast<const Container&>(*cells_[i]));
  if (machine_.session_) heap_->retain(twin(machine_.session_));
  carry_state();
  convert_variables();
  for (Cell* cell : dropped_) heap_->release(cell);
  dropped_.clear();
  exchange();
  return std::move(warnings_);
}

// --- classes ---------------------------------------------------------------------------------------------------------

void Reload::find_classes() {
  const auto& old = machine_.program().classes();
  for (const auto& cls : old) classes_.push_back(program_->find_class(cls->name));
  std::map<ClassId, std::size_t> objects;
  for (const auto id : machine_.world_.objects()) ++objects[machine_.world_.class_of(id)];
  for (const auto& [cls, count] : objects) check_object_class(*old[cls], count);
}

void Reload::check_object_class(const ClassInfo& from, std::size_t objects) const {
  const auto* to = classes_[from.id];
  if (!to)
    throw Error(ErrorCode::Reload, objects_of(from, objects) +
                                       ", and the new program has no such class: keep the class, or free them first");
  const auto* had = library_base(machine_.program(), from);
  const auto* has = library_base(*program_, *to);
  const auto name = [](const ClassInfo* cls) {
    return cls ? cls->name : std::string("a class outside of the library");
  };
  if (name(had) != name(has))
    throw Error(ErrorCode::Reload, objects_of(from, objects) + ", made as " + name(had) +
                                       ", and in the new program the class comes from " + name(has) +
                                       ": objects cannot change from one to the other; free them first, or "
                                       "start the simulation again");
}

void Reload::check_controller() const {
  const auto* controller = machine_.controller_;
  if (!controller) return;
  const auto* wanted = program_->controller_class();
  const auto* has = classes_[controller->cls->id];
  if (wanted != has)
    throw Error(ErrorCode::Reload, "the new program's controller is " + (wanted ? wanted->name : std::string("none")) +
                                       ", and the one that runs is of class " + controller->cls->name +
                                       ": start the simulation again to change it");
}

// Only the class name of a freed object is ever shown; if the class is gone, that of its nearest ancestor.
const ClassInfo& Reload::class_of(const Instance& instance) const {
  for (const ClassInfo* c = instance.cls; c; c = c->parent)
    if (classes_[c->id]) return *classes_[c->id];
  return *program_->classes().front();
}

// A variable is found again by its name in the class that declares it, or else by its name anywhere in the line: it may
// have moved to a parent.
const Reload::Layout& Reload::layout(const ClassInfo& from) {
  const auto [at, added] = layouts_.try_emplace(&from);
  Layout& out = at->second;
  if (!added) return out;
  struct Old {
    const ClassInfo* owner;
    const VariableInfo* variable;
    bool taken;
  };
  std::vector<Old> old;
  for (const ClassInfo* c = &from; c; c = c->parent)
    for (const auto& v : c->variables) old.push_back({c, &v, false});
  const auto& old_names = machine_.program().symbols();
  const auto& new_names = program_->symbols();
  for (const bool same_owner : {true, false})
    for (const ClassInfo* c = classes_[from.id]; c; c = c->parent)
      for (const auto& v : c->variables) {
        if (std::any_of(out.moves.begin(), out.moves.end(), [&](const Move& m) { return m.to == &v; })) continue;
        const auto found = std::find_if(old.begin(), old.end(), [&](const Old& o) {
          return !o.taken && old_names.name(o.variable->name) == new_names.name(v.name) &&
                 (!same_owner || classes_[o.owner->id] == c);
        });
        if (found == old.end()) continue;
        found->taken = true;
        const auto& had = *found->variable;
        out.moves.push_back({&had, &v, had.type != v.type || (had.array_size < 0) != (v.array_size < 0)});
      }
  for (const auto& o : old)
    if (!o.taken) out.dropped.push_back(o.variable);
  for (const auto& move : out.moves)
    if (move.converts) out.dropped.push_back(move.from);
  return out;
}

void Reload::warn(const ClassInfo& cls, const VariableInfo& variable, const std::string& why) {
  auto text =
      "warning: variable '" + program_->symbols().name(variable.name) + "' of class " + cls.name + " " + why + "\n";
  if (std::find(warnings_.begin(), warnings_.end(), text) == warnings_.end()) warnings_.push_back(std::move(text));
}

// --- the exchange ----------------------------------------------------------------------------------------------------

void Reload::exchange() {
  auto& world = machine_.world_;
  std::pmr::vector<Machine::SiteCache> caches(program_->code().sites.size(), machine_.memory_);
  std::vector<ClassChange> changes;
  for (const auto* cls : classes_)
    changes.push_back(cls ? ClassChange{cls->id, cls->iterate != nullptr, cls->post_iterate != nullptr}
                          : ClassChange{});
  if (machine_.profiler_) machine_.profiler_->use(program_);
  world.reclass(changes);
  // From here on nothing can fail.
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i]->tag == Tag::Object) {
      auto* instance = static_cast<Instance*>(twins_[i]);
      if (world.alive(instance->id) && instance->state != Instance::State::Freed)
        world.set_user(instance->id, reinterpret_cast<std::uint64_t>(instance));
    } else if (cells_[i]->tag == Tag::Pointer) {
      // The open file goes over; the old cell goes with the old heap.
      static_cast<PointerCell*>(twins_[i])->native =
          std::move(const_cast<PointerCell*>(static_cast<const PointerCell*>(cells_[i]))->native);
    }
  }
  machine_.controller_ = static_cast<Instance*>(twin(machine_.controller_));
  machine_.session_ = static_cast<HashCell*>(twin(machine_.session_));
  machine_.result_ = Value();
  machine_.heap_.swap(heap_);
  machine_.strings_.swap(strings_);
  machine_.caches_.swap(caches);
  machine_.handler_methods_.clear();
  machine_.program_ = program_;
  machine_.fragments_.reset();
  machine_.reporter_.forget_locations();
}

}  // namespace breve::steve
