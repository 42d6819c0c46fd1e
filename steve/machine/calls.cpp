// Which method a call runs, and how its arguments get into the callee's registers. Settled once for each call site and
// class of receiver; afterwards a call copies slots.
#include <algorithm>
#include <cstring>

#include "steve/machine/machine.hpp"
#include "steve/machine/operators.hpp"

namespace breve::steve {

bool Machine::accepts(const MethodInfo& method, const CallSite& site) {
  for (std::size_t i = 0; i < site.arguments.size(); ++i) {
    const auto keyword = site.arguments[i].keyword;
    const bool known = std::any_of(method.parameters.begin(), method.parameters.end(),
                                   [&](const auto& p) { return p.keyword == keyword; });
    if (!known) return false;
    for (std::size_t j = 0; j < i; ++j)
      if (site.arguments[j].keyword == keyword) return false;
  }
  return std::all_of(method.parameters.begin(), method.parameters.end(), [&](const auto& p) {
    return p.has_default || std::any_of(site.arguments.begin(), site.arguments.end(),
                                        [&](const auto& a) { return a.keyword == p.keyword; });
  });
}

const MethodInfo* Machine::choose(const CallSite& site, const ClassInfo& cls) const {
  // The method with the fewest parameters comes first, among equals the most derived. If the keywords do not fit, the
  // next one is tried.
  std::vector<const MethodInfo*> candidates;
  const ClassInfo* start = site.super_of ? site.super_of->parent : &cls;
  for (const ClassInfo* c = start; c; c = c->parent)
    for (const auto& method : c->methods)
      if (method->name == site.selector && method->parameters.size() >= site.arguments.size())
        candidates.push_back(method.get());
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto* a, const auto* b) { return a->parameters.size() < b->parameters.size(); });
  for (const auto* candidate : candidates)
    if (accepts(*candidate, site)) return candidate;
  const auto& name = program_->symbols().name(site.selector);
  if (candidates.empty() && name == "iterate") return nullptr;
  fail_call(site, cls, candidates.empty() ? nullptr : candidates.front());
}

const Machine::Plan& Machine::find_plan(std::uint32_t number, const ClassInfo& cls) {
  auto& cache = caches_[number];
  for (const Plan* plan = cache.plans.get(); plan; plan = plan->next.get()) {
    if (plan->cls != &cls) continue;
    cache.cls = &cls;
    cache.plan = plan;
    return *plan;
  }
  return make_plan(number, cls);
}

const Machine::Plan& Machine::make_plan(std::uint32_t number, const ClassInfo& cls) {
  const auto& site = program_->code().sites[number];
  auto plan = make_in<Plan>(memory_, memory_);
  plan->cls = &cls;
  plan->method = choose(site, cls);
  if (plan->method) {
    for (const auto& p : plan->method->parameters) {
      const auto at = std::find_if(site.arguments.begin(), site.arguments.end(),
                                   [&](const auto& a) { return a.keyword == p.keyword; });
      const auto to = static_cast<std::uint16_t>(p.slot);
      const bool checked = p.class_name != kNoSymbol;
      if (at == site.arguments.end()) {
        plan->steps.push_back({PlanStep::Kind::Default, p.type, 0, to, checked, &p});
        continue;
      }
      plan->order.push_back(static_cast<std::uint16_t>(at - site.arguments.begin()));
      auto kind = PlanStep::Kind::Convert;
      if (p.type == StaticType::Any) {
        // The tag comes from the type of the argument.
      } else if (at->type == p.type) {
        const int n = slot_count(p.type);
        kind = n == 1 ? PlanStep::Kind::Copy1 : n == 3 ? PlanStep::Kind::Copy3 : PlanStep::Kind::Copy9;
      } else if (at->type == StaticType::Int && p.type == StaticType::Double) {
        kind = PlanStep::Kind::IntToDouble;
      } else if (at->type == StaticType::Double && p.type == StaticType::Int) {
        kind = PlanStep::Kind::DoubleToInt;
      }
      if ((kind == PlanStep::Kind::Copy1 || kind == PlanStep::Kind::IntToDouble) && !checked)
        plan->moves.push_back({at->slot, to, kind == PlanStep::Kind::IntToDouble});
      else
        plan->steps.push_back({kind, at->type, at->slot, to, checked, &p});
    }
  }
  auto& cache = caches_[number];
  cache.cls = &cls;
  cache.plan = plan.get();
  plan->next = std::move(cache.plans);
  cache.plans = std::move(plan);
  return *cache.plan;
}

