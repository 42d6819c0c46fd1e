// A profile as it is read: costs of the profiler itself taken out, totals summed up, names looked up.
#include <algorithm>

#include "steve/machine/profiler.hpp"

namespace breve::steve {

namespace {
constexpr double kNano = 1e-9;
}

void Profiler::work_out() {
  if (worked_out_at_ == events_ + 1) return;
  worked_out_at_ = 0;
  rows_.clear();
  overhead_ = 0;
  // A walk from the root, without recursion: the tree may be as deep as the program has methods.
  std::pmr::vector<std::pair<std::uint32_t, std::size_t>> waiting(rows_.get_allocator());
  std::pmr::vector<std::size_t> row_of(nodes_.size(), 0, rows_.get_allocator());
  waiting.emplace_back(0, 0);
  while (!waiting.empty()) {
    const auto [number, parent] = waiting.back();
    waiting.pop_back();
    const std::size_t row = rows_.size();
    row_of[number] = row;
    rows_.push_back({number, parent, nodes_[number].calls, static_cast<double>(nodes_[number].own) * kNano, 0});
    const std::size_t first = waiting.size();
    for (std::uint32_t n = nodes_[number].first_child; n != kNone; n = nodes_[n].next)
      if (nodes_[n].target == n) waiting.emplace_back(n, row);
    std::reverse(waiting.begin() + static_cast<std::ptrdiff_t>(first), waiting.end());
  }
  // Each call cost its caller and itself something; no node goes below nothing for it.
  std::pmr::vector<double> cost(rows_.size(), 0, rows_.get_allocator());
  for (std::uint32_t n = 1; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    const auto calls = static_cast<double>(node.calls);
    const std::size_t own = row_of[node.target];
    if (node.target != n) rows_[own].calls += node.calls;
    cost[own] += calls * inner_cost_ * kNano;
    if (node.parent != 0) cost[row_of[node.parent]] += calls * outer_cost_ * kNano;
  }
  for (std::size_t i = rows_.size(); i-- > 0;) {
    const double taken = std::min(cost[i], rows_[i].self);
    rows_[i].self -= taken;
    overhead_ += taken;
    rows_[i].total += rows_[i].self;
    if (i != 0) rows_[rows_[i].parent].total += rows_[i].total;
  }
  worked_out_at_ = events_ + 1;
}

std::size_t Profiler::node_count() {
  work_out();
  return rows_.size();
}

double Profiler::overhead_seconds() {
  work_out();
  return overhead_;
}

ProfileNode Profiler::node(std::size_t index) {
  work_out();
  const Row& row = rows_[index];
  ProfileNode result = describe(nodes_[row.node]);
  result.parent = row.parent;
  result.calls = row.calls;
  result.self_seconds = row.self;
  result.total_seconds = row.total;
  return result;
}

ProfileNode Profiler::describe(const Node& node) const {
  ProfileNode result;
  const Callee& callee = node.callee;
  result.kind = callee.kind;
  result.call_line = node.line;
  if (callee.cls) result.class_name = callee.cls->name.c_str();
  if (callee.code) {
    result.class_name = callee.code->class_name.c_str();
    result.name = callee.code->name.c_str();
    result.file = callee.code->file.c_str();
    result.line = callee.code->line;
  } else if (callee.method && callee.method->foreign && !callee.method->foreign->file().empty()) {
    result.name = node.program->symbols().name(callee.method->name).c_str();
    result.file = callee.method->foreign->file().c_str();
    result.line = callee.method->foreign->line();
  } else if (callee.method) {
    result.name = node.program->symbols().name(callee.method->name).c_str();
    result.file = node.program->sources().file(callee.method->span.file).name.c_str();
    result.line = callee.method->span.line;
  } else if (callee.kind == ProfileKind::World) {
    result.name = "world";
  } else {
    result.name = callee.name.data();
  }
  return result;
}

}  // namespace breve::steve
