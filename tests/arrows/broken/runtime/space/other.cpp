// The other one, with what nobody calls and with what nobody reads to its end.
#include "runtime/space/headings.hpp"

namespace {

int helper(double x) { return x > 0; }

}  // namespace

void Headings::stands_elsewhere() {
  stands_here();
  stands_elsewhere();
  helper(2.0);
}

void called_by_nobody() { stands_elsewhere(); }

int much_too_long(int x) {
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  x = much_too_long(helper(x));
  return x;
}
