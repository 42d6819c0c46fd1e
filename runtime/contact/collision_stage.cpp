// One sub-step of collisions: first touches in order of time, each at its own moment, then the contacts that last.
#include "runtime/contact/collision_stage.hpp"

#include <algorithm>

namespace breve {

namespace {

bool same(const BodyState& x, const BodyState& y) {
  return x.location == y.location && x.orientation.coeffs() == y.orientation.coeffs() && x.velocity == y.velocity &&
         x.acceleration == y.acceleration && x.rotational_velocity == y.rotational_velocity &&
         x.rotational_acceleration == y.rotational_acceleration && x.force == y.force && x.torque == y.torque &&
         x.shape == y.shape && x.physics == y.physics;
}

}  // namespace

void CollisionStage::begin(const CollisionClient& client, std::uint64_t rules, const Extent& space) {
  purge();
  if (!(space == space_)) {
    space_ = space;
    look_at_all_ = true;
  }
  const bool rules_changed = rules != seen_rules_;
  if (rules_changed || bodies_->revision() != seen_bodies_) refresh(client, rules_changed);
  seen_bodies_ = bodies_->revision();
  seen_rules_ = rules;
  enter_loaded(client);
  start_paths();
}

void CollisionStage::finish(CollisionClient& client, double start, double h, const Vector3& gravity, bool at_impact) {
  purge();  // handlers of impacts may have freed bodies since
  for (const ProxyIndex index : moved_) {
    const Proxy& proxy = proxies_[index];
    if (proxy.path == kNoPath) continue;
    Path& path = paths_[proxy.path];
    path.begin = 0;
    path.end = h;
    path.to = bodies_->state(proxy.body);
    finish_path(path);
  }
  impacts_.clear();
  const Substep substep{client, start, h, gravity};
  update_boxes(client);
  count_first_work(client);
  drop_far_pairs();
  seek_first_impacts(substep, at_impact);
  run_impacts(substep);
  report_lasting(substep);
}

void CollisionStage::abandon() {
  bodies_->set_log(nullptr);
  impacts_.clear();
  new_pairs_.clear();
  look_at_all_ = true;  // pairs that were just found may be lost
}

CollisionStage::Counters CollisionStage::take_counters() { return std::exchange(counters_, Counters()); }

// --- impacts --------------------------------------------------------------------------------------------------------

bool CollisionStage::later(const Impact& x, const Impact& y) const {
  if (x.time != y.time) return x.time > y.time;
  const std::uint64_t xa = proxies_[x.a].serial;
  const std::uint64_t ya = proxies_[y.a].serial;
  return xa != ya ? xa > ya : proxies_[x.b].serial > proxies_[y.b].serial;
}

/// Before any pair is asked or dropped: where there is too much of it, the sub-step leaves all touches as they were.
void CollisionStage::count_first_work(CollisionClient& client) {
  std::uint64_t meeting = 0;
  for (Pair& pair : pairs_) {
    pair.ask_at_end = boxes_meet(pair);
    meeting += pair.ask_at_end ? 1 : 0;
  }
  client.work(kWorkOfPath * moved_.size() + kWorkOfPair * meeting);
}

void CollisionStage::seek_first_impacts(const Substep& substep, bool at_impact) {
  for (Pair& pair : pairs_) {
    ++counters_.pairs;
    pair.reported = false;
    if (!pair.ask_at_end) {
      pair.touching = false;
    } else if (!pair.touching && at_impact) {
      seek_impact(substep, pair, 0);
    }
  }
}

void CollisionStage::seek_impact(const Substep& substep, Pair& pair, double from) {
  const double h = substep.h;
  const Proxy& a = proxies_[pair.a];
  const Proxy& b = proxies_[pair.b];
  pair.ask_at_end = true;
  if (a.path == kNoPath && b.path == kNoPath) return;
  if (!(from < h)) return;
  ++counters_.searches;
  Impact impact;
  double after = 0;
  Motion of_b = motion_from(b, from);
  of_b.start.location += image_of_b(pair);
  NarrowCounters narrow;
  const bool hit = time_of_impact(*bodies_->collision_shape(a.body), motion_from(a, from),
                                  *bodies_->collision_shape(b.body), of_b, h - from, after, impact.contact, &narrow);
  counters_.facets += narrow.facets;
  substep.client.work(kWorkOfImpact + narrow.facets);
  if (!hit) return;
  pair.ask_at_end = false;
  impact.time = std::min(from + after, h);
  impact.a = pair.a;
  impact.b = pair.b;
  impact.version_a = a.version;
  impact.version_b = b.version;
  impacts_.push_back(impact);
  std::push_heap(impacts_.begin(), impacts_.end(), [this](const Impact& x, const Impact& y) { return later(x, y); });
}

void CollisionStage::run_impacts(const Substep& substep) {
  while (!impacts_.empty()) {
    std::pop_heap(impacts_.begin(), impacts_.end(), [this](const Impact& x, const Impact& y) { return later(x, y); });
    const Impact impact = impacts_.back();
    impacts_.pop_back();
    // A path that changed since, or a body that is gone, makes the impact void.
    if (proxies_[impact.a].version != impact.version_a || proxies_[impact.b].version != impact.version_b) continue;
    deliver_impact(substep, impact);
  }
}

void CollisionStage::deliver_impact(const Substep& substep, const Impact& impact) {
  const ProxyIndex ends[2] = {impact.a, impact.b};
  BodyState shown[2];
  for (int i = 0; i < 2; ++i) {
    Proxy& proxy = proxies_[ends[i]];
    if (proxy.path != kNoPath) place(proxy.body, state_at(paths_[proxy.path], impact.time));
    shown[i] = bodies_->state(proxy.body);
    if (proxy.path == kNoPath && proxy.impacts == 0) moved_.push_back(ends[i]);
    ++proxy.impacts;
  }
  Pair* pair = find_pair(impact.a, impact.b);
  pair->touching = pair->reported = true;
  ++counters_.impacts;
  ++counters_.reports;
  log_.clear();
  bodies_->set_log(&log_);
  try {
    substep.client.touched(proxies_[impact.a].body, proxies_[impact.b].body, impact.contact,
                           substep.start + impact.time);
  } catch (...) {
    bodies_->set_log(nullptr);
    // The step ends here, and nobody else knows that the two were elsewhere for a moment.
    for (int i = 0; i < 2; ++i) stays_on_path(ends[i], shown[i]);
    throw;
  }
  bodies_->set_log(nullptr);
  for (int i = 0; i < 2; ++i) {
    if (proxies_[ends[i]].body != kNoBody && !stays_on_path(ends[i], shown[i])) restart(substep, ends[i], impact.time);
  }
  changed_by_others(substep, impact.a, impact.b, impact.time);
}

/// After a handler: a body that nobody touched moves exactly as it would have, to the end of the sub-step.
/// @param shown  as the handler saw it
/// @return       whether it is one
bool CollisionStage::stays_on_path(ProxyIndex index, const BodyState& shown) {
  const Proxy& proxy = proxies_[index];
  if (proxy.body == kNoBody || !same(bodies_->state(proxy.body), shown)) return false;
  if (proxy.path != kNoPath) place(proxy.body, paths_[proxy.path].to);
  return true;
}

void CollisionStage::changed_by_others(const Substep& substep, ProxyIndex a, ProxyIndex b, double time) {
  // A handler may push others than the two. They stand at the end of the sub-step, but are pushed at `time`.
  found_.clear();
  for (const BodyIndex body : log_) {
    if (body < proxy_of_.size() && proxy_of_[body] != kNoProxy) found_.push_back(proxy_of_[body]);
  }
  std::sort(found_.begin(), found_.end(),
            [this](ProxyIndex x, ProxyIndex y) { return proxies_[x].serial < proxies_[y].serial; });
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  const std::pmr::vector<ProxyIndex> changed(found_, found_.get_allocator());
  for (const ProxyIndex index : changed) {
    const Proxy& proxy = proxies_[index];
    if (index == a || index == b) continue;
    if (proxy.path != kNoPath) {
      // What the handler set stays; what it left as it was is taken from the path at `time`.
      const Path& path = paths_[proxy.path];
      const BodyState now = bodies_->state(proxy.body);
      if (same(now, path.to)) continue;
      BodyState then = state_at(path, time);
      if (now.location != path.to.location) then.location = now.location;
      if (now.orientation.coeffs() != path.to.orientation.coeffs()) then.orientation = now.orientation;
      if (now.velocity != path.to.velocity) then.velocity = now.velocity;
      if (now.rotational_velocity != path.to.rotational_velocity) then.rotational_velocity = now.rotational_velocity;
      place(proxy.body, then);
    }
    restart(substep, index, time);
  }
}

void CollisionStage::restart(const Substep& substep, ProxyIndex index, double time) {
  Proxy& proxy = proxies_[index];
  ++proxy.version;
  const bool held = proxy.impacts >= kMostImpacts;
  if (held) ++counters_.held;
  if (proxy.path == kNoPath) {
    if (proxy.impacts == 0) moved_.push_back(index);
    paths_.emplace_back();
    proxy.path = static_cast<std::uint32_t>(paths_.size() - 1);
  }
  Path& path = paths_[proxy.path];
  path.begin = time;
  path.end = substep.h;
  path.from = bodies_->state(proxy.body);
  if (!held && time < substep.h) bodies_->advance(proxy.body, substep.h - time, substep.gravity);
  path.to = bodies_->state(proxy.body);
  finish_path(path);
  if (held) path.velocity = path.rotational_velocity = Vector3::Zero();
  fresh_.clear();
  update_box(index);
  find_new_pairs(substep.client);
  find_near(proxies_[index].box);
  for (const ProxyIndex other : found_) {
    Pair* pair = other == index ? nullptr : find_pair(index, other);
    if (!pair || !boxes_meet(*pair)) continue;
    substep.client.work(kWorkOfPair);
    if (pair->touching) {
      // It is another touch only if they have come apart in between.
      Contact contact;
      if (touching(substep, *pair, motion_from(proxies_[pair->a], time).start,
                   motion_from(proxies_[pair->b], time).start, contact)) {
        continue;
      }
      pair->touching = false;
    }
    seek_impact(substep, *pair, time);
  }
}

// --- contacts that last ---------------------------------------------------------------------------------------------

void CollisionStage::report_lasting(const Substep& substep) {
  // Handlers may free and move bodies, but the list stays as it is: new bodies enter at the next begin().
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    Pair& pair = pairs_[i];
    if (!pair.touching && !pair.ask_at_end) continue;
    const Proxy& a = proxies_[pair.a];
    const Proxy& b = proxies_[pair.b];
    if (a.body == kNoBody || b.body == kNoBody) continue;
    Contact contact;
    pair.touching = touching(substep, pair, pose_now(a), pose_now(b), contact);
    if (!pair.touching || pair.reported) continue;
    pair.reported = true;
    ++counters_.reports;
    substep.client.touched(a.body, b.body, contact, substep.start + substep.h);
  }
}

}  // namespace breve
