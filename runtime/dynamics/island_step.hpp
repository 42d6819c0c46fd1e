// The step of an island: sub-steps of smooth motion, impacts at their moments, contacts that last.
#pragma once

#include "runtime/dynamics/island_impacts.hpp"

namespace breve::island {

class Step {
 public:
  Step(State& state, Contacts& contacts, SmoothMotion& smooth, Rows& rows, SubStep& sub_step, Impacts& impacts,
       Handlers& handlers, Balance& balance)
      : state_(state),
        contacts_(contacts),
        smooth_(smooth),
        rows_(rows),
        sub_step_(sub_step),
        impacts_(impacts),
        handlers_(handlers),
        balance_(balance) {}

  /// Moves the island from `start` by h seconds with the accuracy that it has.
  void once(MechanicsClient* client, double start, double h);

 private:
  bool bounded() const;
  void undisturbed(double start, double h);
  void fast(double start, double h);
  void take_fast(double time, double h);
  void take_parts(double time, double h, int parts);
  void take_looked(double time, double h);
  bool meets(const NetworkCluster& network) const;
  int spring_parts(double h) const;
  int rotation_parts(double h) const;
  void located(MechanicsClient* client, double start, double h);
  bool look(double time, double sub);
  Trouble fastest_motion() const;
  Trouble used_up() const;
  void finish(const Trouble& why, double time, double left);
  double longest(double left, bool lies) const;
  double rotation_seen(BodyIndex body) const;
  double followed(double part) const;
  double contact_part(double left, bool lies) const;
  bool lies(double h) const;
  int located_impacts() const;
  std::uint64_t located_work() const;
  void report_impacts(double time);

  State& state_;
  Contacts& contacts_;
  SmoothMotion& smooth_;
  Rows& rows_;
  SubStep& sub_step_;
  Impacts& impacts_;
  Handlers& handlers_;
  Balance& balance_;
  double gone_ = 0;     // s, of the step, that are over
  int met_ = 0;         // impacts located so far in this step
  bool spent_ = false;  // none is located any more
};

}  // namespace breve::island
