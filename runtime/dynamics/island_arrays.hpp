// From an island to the world's arrays, and into the books that tell what scripts change there later.
#pragma once

#include "runtime/dynamics/island_state.hpp"

namespace breve::island {

class Arrays {
 public:
  explicit Arrays(State& state) : state_(state) {}
  void write();

 private:
  void write_networks();
  void book();
  void book_networks();

  State& state_;
};

}  // namespace breve::island
