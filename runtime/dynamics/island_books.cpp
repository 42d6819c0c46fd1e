// The books of a sub-step whose rows are solved at its end. They take forces as constant: works by the mean of
// velocities are of second order only. What rows did in fact is known all the same, since smooth motion is measured by
// itself: it is what the energy changed by after that. Contacts and limits give nothing: what the solution gave is
// taken back from the motion of links among one another.
#include <algorithm>

#include "runtime/dynamics/island.hpp"

namespace breve {

namespace {

double works_of(const Energy& ledger) { return ledger.motor_work + ledger.script_work; }

/// Of contacts and limits, J.
double rows_took(const Energy& ledger) { return ledger.contact_loss + ledger.friction_loss + ledger.limit_loss; }

/// Of `change`, what works and losses since `start` do not explain, J.
double missing(double change, const Energy& start, const Energy& now) {
  return change - works_of(now) + works_of(start) + rows_took(now) + now.drag_loss - rows_took(start) - start.drag_loss;
}

/// Contacts and limits give nothing. Where motors press against them the mean of velocities may say that they did and
/// that the motors took it, to and fro within the sub-step: then neither did. Likewise what they gave, and smooth
/// motion lost by its error, are one.
/// @param lost  J, by the error of smooth motion
void settle_rows(const Energy& start, double lost, Energy& now) {
  const double gave = rows_took(start) - rows_took(now);
  if (!(gave > 0)) return;
  const double by_motors = std::clamp(start.motor_work - now.motor_work, 0.0, gave);
  now.motor_work += by_motors;
  now.contact_loss += by_motors + std::clamp(lost, 0.0, gave - by_motors);
}

}  // namespace

/// Kinetic, potential and in springs, J.
double Island::stored_now() {
  double sum = 0, kinetic = 0;
  for (const Free& one : loose_bodies())
    sum += one.now.kinetic() - one.now.solid->mass * core_.settings.gravity.dot(one.now.center);
  sum += network_energy();
  for (const Clustered& one : clusters_) sum += stored_in(one, kinetic);
  return sum;
}

/// At the start of a sub-step, once it is known which touches and limits will be rows.
void Island::open_books() {
  keeps_books_ = !trees_.empty() && has_rows() && !springs_move();
  if (!keeps_books_) return;
  double moving = 0;
  for (Clustered& one : clusters_) {
    double kinetic = 0;
    one.books = {stored_in(one, kinetic), 0, 0, 0, core_.trees[one.entry->trees.front()]->ledger, 0};
    moving += kinetic;
  }
  books_ = {stored_now(), moving, 0, 0, result.ledger, 0};
}

/// After smooth motion: what it gained that nothing explains is its error, not the rows'.
void Island::note_smooth() {
  if (!keeps_books_) return;
  books_.smooth_kinetic = 0;
  for (Clustered& one : clusters_) {
    const Energy& did = one.pending;
    double kinetic = 0;
    one.books.unexplained =
        stored_in(one, kinetic) - one.books.stored - did.motor_work - did.script_work - one.held_work + did.drag_loss;
    books_.smooth_kinetic += kinetic;
  }
  placed_ = true;
}

/// After commit() and book_rows().
void Island::close_books() {
  if (!keeps_books_ || (rows_.empty() && scalars_.empty())) return;
  const bool only_motors = rows_.empty() && limit_rows() == 0;
  const auto close = [only_motors](const Books& books, double stored, Energy& ledger) {
    const double more = missing(stored - books.stored - books.unexplained, books.ledger, ledger);
    if (only_motors)
      ledger.motor_work += more;
    else
      ledger.contact_loss -= more;
    settle_rows(books.ledger, -books.unexplained, ledger);
  };
  double kinetic = 0;
  for (Clustered& one : clusters_) {
    // An implicit step and its rows are one: what it lost on the way to them is not the motion's error.
    if (one.semi && !only_motors) one.books.unexplained = std::max(0.0, one.books.unexplained);
    books_.unexplained += one.books.unexplained;
    if (one.alone()) close(one.books, stored_in(one, kinetic), core_.trees[one.entry->trees.front()]->ledger);
  }
  close(books_, stored_now(), result.ledger);
  const double gained = rows_took(books_.ledger) - rows_took(result.ledger);
  if (!(gained > kTiny * std::abs(books_.stored))) return;
  const double all = moving();
  if (gained <= kFew * all) {
    take_from_all(gained / all);
    return;
  }
  gained_ += gained;
  touched_ = touched_from_outside();
}

/// What they gave all the same, however finely the step was taken.
void Island::take_back_rest() {
  const double all = moving();
  if (gained_ > 0 && all > 0) take_from_all(std::min(1.0, gained_ / all));
  gained_ = 0;
}

}  // namespace breve
