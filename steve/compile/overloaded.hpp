// One function object out of several lambdas, for std::visit.
#pragma once

namespace breve::steve {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

}  // namespace breve::steve
