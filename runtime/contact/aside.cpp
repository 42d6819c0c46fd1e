// Points are copied to and fro: that is cheap beside one linear solve.
#include "runtime/contact/aside.hpp"

#include <utility>

#include "runtime/contact/pack.hpp"

namespace breve::contact {

namespace {

/// By how much a point parts faster than it has to, m/s.
double excess(const Workspace& work, std::size_t point) {
  double u[3];
  velocity(work, point, u);
  return u[0] - work.points[point].bias;
}

}  // namespace

Aside::Aside(Workspace& work) : work_(work) { work.called.assign(work.points.size(), 0); }

bool Aside::take() {
  work_.kept.clear();
  for (std::size_t i = 0; i < work_.points.size(); ++i)
    if (work_.called[i] || work_.points[i].impulse[0] > 0 || excess(work_, i) < 0) work_.kept.push_back(i);
  if (work_.kept.size() == work_.points.size()) return false;
  work_.all_points = work_.points;
  work_.all_sides = work_.sides;
  for (std::size_t k = 0; k < work_.kept.size(); ++k) {
    work_.points[k] = work_.all_points[work_.kept[k]];
    work_.sides[k] = work_.all_sides[work_.kept[k]];
  }
  work_.points.resize(work_.kept.size());
  work_.sides.resize(work_.kept.size());
  work_.has_plain = false;
  return taken_ = true;
}

void Aside::put_back() {
  if (!std::exchange(taken_, false)) return;
  for (std::size_t k = 0; k < work_.kept.size(); ++k) work_.all_points[work_.kept[k]] = work_.points[k];
  work_.points.swap(work_.all_points);
  work_.sides.swap(work_.all_sides);
  work_.has_plain = false;
}

bool Aside::call_back(double tolerance) {
  put_back();
  bool any = false;
  std::size_t next = 0;
  for (std::size_t i = 0; i < work_.points.size(); ++i) {
    if (next < work_.kept.size() && work_.kept[next] == i) {
      ++next;
    } else if (excess(work_, i) < -tolerance) {
      work_.called[i] = any = true;
    }
  }
  return any;
}

}  // namespace breve::contact
