// Classes of the host: what the machine calls, and how the host's code is found.
#pragma once

#include "functions.hpp"
#include "internal.hpp"
#include "steve/code/foreign.hpp"

namespace breve::host {

class HostMethod final : public steve::ForeignMethod {
 public:
  /// @param place  where it is declared; null: that is not known
  HostMethod(const HostClass& cls, const std::string& class_name, const breve_method& m, std::string signature,
             const breve_place* place)
      : ForeignMethod(class_name, m.name, std::move(signature), m.doc ? m.doc : "", m.adopts_keywords,
                      place && place->file ? place->file : "", place ? place->line : 0),
        cls_(cls),
        call_(m.call),
        user_(m.user) {}
  const HostClass& cls() const { return cls_; }
  breve_status call(const breve_call& call, breve_value& result) const { return call_(user_, &call, &result); }

 private:
  const HostClass& cls_;
  const breve_function_fn call_;
  void* const user_;
};

class HostClass final : public steve::ForeignClass {
 public:
  /// @throws  StatusError{BREVE_ERROR_ARGUMENT}
  explicit HostClass(const breve_class& c);
  ~HostClass() override {
    if (destroy_) destroy_(user_);
  }
  /// From now on the class answers for the host's data.
  void own(void (*destroy)(void* user)) { destroy_ = destroy; }
  /// The code of the class is in this library.
  void keep(std::shared_ptr<const PluginLibrary> library) { library_ = std::move(library); }
  bool same_name(const ForeignClass& other) const { return name() == other.name(); }
  breve_status bind(breve_world& world, void*& binding, Answer& reason) const {
    return bind_ ? bind_(user_, &world, &binding, &Answer::add, &reason) : BREVE_OK;
  }
  void unbind(void* binding) const {
    if (unbind_) unbind_(binding);
  }
  std::vector<steve::ForeignPlace> places(const breve_call& call) const;

 private:
  void describe(const breve_class& c);

  const breve_bind_fn bind_;
  void (*const unbind_)(void* binding);
  const breve_places_fn places_;
  void* const user_;
  void (*destroy_)(void* user) = nullptr;
  std::shared_ptr<const PluginLibrary> library_;
};

/// A method of a class of the host runs while this stands.
class ActiveScope {
 public:
  ActiveScope(breve_world& world, const HostMethod& method, breve_call& call)
      : world_(world), call_{world.active, &method.cls(), &call, world.machine->depth()} {
    for (const auto& binding : world.bindings)
      if (binding->cls.get() == &method.cls()) {
        call.binding = binding->data;
        break;
      }
    world.active = &call_;
    world.failed_depth = 0;
  }
  ~ActiveScope() { world_.active = call_.outer; }
  ActiveScope(const ActiveScope&) = delete;
  ActiveScope& operator=(const ActiveScope&) = delete;
  /// Keep where it stands: the error's chain of calls is made when the call is over.
  void failed() const {
    world_.failed_places = call_.cls->places(*call_.call);
    world_.failed_depth = call_.depth;
  }

 private:
  breve_world& world_;
  const ActiveCall call_;
};

}  // namespace breve::host
