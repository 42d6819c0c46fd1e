// Runs a program on a rung of the ladder of accuracy and checks what its first lines claim:
//
//     # rate 240                            iterations per second; 60 unless it says so
//     # claim 3 get-block-speed 0.98 1.02     after 3 s that method of the controller gives a number in this range
//     # claim 3 residual 0 1e-4 on precise    energy without an account, relative to the scale; on these rungs only
//     # claim 3 interventions 0 0             how often the guard acted
//
// The scale is the most that kinetic energy and the works of motors and scripts came to together.
#include <breve/breve.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Claim {
  double time = 0, low = 0, high = 0;
  std::string what, text;
};

struct Scene {
  std::string text;
  double rate = 60;
  std::vector<Claim> claims;
};

/// "on fast balanced" at the end of a claim: is this rung among them?
bool meant_for(std::istringstream& words, const std::string& rung) {
  std::string word;
  if (!(words >> word)) return true;
  if (word != "on") throw std::runtime_error("'" + word + "' where a claim ends, or goes on with 'on' and rungs");
  while (words >> word)
    if (word == rung) return true;
  return false;
}

Scene read_scene(const char* name, const std::string& rung) {
  std::ifstream file(name);
  if (!file) throw std::runtime_error(std::string("cannot open ") + name);
  Scene scene;
  for (std::string line; std::getline(file, line);) {
    scene.text += line + "\n";
    std::istringstream words(line);
    std::string mark, kind;
    if (!(words >> mark >> kind) || mark != "#") continue;
    if (kind == "rate") words >> scene.rate;
    if (kind != "claim") continue;
    Claim claim;
    claim.text = line.substr(line.find(kind) + kind.size() + 1);
    if (!(words >> claim.time >> claim.what >> claim.low >> claim.high))
      throw std::runtime_error("a claim is a time, a method, and two bounds: " + line);
    if (meant_for(words, rung)) scene.claims.push_back(claim);
  }
  std::stable_sort(scene.claims.begin(), scene.claims.end(),
                   [](const Claim& a, const Claim& b) { return a.time < b.time; });
  return scene;
}

std::filesystem::path beside(const char* program, const char* name) {
  return std::filesystem::path(program).parent_path() / name;
}

/// A program may include files that lie beside it.
bool include_beside(void* program, const char* name, const char*, breve_module* module) {
  std::ifstream file(beside(static_cast<const char*>(program), name), std::ios::binary);
  if (!file) return false;
  std::ostringstream bytes;
  bytes << file.rdbuf();
  auto* const text = new std::string(bytes.str());
  module->text = text->data();
  module->size = text->size();
  module->cookie = text;
  return true;
}

void release_module(void*, const breve_module* module) { delete static_cast<std::string*>(module->cookie); }

class Run {
 public:
  Run(const char* name, const std::string& rung) : scene_(read_scene(name, rung)) {
    breve_runtime_config of_runtime = breve_runtime_config_default();
    of_runtime.user = const_cast<char*>(name);
    const std::string folder = std::filesystem::absolute(name).parent_path().string();
    if (!files_.add(folder.c_str())) throw std::runtime_error("cannot read " + folder);
    of_runtime.files = files_.get();
    of_runtime.resolve_module = include_beside;
    of_runtime.release_module = release_module;
    runtime_ = breve::Runtime::create(of_runtime).or_throw();
    program_ = runtime_.compile(name, scene_.text).or_throw();
    breve_world_config config = breve_world_config_default();
    config.accuracy = rung.c_str();
    config.iteration_step = config.integration_step = 1 / scene_.rate;
    world_ = runtime_.world(program_, config).or_throw();
    start_ = world_.energy().or_throw();
  }

  /// How many claims do not hold. Prints each with what it came to.
  int check() {
    int wrong = 0;
    for (const Claim& claim : scene_.claims) {
      advance_to(claim.time);
      const double value = number(claim.what);
      const bool holds = value >= claim.low && value <= claim.high;
      std::printf("%s: %s: %.6g\n", holds ? "holds" : "WRONG", claim.text.c_str(), value);
      wrong += !holds;
    }
    return wrong;
  }

  bool empty() const { return scene_.claims.empty(); }

 private:
  void advance_to(double time) {
    const auto iterations = static_cast<std::uint64_t>(std::llround(time * scene_.rate));
    while (done_ < iterations) {
      world_.step().or_throw();
      ++done_;
      for (const breve_intervention& one : world_.interventions().or_throw()) {
        std::printf("       %g s: %s: %s (%g)\n", one.time, one.action, one.reason, one.value);
        ++interventions_;
      }
      const breve_energy now = world_.energy().or_throw();
      scale_ = std::max(scale_, now.kinetic + std::abs(now.motor_work - start_.motor_work) +
                                    std::abs(now.script_work - start_.script_work));
    }
  }

  double number(const std::string& what) {
    if (what == "interventions") return static_cast<double>(interventions_);
    if (what == "residual")
      return std::abs(world_.energy().or_throw().residual - start_.residual) / std::max(scale_, 1e-12);
    return world_.call(world_.controller(), what.c_str()).or_throw().number(NAN);
  }

  Scene scene_;
  breve::Files files_;
  breve::Runtime runtime_;
  breve::Program program_;
  breve::World world_;
  breve_energy start_{};
  std::uint64_t done_ = 0, interventions_ = 0;
  double scale_ = 0;
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: physics_scenes PROGRAM RUNG\n");
    return 2;
  }
  try {
    Run run(arguments[1], arguments[2]);
    if (run.empty()) std::printf("nothing is claimed on this rung\n");
    return run.check() != 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "physics_scenes: %s: %s\n", arguments[1], error.what());
    return 2;
  }
}
