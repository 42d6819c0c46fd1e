// The range of each gene. Wide enough for what a user would build, and for what nobody thought of.
#include <stdexcept>

#include "genes.hpp"

namespace adversary {

namespace {

constexpr Draw kLin = Draw::Linear, kLog = Draw::Logarithmic, kInt = Draw::Whole;
constexpr double kPi = 3.14159265358979323846;

const std::array<Range, kLinkGenes> kLinkRanges = {{
    {"parent", 0, 11, kInt, 0, 0.3},        {"joint", 0, 4, kInt, 0, 0.2},        {"shape", 0, 2, kInt, 1, 0.4},
    {"size_x", 0.05, 1.5, kLog, 0.2, 0},    {"size_y", 0.05, 1.5, kLog, 0.2, 0},  {"size_z", 0.05, 1.5, kLog, 0.2, 0},
    {"mass", 0.02, 20, kLog, 1, 0.1},       {"at_x", -1, 1, kLin, 0, 0.2},        {"at_y", -1, 1, kLin, 0, 0.2},
    {"at_z", -1, 1, kLin, 0, 0.2},          {"on_x", -1, 1, kLin, 0, 0.2},        {"on_y", -1, 1, kLin, 0, 0.2},
    {"on_z", -1, 1, kLin, 0, 0.2},          {"axis_x", -1, 1, kLin, 0, 0.2},      {"axis_y", -1, 1, kLin, 0, 0.2},
    {"axis_z", -1, 1, kLin, 1, 0.2},        {"turn_x", -kPi, kPi, kLin, 0, 0.4},  {"turn_y", -kPi, kPi, kLin, 0, 0.4},
    {"turn_z", -kPi, kPi, kLin, 0, 0.4},    {"rate_x", -10, 10, kLin, 0, 0.5},    {"rate_y", -10, 10, kLin, 0, 0.6},
    {"rate_z", -10, 10, kLin, 0, 0.6},      {"reach", 0.02, 1.5, kLin, 0, 0.5},   {"rebound", 0, 1, kLin, 0, 0.5},
    {"stiffness", 0.1, 1000, kLog, 0, 0.6}, {"rest", -1, 1, kLin, 0, 0.6},        {"damping", 1e-3, 10, kLog, 0, 0.6},
    {"speed", -20, 20, kLin, 0, 0.2},       {"strength", 0.5, 500, kLog, 0, 0.4}, {"torque", 0.05, 20, kLog, 0, 0.7},
    {"frequency", 0.1, 10, kLog, 0, 0.4},   {"phase", 0, 2 * kPi, kLin, 0, 0.3},
}};

const std::array<Range, kWorldGenes> kWorldRanges = {{
    {"links", 2, 12, kInt, 2, 0},        {"self_collisions", 0, 1, kInt, 0, 0}, {"loop", 0, 2, kInt, 0, 0.7},
    {"loop_a", 0, 11, kInt, 0, 0},       {"loop_b", 0, 11, kInt, 0, 0},         {"loop_x", -1, 1, kLin, 0, 0},
    {"loop_y", -1, 1, kLin, 0, 0},       {"loop_z", -1, 1, kLin, 0, 0},         {"tie", 1, 1000, kLog, 0, 0.8},
    {"tie_a", 0, 11, kInt, 0, 0},        {"tie_b", 0, 11, kInt, 0, 0},          {"tie_length", 0, 1, kLin, 0, 0.3},
    {"friction", 0, 1.5, kLin, 0, 0.2},  {"restitution", 0, 1, kLin, 0, 0.4},   {"threshold", 0, 0.5, kLin, 0, 0.6},
    {"velocity_x", -5, 5, kLin, 0, 0.4}, {"velocity_y", -5, 5, kLin, 0, 0.4},   {"velocity_z", -5, 5, kLin, 0, 0.4},
    {"spin_x", -20, 20, kLin, 0, 0.4},   {"spin_y", -20, 20, kLin, 0, 0.4},     {"spin_z", -20, 20, kLin, 0, 0.4},
    {"tilt_x", -kPi, kPi, kLin, 0, 0.3}, {"tilt_y", -kPi, kPi, kLin, 0, 0.3},   {"tilt_z", -kPi, kPi, kLin, 0, 0.3},
    {"height", 0.01, 2, kLog, 0.01, 0},
}};

constexpr const char* kFamilyNames[kFamilies] = {"drift", "swim", "fall", "hang", "drop", "walk", "overlap"};

}  // namespace

const Range& range_of(LinkGene gene) { return kLinkRanges[gene]; }
const Range& range_of(WorldGene gene) { return kWorldRanges[gene]; }
const char* name_of(Family family) { return kFamilyNames[static_cast<int>(family)]; }

bool family_named(const std::string& name, Family& family) {
  for (int i = 0; i < kFamilies; ++i) {
    if (name != kFamilyNames[i]) continue;
    family = static_cast<Family>(i);
    return true;
  }
  return false;
}

}  // namespace adversary
