// A profile laid out for people: what matters first, what does not matter folded away.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "profile.hpp"

namespace breve::command {

namespace {

constexpr double kFold = 0.005;      // of the whole: less is summed up in one line
constexpr double kVisible = 0.0005;  // less would read 0.0
constexpr std::size_t kMethodRows = 15;
constexpr std::size_t kLineRows = 10;

struct Tree {
  std::vector<breve_profile_node> nodes;
  std::vector<std::vector<std::size_t>> children;  // most costly first
  double whole = 0;                                // s

  double share(double seconds) const { return whole > 0 ? seconds / whole : 0; }
  /// The file that a call from this node stands in: that of the method around it.
  const char* file_around(std::size_t node) const {
    while (node != 0 && *nodes[node].file == '\0') node = nodes[node].parent;
    return nodes[node].file;
  }
};

Tree read_tree(breve_world* world) {
  Tree tree;
  std::size_t count = 0;
  if (breve_world_profile_node_count(world, &count) != BREVE_OK) throw std::runtime_error("the profile cannot be read");
  tree.nodes.resize(count);
  tree.children.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (breve_world_profile_node(world, i, &tree.nodes[i]) != BREVE_OK)
      throw std::runtime_error("the profile cannot be read");
    if (i != 0) tree.children[tree.nodes[i].parent].push_back(i);
  }
  for (auto& children : tree.children)
    std::stable_sort(children.begin(), children.end(), [&](std::size_t a, std::size_t b) {
      return tree.nodes[a].total_seconds > tree.nodes[b].total_seconds;
    });
  tree.whole = tree.nodes.front().total_seconds;
  return tree;
}

/// A time with three figures and its unit.
std::string duration(double s) {
  if (s <= 0) return "0";
  const auto figures = [](double x, const char* unit) {
    return fmt::format("{:.{}f} {}", x, x >= 99.95 ? 0 : x >= 9.995 ? 1 : 2, unit);
  };
  if (s >= 0.9995) return figures(s, "s");
  if (s >= 0.9995e-3) return figures(s * 1e3, "ms");
  if (s >= 0.9995e-6) return figures(s * 1e6, "µs");
  return fmt::format("{:.0f} ns", s * 1e9);
}

/// 1234567 as 1,234,567.
std::string grouped(std::uint64_t n) {
  std::string digits = std::to_string(n);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

std::string name_of(const breve_profile_node& n) {
  switch (n.kind) {
    case BREVE_PROFILE_METHOD:
    case BREVE_PROFILE_NATIVE: return fmt::format("{}.{}", n.class_name, n.name);
    case BREVE_PROFILE_FUNCTION: return fmt::format("{}()", n.name);
    case BREVE_PROFILE_STAGE: return fmt::format("[{}]", n.name);
    default: return *n.class_name != '\0' ? fmt::format("{} {}", n.name, n.class_name) : n.name;
  }
}

/// "flock.tz:12", without the folders.
std::string location(std::string_view file, std::uint32_t line) {
  return fmt::format("{}:{}", file.substr(file.find_last_of('/') + 1), line);
}

std::string location_of(const breve_profile_node& n) { return *n.file != '\0' ? location(n.file, n.line) : ""; }

std::string trimmed(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::string row(double share, double total, double self, std::uint64_t calls, const std::string& what,
                const std::string& location) {
  const std::string each = calls == 0 ? "" : duration(total / static_cast<double>(calls));
  return trimmed(fmt::format("{:>6.1f} {:>9} {:>9} {:>12} {:>9}  {:<46} {}", 100 * share, duration(total),
                             duration(self), calls == 0 ? "" : grouped(calls), each, what, location));
}

std::string heading(const char* percent, const char* what, const char* location) {
  return trimmed(fmt::format("{:>6} {:>9} {:>9} {:>12} {:>9}  {:<46} {}", percent, "total", "self", "calls", "per call",
                             what, location));
}

std::string location_in_tree(const Tree& tree, std::size_t node) {
  const auto& n = tree.nodes[node];
  const char* around = node == 0 ? "" : tree.file_around(n.parent);
  if (n.call_line == 0 || *around == '\0') return location_of(n);
  const std::string from = "from " + location(around, n.call_line);
  return *n.file == '\0' ? from : fmt::format("{}, {}", location_of(n), from);
}

void add_tree(const Tree& tree, std::size_t node, const std::string& indent, const char* branch, std::string& out) {
  const auto& n = tree.nodes[node];
  out += row(tree.share(n.total_seconds), n.total_seconds, n.self_seconds, n.calls, indent + branch + name_of(n),
             location_in_tree(tree, node));
  std::vector<std::size_t> shown;
  double folded = 0;
  std::uint64_t folded_calls = 0;
  std::size_t folded_count = 0;
  for (const std::size_t child : tree.children[node]) {
    if (tree.share(tree.nodes[child].total_seconds) >= kFold) {
      shown.push_back(child);
      continue;
    }
    folded += tree.nodes[child].total_seconds;
    folded_calls += tree.nodes[child].calls;
    ++folded_count;
  }
  const bool more = tree.share(folded) >= kVisible;
  std::string below = indent;
  if (*branch != '\0') below += branch == std::string("└ ") ? "  " : "│ ";
  for (const std::size_t child : shown) add_tree(tree, child, below, child == shown.back() && !more ? "└ " : "├ ", out);
  if (more)
    out += row(tree.share(folded), folded, folded, folded_calls,
               fmt::format("{}└ {} more", below, grouped(folded_count)), "");
}

struct Sum {
  std::string what, location;
  double self = 0, total = 0;
  std::uint64_t calls = 0;
};

template <class Key>
std::vector<Sum> sorted(const std::map<Key, Sum>& sums, double Sum::*by) {
  std::vector<Sum> result;
  for (const auto& [key, sum] : sums) result.push_back(sum);
  std::stable_sort(result.begin(), result.end(), [&](const Sum& a, const Sum& b) { return a.*by > b.*by; });
  return result;
}

std::string methods_table(const Tree& tree) {
  std::map<std::tuple<int, std::string, std::string>, Sum> sums;
  for (const auto& n : tree.nodes) {
    if (n.kind == BREVE_PROFILE_WORLD) continue;
    Sum& sum = sums[{n.kind, name_of(n), location_of(n)}];
    sum.what = name_of(n);
    sum.location = location_of(n);
    sum.self += n.self_seconds;
    sum.total += n.total_seconds;  // of nodes one below the other there is only one: recursion counts in the upper
    sum.calls += n.calls;
  }
  std::string out = "\nHottest, by self time\n" + heading("self %", "", "declared");
  std::size_t rows = 0;
  for (const Sum& s : sorted(sums, &Sum::self)) {
    if (rows++ == kMethodRows || tree.share(s.self) < kFold) break;
    out += row(tree.share(s.self), s.total, s.self, s.calls, s.what, s.location);
  }
  return out;
}

std::string lines_table(const Tree& tree) {
  std::map<std::tuple<std::string, std::uint32_t>, Sum> sums;
  for (std::size_t i = 1; i < tree.nodes.size(); ++i) {
    const auto& n = tree.nodes[i];
    const char* file = tree.file_around(n.parent);
    if (n.call_line == 0 || *file == '\0') continue;
    Sum& sum = sums[{file, n.call_line}];
    sum.location = location(file, n.call_line);
    sum.total += n.total_seconds;
    sum.calls += n.calls;
    const std::string name = name_of(n);
    if (sum.what.find(name) == std::string::npos) sum.what += (sum.what.empty() ? "" : ", ") + name;
  }
  std::string out;
  std::size_t rows = 0;
  for (const Sum& s : sorted(sums, &Sum::total)) {
    if (rows++ == kLineRows || tree.share(s.total) < kFold) break;
    const std::string each = duration(s.total / static_cast<double>(s.calls));
    out += trimmed(fmt::format("{:>6.1f} {:>9} {:>9} {:>12} {:>9}  {:<46} {}", 100 * tree.share(s.total),
                               duration(s.total), "", grouped(s.calls), each, s.location, s.what));
  }
  if (out.empty()) return out;
  return "\nLines with the most expensive calls\n" + heading("%", "line", "calls") + out;
}

}  // namespace

std::string profile_text(breve_world* world, const std::string& program) {
  const Tree tree = read_tree(world);
  double cost = 0;
  breve_world_profile_cost(world, &cost);
  std::string out =
      fmt::format("Profile of {}: {} iterations, {} in the world; {} of profiling overhead subtracted\n\n", program,
                  grouped(breve_world_iteration(world)), duration(tree.whole), duration(cost));
  out += heading("%", "call tree", "declared, called");
  add_tree(tree, 0, "", "", out);
  return out + methods_table(tree) + lines_table(tree);
}

}  // namespace breve::command
