// Forces of contacts, limits and motors that go on. Contacts and limits that held something in the last two sub-steps,
// and the motors of closed loops, act on trees inside the stages of smooth motion, as joint forces that do not change
// on the way: a limb that is pressed on its limit would otherwise leave it and come back in each sub-step. The solver,
// after it, corrects the prediction.
#pragma once

#include "runtime/dynamics/island_books.hpp"

namespace breve::island {

class Prediction {
 public:
  Prediction(State& state, Contacts& contacts, Rows& rows, Books& books)
      : state_(state), contacts_(contacts), rows_(rows), books_(books) {}

  /// After a look at what is near and Books::open(), for the smooth motion of h seconds that follows.
  void make(double h);
  bool misled(double h);
  bool threw() const;
  bool limits_swing(double h) const;
  bool loops_swing(double h) const;
  void learn(double h, bool loops);
  void forget();
  void forget_contacts();
  bool strained() const;

 private:
  bool overpressed(double h) const;
  bool rotated_away(double h) const;
  bool rotates(BodyIndex body, double rate) const;
  void clear();
  void add_contact(const Touch& touch);
  void add_joints();
  void add_limit(const Bound& bound, double force);
  void add_loop(const contact::ScalarRow& row, double h);
  void add_motors();
  void add_motors(Tree& tree);

  State& state_;
  Contacts& contacts_;
  Rows& rows_;
  Books& books_;
};

}  // namespace breve::island
