// Force methods: scripts that the integrator asks for forces at its stages (docs/physics.md). A stage may be rejected
// and tried again, so that nothing but the result may come of one: no objects, no output, no random numbers but its
// own.
#include <fmt/format.h>

#include "steve/machine/machine.hpp"

namespace breve::steve {

namespace {

/// Puts back what the force method must not change, however it ends.
class StageScope {
 public:
  StageScope(bool& in_stage, Random& random, std::uint64_t serial, std::uint64_t draw)
      : in_stage_(in_stage), random_(random), kept_(random) {
    in_stage_ = true;
    // The same body draws the same numbers at every stage of one sub-step, whoever else draws.
    Hasher stream;
    stream.add(random.seed());
    stream.add(serial);
    stream.add(draw);
    random_.seed_with(stream.value());
  }
  ~StageScope() {
    in_stage_ = false;
    random_ = kept_;
  }
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

 private:
  bool& in_stage_;
  Random& random_;
  Random kept_;
};

/// The text in the variable of Mobile that set-force-method writes.
StringCell* force_method_of(const Instance& object, const SymbolTable& symbols) {
  for (const ClassInfo* cls = object.cls; cls; cls = cls->parent) {
    if (cls->name != "Mobile") continue;
    for (const VariableInfo& variable : cls->variables)
      if (symbols.name(variable.name) == "forceMethod")
        return static_cast<StringCell*>(object.slots[variable.slot].ref);
  }
  return nullptr;
}

}  // namespace

void Machine::fail_in_stage(std::string_view what) {
  fail(RunErrorKind::World,
       fmt::format("a force method cannot {}: it is called repeatedly within one step and may only "
                   "return a force",
                   what));
}

Vector3 Machine::stage_force(ObjectId agent, double, std::uint64_t draw) {
  Instance* object = instance(agent);
  StringCell* name = object ? force_method_of(*object, program_->symbols()) : nullptr;
  if (!name) return Vector3::Zero();
  const MethodInfo* method = handler_methods_.find(*object->cls, view(name), program_->symbols())[0];
  if (!method)
    fail(RunErrorKind::UnknownMethod, fmt::format("{} has no method '{}' without keywords, which is its force method",
                                                  object->cls->name, view(name)));
  Value force;
  {
    const StageScope stage(in_stage_, world_.random(), object->serial, draw);
    force = invoke(*object, *method, {});
  }
  if (force.tag != Tag::Vector)
    fail(RunErrorKind::Type,
         fmt::format("the force method '{}' of {} must return a vector", view(name), object->cls->name));
  if (!force.vector().allFinite())
    throw Error(ErrorCode::Argument, fmt::format("the force method '{}' of {} returns a force that is not finite",
                                                 view(name), object->cls->name));
  return force.vector();
}

}  // namespace breve::steve
