// Points without an impulse, left out of a direct solution: most points near the floor carry nothing.
#pragma once

#include "runtime/contact/workspace.hpp"

namespace breve::contact {

/// While points are set aside, `work` holds only the others, in their order. The island is not condensed.
class Aside {
 public:
  explicit Aside(Workspace& work);
  ~Aside() { put_back(); }
  Aside(const Aside&) = delete;
  Aside& operator=(const Aside&) = delete;

  /// Sets aside what has no impulse, does not approach, and was not called back before.
  /// @return  whether there is anything
  bool take();
  /// All points are back; those that violate their law by more than the tolerance, m/s, are not set aside again.
  /// @return  whether there are such
  bool call_back(double tolerance);

 private:
  void put_back();

  Workspace& work_;
  bool taken_ = false;
};

}  // namespace breve::contact
