// One program running in one world: creation and freeing of objects, calls from outside, events of the world.
#include "steve/machine/machine.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/world/menu.hpp"
#include "steve/code/wording.hpp"
#include "steve/compile/evaluate.hpp"
#include "steve/machine/operators.hpp"
#include "steve/machine/profiler.hpp"
#include "steve/machine/reload.hpp"

namespace breve::steve {

Machine::Machine(std::shared_ptr<const Program> program, World& world, std::pmr::memory_resource* memory,
                 MachineHost host)
    : program_(std::move(program)),
      world_(world),
      host_(std::move(host)),
      memory_(memory),
      heap_(make_in<Heap>(memory, memory, *this)),
      segments_(memory),
      pins_(memory),
      caches_(memory),
      handler_methods_(memory),
      strings_(memory),
      functions_(steve::functions()),
      reporter_(host_, memory) {
  budget_heap(*heap_);
  caches_.resize(program_->code().sites.size());
  strings_ = make_constants(*heap_, *program_);
  next_segment(kNativeRoom);
  world_.set_behaviour(this);
  world_.bound_physics({host_.physics_budget, &interrupted_});
}

Machine::~Machine() {
  world_.set_behaviour(nullptr);
  world_.bound_physics({});
  for (const auto& [slots, size] : segments_) memory_->deallocate(slots, size * sizeof(Slot), alignof(Slot));
}

std::pmr::vector<StringCell*> Machine::make_constants(Heap& heap, const Program& program) {
  std::pmr::vector<StringCell*> constants(heap.memory());
  constants.reserve(program.code().strings.size());
  for (const auto& text : program.code().strings) {
    auto* cell = heap.string(text);
    if (cell) {
      heap.retain(cell);  // it is not garbage, now or ever
      cell->immortal = true;
    }
    constants.push_back(cell);
  }
  return constants;
}

std::vector<std::string> Machine::reload(std::shared_ptr<const Program> program) {
  if (nesting_ != 0 || frame_) throw Error(ErrorCode::Busy, "a program cannot be replaced while it runs");
  return Reload(*this, std::move(program)).run();
}

void Machine::start() {
  const auto* cls = program_->controller_class();
  if (!cls) throw Error(ErrorCode::Argument, "the program has no controller");
  create(*cls);  // it is the controller from its init on, and none if that freed it
}

void Machine::begin_run() {
  interrupted_.store(false, std::memory_order_relaxed);
  budget_.begin_run(host_.budget);
  world_.begin_call();
  heap_->take_moved();
  reporter_.begin_run();
  if (host_.patience > 0) run_began_ = std::chrono::steady_clock::now();
}

void Machine::end_of_piece() {
  settle();
  if (host_.patience > 0) look_at_the_clock();  // the host may call back: there is a next piece by now
}

void Machine::settle() {
  constexpr std::uint64_t kBytesPerIteration = 128;
  charge(heap_->take_moved() / kBytesPerIteration);
}

// Says once where a run is that takes so long that it may never end.
void Machine::look_at_the_clock() {
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - run_began_;
  if (taken.count() < host_.patience) return;
  host_.patience = 0;
  warn(fmt::format("this has been running for {:.0f} s: a loop here may not terminate", taken.count()));
}

void Machine::charge(std::uint64_t iterations) {
  poll();
  if (!budget_.charge(iterations)) fail_budget();
}

void Machine::expect(std::uint64_t iterations) {
  poll();
  if (iterations != 0 && !budget_.affords(iterations)) charge(iterations);
}

void Machine::fail_interrupted() {
  budget_.hold();
  throw RunError(RunErrorKind::Interrupted, "interrupted");
}

void Machine::fail_budget() const {
  throw RunError(
      RunErrorKind::Budget,
      "the call used up its budget of loop iterations and calls: " +
          (budget_.run_is_used_up() ? std::to_string(host_.budget) + " for an iteration or a call by the host"
                                    : std::to_string(host_.call_budget) + " for one call within an iteration"),
      "a loop here may not terminate, or the budget set by the host is too small for this program");
}

template <class Body>
void Machine::called_by_world(Body&& body) {
  if (host_.call_budget == 0) return body();
  const std::size_t depth = depth_;
  const Instruction* pc = running();
  try {
    const Budget::Call limited(budget_, host_.call_budget);
    try {
      body();
    } catch (...) {
      rethrow(depth, pc);
    }
  } catch (const ScriptError& error) {
    if (error.code() != ErrorCode::Budget || budget_.run_is_used_up()) throw;
    survive(error);
  }
}

// --- objects ---------------------------------------------------------------------------------------------------------

Instance* Machine::create(const ClassInfo& cls) {
  refuse_in_stage("create an object");
  const ProfileScope profiled(profiler_, Callee::act("new", &cls), profiler_ ? running_line() : 0);
  count_call();
  auto* instance = heap_->instance(cls);
  heap_->retain(instance);  // by the table of objects, until it is freed or opts for auto-free
  try {
    instance->id = world_.create(cls.id, reinterpret_cast<std::uint64_t>(instance), cls.iterate != nullptr,
                                 cls.post_iterate != nullptr);
    if (!controller_ && program_->controller_class() == &cls) {
      controller_ = instance;
      apply_settings(*instance);
    }
    for (std::size_t i = 0; i < cls.init_chain.size(); ++i) {
      invoke(*instance, *cls.init_chain[i], {});
      if (!instance->live() && i + 1 < cls.init_chain.size())
        throw RunError(RunErrorKind::FreedObject, "the new object of class " + cls.name + " was freed in its init");
    }
  } catch (...) {
    if (controller_ == instance) controller_ = nullptr;
    if (instance->live()) {
      end_native(*instance);
      forget(*instance);
    }
    throw;
  }
  return instance;
}

void Machine::free_instance(Instance& instance) {
  if (instance.state != Instance::State::Live) return;
  refuse_in_stage("free an object");
  const ProfileScope profiled(profiler_, Callee::act("free", instance.cls), profiler_ ? running_line() : 0);
  instance.state = Instance::State::BeingFreed;
  const Pin pin(*this, Value::of(Tag::Object, &instance));
  Value ignored;
  try {
    if (instance.cls->destroy) call_guarded(instance, *instance.cls->destroy, {}, ignored);
    for (const auto* method : instance.cls->delete_chain) call_guarded(instance, *method, {}, ignored);
  } catch (...) {
    end_native(instance);
    forget(instance);  // cut short by the budget or by the end of memory: it is gone all the same
    throw;
  }
  forget(instance);
}

void Machine::discard_instance(Instance& instance) {
  if (instance.state != Instance::State::Live) return;
  const Pin pin(*this, Value::of(Tag::Object, &instance));
  instance.state = Instance::State::BeingFreed;
  end_native(instance);
  forget(instance);
}

/// An object that goes without its `delete` methods: those that are native take no arguments and run no script, and
/// undo what native code keeps of it elsewhere (a cell that it stands on).
void Machine::end_native(Instance& instance) noexcept {
  for (const auto* method : instance.cls->delete_chain) {
    if (!method->native) continue;
    try {
      Value ignored;
      method->native(*this, instance, nullptr, ignored);
    } catch (...) {  // it had nothing to undo
    }
  }
}

void Machine::forget(Instance& instance) {
  if (host_.gone) host_.gone(instance.id);
  instance.state = Instance::State::Freed;
  if (world_.alive(instance.id)) world_.release(instance.id);
  if (controller_ == &instance) {
    controller_ = nullptr;
    world_.request_end();
  }
  heap_->clear_slots(instance);
  if (!instance.auto_free) heap_->release(&instance);
  instance.auto_free = false;
}

void Machine::free_unreachable(Instance& instance) {
  called_by_world([&] { free_instance(instance); });
}

Instance* Machine::instance(ObjectId id) const {
  return world_.alive(id) ? reinterpret_cast<Instance*>(world_.user(id)) : nullptr;
}

// --- calls from native code ------------------------------------------------------------------------------------------

const MethodInfo* Machine::find_method(const ClassInfo& cls, std::string_view name, std::size_t count) const {
  const auto symbol = program_->symbols().find(name);
  return symbol == kNoSymbol ? nullptr : cls.find_method(symbol, count);
}

bool Machine::responds(const ClassInfo& cls, std::string_view name) const {
  const auto symbol = program_->symbols().find(name);
  return symbol != kNoSymbol && cls.responds(symbol);
}

Value Machine::call(Instance& receiver, const MethodInfo& method, std::span<const Value> arguments) {
  if (!receiver.live())
    throw RunError(RunErrorKind::FreedObject, "a method is called on a freed object of class " + receiver.cls->name);
  if (arguments.size() != method.parameters.size())
    throw RunError(RunErrorKind::Type, "method '" + program_->symbols().name(method.name) + "' takes " +
                                           std::to_string(method.parameters.size()) + " arguments");
  return invoke(receiver, method, arguments);
}

Value Machine::call(Instance& receiver, std::string_view name, std::span<const Value> arguments) {
  const auto* method = find_method(*receiver.cls, name, arguments.size());
  if (!method)
    throw RunError(RunErrorKind::UnknownMethod,
                   "class " + receiver.cls->name + " has no method '" + std::string(name) + "' with " +
                       std::to_string(arguments.size()) + (arguments.size() == 1 ? " parameter" : " parameters"),
                   unknown_method_help(name, receiver.cls, *program_));
  return call(receiver, *method, arguments);
}

bool Machine::call_guarded(Instance& receiver, const MethodInfo& method, std::span<const Value> arguments,
                           Value& result) {
  const std::size_t depth = depth_;
  const Instruction* pc = running();
  try {
    try {
      result = call(receiver, method, arguments);
      return true;
    } catch (...) {
      rethrow(depth, pc);
    }
  } catch (const ScriptError& error) {
    if (error.code() != ErrorCode::Script && error.code() != ErrorCode::Depth) throw;
    survive(error);
    result = Value();
    return false;
  }
}

Value Machine::call_with_keywords(Instance& receiver, std::string_view name,
                                  std::span<const std::pair<std::string_view, Value>> keywords,
                                  const ClassInfo* super_of) {
  CallSite site;
  site.super_of = super_of;
  site.selector = program_->symbols().find(name);
  if (site.selector == kNoSymbol)
    throw RunError(RunErrorKind::UnknownMethod,
                   "unknown method: class " + receiver.cls->name + " has no method '" + std::string(name) + "'");
  for (const auto& [keyword, value] : keywords) {
    const auto symbol = program_->symbols().find(keyword);
    if (symbol == kNoSymbol)
      throw RunError(RunErrorKind::UnknownKeyword,
                     "unknown keyword '" + std::string(keyword) + "' for method '" + std::string(name) + "'");
    site.arguments.push_back({symbol, StaticType::Any, 0, -1, {}});
  }
  const auto* method = choose(site, *receiver.cls);
  if (!method) return {};
  std::vector<Value> values;
  for (const auto& p : method->parameters) {
    const auto at = std::find_if(site.arguments.begin(), site.arguments.end(),
                                 [&](const auto& a) { return a.keyword == p.keyword; });
    values.push_back(at != site.arguments.end() ? keywords[static_cast<std::size_t>(at - site.arguments.begin())].second
                                                : default_value(p));
  }
  return call(receiver, *method, values);
}

Value Machine::default_value(const ParameterInfo& p) {
  Slot slots[9] = {};
  write_default(slots, p);
  switch (p.type) {
    case StaticType::Int: return Value::of(slots[0].i);
    case StaticType::Double: return Value::of(slots[0].d);
    case StaticType::Vector: return Value::of(SlotType<Vector3>::from(slots));
    case StaticType::Matrix: return Value::of(Tag::Matrix, heap_->matrix(SlotType<Matrix3>::from(slots)));
    default: return Value::of(static_cast<Tag>(p.type), slots[0].ref);
  }
}

// --- events of the world ---------------------------------------------------------------------------------------------

void Machine::iterate(ObjectId agent) {
  if (auto* object = instance(agent)) called_by_world([&] { call(*object, *object->cls->iterate, {}); });
}

void Machine::post_iterate(ObjectId agent) {
  if (auto* object = instance(agent)) called_by_world([&] { call(*object, *object->cls->post_iterate, {}); });
}

void Machine::scheduled(ObjectId agent, std::string_view method) {
  if (auto* object = instance(agent)) called_by_world([&] { call(*object, method, {}); });
}

bool Machine::collided(ObjectId agent, ObjectId other, std::string_view name, const Vector3& point,
                       const Vector3& normal) {
  for (std::size_t count = 0; count <= 5; ++count) {
    auto* object = instance(agent);
    auto* hit = instance(other);
    if (!object || !hit) return true;
    // Looked up anew each time: the method before may have replaced classes.
    const auto* method = handler_methods_.find(*object->cls, name, program_->symbols())[count];
    if (!method) continue;
    const Value arguments[] = {Value::of(Tag::Object, hit), Value::of(point), Value::of(normal), Value(), Value()};
    Value result;
    called_by_world([&] { call_guarded(*object, *method, std::span(arguments, count), result); });
    if (result.tag == Tag::Int && result.i != 0) return true;
  }
  return false;
}

bool Machine::may_collide(ObjectId agent, ObjectId other) {
  auto* object = instance(agent);
  auto* near = instance(other);
  if (!object || !near) return true;
  const auto* method = handler_methods_.find(*object->cls, "may-collide", program_->symbols())[1];
  if (!method) return true;
  const Value argument = Value::of(Tag::Object, near);
  Value result;
  called_by_world([&] { call_guarded(*object, *method, std::span(&argument, 1), result); });
  // A method that failed, or that says nothing, refuses nothing.
  return result.tag == Tag::Null || truth(result);
}

void Machine::notified(ObjectId observer, std::string_view name, ObjectId announcer, std::string_view message) {
  auto* object = instance(observer);
  auto* source = instance(announcer);
  if (!object) return;
  for (const std::size_t count : {2, 1, 0}) {
    const auto* method = handler_methods_.find(*object->cls, name, program_->symbols())[count];
    if (!method) continue;
    const Value text = Value::of(Tag::String, heap_->string(message));
    const Pin pin(*this, text);
    const Value arguments[] = {Value::of(Tag::Object, source), text};
    Value result;
    call_guarded(*object, *method, std::span(arguments, count), result);
    return;
  }
}

void Machine::call_if_present(Instance& receiver, std::string_view method, std::span<const Value> arguments) {
  Value result;
  if (const auto* info = find_method(*receiver.cls, method, arguments.size()))
    called_by_world([&] { call_guarded(receiver, *info, arguments, result); });
}

void Machine::input(const InputEvent& event) {
  if (!controller_) return;
  switch (event.kind) {
    case InputEvent::Kind::KeyDown:
    case InputEvent::Kind::KeyUp: input_key(event); break;
    case InputEvent::Kind::Click: {
      const Value arguments[] = {Value::of(Tag::Object, instance(event.object))};
      call_if_present(*controller_, "click", arguments);
      break;
    }
    case InputEvent::Kind::Menu: choose_menu(event.object); break;
  }
}

void Machine::input_key(const InputEvent& event) {
  const std::string ending = event.kind == InputEvent::Kind::KeyDown ? "-down" : "-up";
  const auto plain = "catch-key-" + event.key + ending;
  if (find_method(*controller_->cls, plain, 0)) {
    call_if_present(*controller_, plain);
    return;
  }
  if (event.key.size() != 1) return;
  static constexpr char kDigits[] = "0123456789ABCDEF";
  const auto code = static_cast<unsigned char>(event.key[0]);
  std::string hex;
  if (code >= 16) hex += kDigits[code >> 4];
  hex += kDigits[code & 15];
  call_if_present(*controller_, "catch-key-0x" + hex + ending);
}

void Machine::choose_menu(ObjectId id) {
  const auto* item = menu_item(world_, id);
  if (!item || !item->can_be_chosen()) return;
  const auto method = item->method;
  if (auto* owner = instance(item->owner)) call_if_present(*owner, method);
}

void Machine::end_of_iteration() {
  result_ = Value();
  const StageScope stage("garbage", profiler_);
  heap_->end_of_iteration();
}

}  // namespace breve::steve
