// A tree of bodies under loads, as a system for integrators.
#pragma once

#include <functional>

#include "runtime/articulated/data.hpp"
#include "runtime/articulated/loads.hpp"
#include "runtime/articulated/system.hpp"

namespace breve::articulated {

class TreeSystem final : public System {
 public:
  /// `model` outlives the system.
  explicit TreeSystem(const Model& model, std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  Loads loads;
  /// Called before each evaluation with its time and state, to set loads that depend on them; empty: they are constant.
  std::function<void(double t, const State& state, Loads& loads)> update_loads;

  const Model& model() const { return model_; }
  Data& data() { return data_; }

  int positions() const override { return model_.positions(); }
  int velocities() const override { return model_.velocities(); }
  Kind kind(int velocity) const override { return kinds_[static_cast<std::size_t>(velocity)]; }
  void acceleration(double t, const Vector& q, const Vector& v, double step, Vector& a) override;
  void move(const Vector& q, const Vector& d, Vector& out) override;
  void rate_of_move(const Vector& d, const Vector& v, Vector& out) override;
  void bend_to_cayley(Vector& d) override;

 private:
  const Model& model_;
  Data data_;
  State state_;
  std::vector<Kind> kinds_;
};

}  // namespace breve::articulated