void Machine::apply_steps(const Plan& plan, const Slot* caller, Slot* callee) {
  const std::size_t pinned = pins_.size();
  for (const auto& step : plan.steps) {
    const Slot* from = caller + step.from;
    Slot* to = callee + step.to;
    switch (step.kind) {
      case PlanStep::Kind::Copy1: to->bits = from->bits; break;
      case PlanStep::Kind::Copy3: std::memcpy(static_cast<void*>(to), from, 3 * sizeof(Slot)); break;
      case PlanStep::Kind::Copy9: std::memcpy(static_cast<void*>(to), from, 9 * sizeof(Slot)); break;
      case PlanStep::Kind::IntToDouble: to->d = from->i; break;
      case PlanStep::Kind::DoubleToInt: to->i = truncate_to_int(from->d); break;
      case PlanStep::Kind::Convert: convert_argument(step, from, to); break;
      case PlanStep::Kind::Default: write_default(to, *step.parameter); break;
    }
    if (step.checked) [[unlikely]] {
      const auto& p = *step.parameter;
      if (const auto* cls = program_->find_class(program_->symbols().name(p.class_name)))
        check_class(static_cast<Instance*>(to->ref), *cls, "keyword '" + program_->symbols().name(p.keyword) + "'");
    }
  }
  if (!plan.method->native && pins_.size() != pinned) pins_.resize(pinned);  // the frame holds them now
}

void Machine::convert_argument(const PlanStep& step, const Slot* from, Slot* to) {
  Value value;
  switch (step.from_type) {
    case StaticType::Any:
    case StaticType::Null: std::memcpy(static_cast<void*>(&value), from, sizeof value); break;
    case StaticType::Int: value = Value::of(from->i); break;
    case StaticType::Double: value = Value::of(from->d); break;
    case StaticType::Vector: value = Value::of(Vector3(from[0].d, from[1].d, from[2].d)); break;
    case StaticType::Matrix: value = Value::of(Tag::Matrix, heap_->matrix(SlotType<Matrix3>::from(from))); break;
    default: value = Value::of(static_cast<Tag>(step.from_type), from->ref); break;
  }
  const auto& p = *step.parameter;
  switch (p.type) {  // what is right already, without building a text for an error that does not come
    case StaticType::Double:
      if (value.tag == Tag::Double) {
        to->d = value.d;
        return;
      }
      break;
    case StaticType::Int:
      if (value.tag == Tag::Int) {
        to->i = value.i;
        return;
      }
      break;
    case StaticType::Vector:
      if (value.tag == Tag::Vector) {
        std::memcpy(static_cast<void*>(to), value.v, sizeof value.v);
        return;
      }
      break;
    case StaticType::Any: std::memcpy(static_cast<void*>(to), &value, sizeof value); return;
    case StaticType::Null:
    case StaticType::Matrix: break;
    default:
      if (static_cast<int>(value.tag) == static_cast<int>(p.type)) {
        to->ref = value.ref;
        return;
      }
      break;
  }
  const auto what = "keyword '" + program_->symbols().name(p.keyword) + "'";
  if (value.tag == Tag::Null && p.type != StaticType::Any) {
    value = null_default(p.type, 0, running());
    if (value.tag == Tag::Null) {
      to->ref = nullptr;
      return;
    }
  }
  write_value(to, p.type, value, what);
  if (p.type == StaticType::String) pins_.push_back(Value::of(Tag::String, to->ref));
}

void Machine::call_native(const Plan& plan, Instance& receiver, const Slot* caller) {
  // Every frame keeps kNativeRoom slots free above it. After an error the frames are unwound, and the top with them.
  Slot* args = top_;
  const std::size_t pinned = pins_.size();
  apply(plan, caller, args);
  top_ = args + kNativeRoom;
  poll();
  plan.method->native(*this, receiver, args, result_);
  top_ = args;
  if (pins_.size() != pinned) pins_.resize(pinned);
}

void Machine::check_class(Instance* object, const ClassInfo& cls, std::string_view what) {
  if (!object || object->cls->derives_from(cls)) return;
  throw RunError(RunErrorKind::Type, std::string(what) + " takes an object of class " + cls.name +
                                         ", not one of class " + object->cls->name);
}

}  // namespace breve::steve
