// The tree of calls while it grows. A node that is entered again from the same line is found by the child entered last
// or the one behind it, so that loops cost no search.
#include "steve/machine/profiler.hpp"

#include <algorithm>
#include <limits>
#include <new>

namespace breve::steve {

Profiler::Profiler(std::shared_ptr<const Program> program, std::pmr::memory_resource* memory, Trace trace)
    : programs_(memory), nodes_(memory), stack_(memory), code_(memory), rows_(memory) {
  programs_.push_back(std::move(program));
  clear();
  measure_itself();
  clear();
  trace_ = std::move(trace);
  start_ = Clock::now();
}

void Profiler::clear() {
  nodes_.clear();
  stack_.clear();
  Node root;
  root.target = 0;
  nodes_.push_back(root);
  current_ = 0;
  events_ = 0;
}

void Profiler::measure_itself() {
  // The least of several batches: a batch that was interrupted must not make calls look cheaper than they are.
  constexpr int kBatches = 20, kCalls = 100;
  const Callee outer = Callee::act("outer"), inner = Callee::act("inner");
  inner_cost_ = outer_cost_ = std::numeric_limits<double>::max();
  for (int batch = 0; batch < kBatches; ++batch) {
    clear();
    enter(outer, 1);
    for (int i = 0; i < kCalls; ++i) {
      enter(inner, 1);
      leave();
    }
    leave();
    if (out_of_memory_) throw std::bad_alloc();
    inner_cost_ = std::min(inner_cost_, static_cast<double>(nodes_[2].own) / kCalls);
    outer_cost_ = std::min(outer_cost_, static_cast<double>(nodes_[1].own) / kCalls);
  }
}

void Profiler::add_program(const std::shared_ptr<const Program>& program) {
  // Without room for it no node may refer to it: the profile ends here.
  try {
    programs_.push_back(program);
  } catch (const std::bad_alloc&) {
    out_of_memory_ = true;
    stop();
  }
}

void Profiler::enter(const Callee& callee, std::uint32_t line, Clock::time_point now) noexcept {
  if (depth_++ == 0) last_ = now;
  if (!recording_) return;
  try {
    charge(now);
    // Lines of the text that stands for a foreign class mean nothing to anybody.
    if (nodes_[current_].callee.foreign) line = foreign_line_;
    foreign_line_ = 0;
    const std::uint32_t found = child(callee, line);
    stack_.push_back(found);
    if (found != current_) ++nodes_[found].calls;  // else there was no room for a node
    current_ = nodes_[found].target;
    ++events_;
    if (trace_) tell(true, found, now);
  } catch (const std::bad_alloc&) {
    out_of_memory_ = true;
    stop();
  }
}

void Profiler::enter_code(const void* key, std::string_view class_name, std::string_view name, std::string_view file,
                          std::uint32_t line) noexcept {
  if (depth_ == 0 || !recording_) return;
  const auto now = Clock::now();
  try {
    auto* const memory = nodes_.get_allocator().resource();
    auto found = code_.find(key);
    if (found == code_.end())
      found = code_
                  .try_emplace(key, ForeignCode{std::pmr::string(class_name, memory), std::pmr::string(name, memory),
                                                std::pmr::string(file, memory), line})
                  .first;
    enter(Callee::of(found->second), 0, now);
  } catch (const std::bad_alloc&) {
    out_of_memory_ = true;
    stop();
  }
}

void Profiler::leave(Clock::time_point now) noexcept {
  --depth_;
  if (!recording_) return;
  foreign_line_ = 0;
  const std::uint32_t left = stack_.back();
  charge(now);
  stack_.pop_back();
  current_ = stack_.empty() ? 0 : nodes_[stack_.back()].target;
  ++events_;
  if (trace_) tell(false, left, now);
}

std::uint32_t Profiler::child(const Callee& callee, std::uint32_t line) {
  const auto fits = [&](std::uint32_t n) {
    return n != kNone && nodes_[n].callee.same_as(callee) && nodes_[n].line == line;
  };
  const std::uint32_t hint = nodes_[current_].hint;
  if (fits(hint)) return hint;
  if (hint != kNone && fits(nodes_[hint].next)) return nodes_[current_].hint = nodes_[hint].next;
  for (std::uint32_t n = nodes_[current_].first_child; n != kNone; n = nodes_[n].next)
    if (fits(n) || (nodes_[n].line == line && renew(nodes_[n], callee))) return nodes_[current_].hint = n;
  return nodes_[current_].hint = add_child(callee, line);
}

std::uint32_t Profiler::add_child(const Callee& callee, std::uint32_t line) {
  if (nodes_.size() >= kMostNodes) {
    full_ = true;
    return current_;
  }
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  const std::uint32_t same = active(callee);
  Node node;
  node.callee = callee;
  node.program = programs_.back().get();
  node.line = line;
  node.parent = current_;
  node.target = same == kNone ? number : same;
  nodes_.push_back(node);
  Node& parent = nodes_[current_];
  if (parent.last_child == kNone)
    parent.first_child = number;
  else
    nodes_[parent.last_child].next = number;
  parent.last_child = number;
  return number;
}

std::uint32_t Profiler::active(const Callee& callee) const {
  for (std::uint32_t n = current_; n != 0; n = nodes_[n].parent)
    if (nodes_[n].callee.same_as(callee)) return n;
  return kNone;
}

bool Profiler::renew(Node& node, const Callee& callee) const {
  // A method of a program that was replaced goes on in its node if the new program also has it.
  const Callee& before = node.callee;
  const auto& now = *programs_.back();
  if (before.kind != callee.kind || node.program == &now) return false;
  if (!before.method != !callee.method || !before.code != !callee.code) return false;
  if (before.method) {
    if (before.method->owner->name != callee.method->owner->name ||
        before.method->parameters.size() != callee.method->parameters.size() ||
        node.program->symbols().name(before.method->name) != now.symbols().name(callee.method->name))
      return false;
  } else if ((before.code && before.code->class_name != callee.code->class_name) || before.name != callee.name ||
             !before.cls != !callee.cls || (before.cls && before.cls->name != callee.cls->name)) {
    return false;
  }
  node.callee = callee;
  node.program = &now;
  return true;
}

void Profiler::tell(bool begins, std::uint32_t node, Clock::time_point now) noexcept {
  if (telling_) return;
  telling_ = true;
  try {
    trace_({begins, std::chrono::duration<double>(now - start_ - receiving_).count(), describe(nodes_[node])});
  } catch (...) {
    trace_ = nullptr;
  }
  telling_ = false;
  last_ = Clock::now();
  receiving_ += last_ - now;
}

}  // namespace breve::steve
