// Two numbers at once.
#pragma once

#include <cstring>

namespace breve::contact {

using Lanes = double __attribute__((vector_size(16)));

inline Lanes both(double number) { return Lanes{number, number}; }

inline Lanes load(const double* from) {
  Lanes out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

inline void store(double* to, Lanes numbers) { std::memcpy(to, &numbers, sizeof numbers); }

/// y += a x, for n numbers.
inline void add_multiple(double a, const double* x, int n, double* y) {
  int i = 0;
  for (; i + 1 < n; i += 2) store(y + i, load(y + i) + load(x + i) * both(a));
  if (i < n) y[i] += x[i] * a;
}

}  // namespace breve::contact
