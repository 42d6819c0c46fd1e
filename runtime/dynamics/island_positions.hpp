// Positions that are put right by hand: overlap is pushed apart, joints are held at their limits. Nothing gets
// velocity.
#pragma once

#include "runtime/dynamics/island_balance.hpp"
#include "runtime/dynamics/island_momentum.hpp"

namespace breve::island {

/// Of joints where positions are moved: they stay, or links keep their momenta where rates would gain by that.
enum class Rates { Stay, Carried };

class Positions {
 public:
  Positions(State& state, Contacts& contacts, Rows& rows, Momentum& momentum, Credit& credit);

  void push_apart(double h);
  bool hold_off(double h);
  bool went_on();
  bool sank();
  void raise(double h, double most);
  void put_back(double h, bool struck);

  // The rows' solution is taken as a velocity that lasts h seconds and then is gone. Between these two the movers have
  // none.
  void begin_moves();
  void end_moves(double h, Rates rates = Rates::Stay);
  /// Takes h seconds of the last motion back from the trees.
  void move_back(double h);
  /// The energy, J, that a motion may give because the motion of trees pays for it.
  double payable_by_motion() const;
  /// What moving positions gave, J, is taken from what moves, as far as that is little of it.
  /// @param by_contacts  it was booked as given by contacts, and so is what is taken
  void pay_for_moves(double given, bool by_contacts, Payers payers);

 private:
  double put_back_once(double h, bool struck, Rates rates);
  void move_by_pushes(double fastest, double h, Rates rates);
  Given payable(double h);
  Given given() const;
  void shorten_winding(double wound, double h);
  void shorten_pushes(const Given& before, const Given& most, double h);
  void see_whether_apart();
  void take_back_pushes(double part, double h);
  bool on_spring(int mover) const;
  bool find_struck(double h);
  double deeper(const Touch& touch) const;
  bool yields(const Clustered& one) const;
  void book_moves(double sign);
  void book_pushed();
  void book_way(double work, Tree* tree);
  double softness(const NearPair& pair) const;

  State& state_;
  Contacts& contacts_;
  Rows& rows_;
  Momentum& momentum_;
  Credit& credit_;
  std::pmr::vector<contact::Push> pushes_;  // of contact rows
  std::pmr::vector<double> scalar_pushes_;  // of scalar rows: the velocity that puts them right, m/s or rad/s
  std::pmr::vector<std::uint8_t> struck_;   // of movers: contacts changed its velocity
  std::pmr::vector<double> shares_;         // likewise, of free bodies: of the way that this moves one
};

}  // namespace breve::island
