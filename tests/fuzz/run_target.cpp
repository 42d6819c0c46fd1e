// Valid programs, generated and run: whatever happens has a status that breve.h names, and the same seed gives the same
// run: in a second world, after a snapshot, and after that snapshot is restored, there and here.
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "generator.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace breve::fuzz {

namespace {

/// How a program is run; drawn before the program itself.
struct Plan {
  explicit Plan(Choices& choices) {
    static constexpr std::uint64_t kBudgets[] = {5000, 3000, 300, 10000};
    static constexpr std::size_t kMemory[] = {64u << 20, 64u << 20, 64u << 20, 64u << 20, 4u << 20, 1u << 20};
    config = breve_world_config_default();
    config.seed = choices.below(4);
    config.budget = choices.one_of(kBudgets);
    config.physics_budget = 200'000;
    config.memory_limit = choices.one_of(kMemory);
    config.depth_limit = choices.chance(50) ? 100 : 0;
    config.strict = choices.chance(15);
    config.coarse_random = choices.chance(15);
    before = 1 + choices.below(4);
    after = 1 + choices.below(4);
    calls_back = choices.chance(30);
    input = choices.chance(50);
  }
  breve_world_config config;
  std::size_t before, after;  // iterations, to the snapshot and from there
  bool calls_back, input;
};

/// What one run showed: compared between runs.
struct Run {
  std::string printed;
  bool calls_back = false;
  unsigned prints = 0;
};

/// Inside a print a host may do nearly anything. What it does depends on the number of the print alone.
void call_back(breve_world* world, unsigned number) {
  const breve_object controller = breve_world_controller(world);
  breve_value value = breve_value_null();
  breve_object made{};
  std::size_t count = 0;
  std::uint64_t hash = 0;
  switch (number % 8) {
    case 0: breve_object_call(world, controller, "be-chosen", nullptr, 0, &value); break;
    case 1: breve_object_create(world, "C0", &made); break;
    case 2:
      if (breve_object_create(world, "C0", &made) == BREVE_OK) breve_object_free(world, made);
      break;
    case 3: {
      breve_object objects[4];
      if (breve_world_objects(world, "C0", objects, 4, &count) == BREVE_OK && count != 0)
        breve_object_free(world, objects[0]);
      break;
    }
    case 4: require(breve_world_step(world) == BREVE_ERROR_BUSY, "a step inside a step is not busy"); break;
    case 5: require(breve_world_hash(world, &hash) == BREVE_ERROR_BUSY, "a hash inside a step is not busy"); break;
    case 6: breve_world_queue_key(world, "a", true); break;
    default: breve_object_call(world, controller, "get-description", nullptr, 0, &value); break;
  }
}

void print(void* user, breve_world* world, breve_channel channel, const char* text, std::size_t size) {
  auto& run = *static_cast<Run*>(user);
  if (channel != BREVE_CHANNEL_PRINT) return;  // warnings that come once per world do not come again after a restore
  run.printed.append(text, size);
  if (run.calls_back && ++run.prints % 3 == 0) call_back(world, run.prints / 3);
}

bool documented(breve_status status) {
  return status == BREVE_OK || status == BREVE_ERROR_SCRIPT || status == BREVE_ERROR_BUDGET ||
         status == BREVE_ERROR_DEPTH || status == BREVE_ERROR_MEMORY;
}

/// The hash of a world in words; its status if the memory limit leaves no room to compute it.
std::string hash_of(const breve_world* world, const std::string& program) {
  std::uint64_t hash = 0;
  const breve_status status = breve_world_hash(world, &hash);
  if (status != BREVE_OK && status != BREVE_ERROR_MEMORY) finding(breve_world_last_error(world)->text, program);
  return status == BREVE_OK ? std::to_string(hash) : breve_status_name(status);
}

/// Iterations with their statuses, hashes and output, as one text.
std::string iterate(breve_world* world, Run& run, std::size_t count, const Plan& plan, const std::string& program) {
  run.printed.clear();
  run.prints = 0;
  std::string seen;
  for (std::size_t i = 0; i < count; ++i) {
    if (plan.input) {
      breve_world_queue_key(world, "a", i % 2 == 0);
      breve_object first{};
      std::size_t objects = 0;
      if (breve_world_objects(world, "C0", &first, 1, &objects) == BREVE_OK && objects != 0)
        breve_world_queue_click(world, first);
      breve_menu_item item{};
      std::size_t items = 0;
      if (breve_world_menu_items(world, &item, 1, &items) == BREVE_OK && items != 0)
        breve_world_queue_choice(world, item.item);
    }
    const breve_status status = breve_world_step(world);
    if (!documented(status)) finding(breve_world_last_error(world)->text, program);
    seen += std::string(breve_status_name(status)) + " " + hash_of(world, program) + "\n";
    if (status != BREVE_OK) seen += breve_world_last_error(world)->message;
  }
  return seen + run.printed;
}

/// A world that has no memory left may get by with other amounts after a restore.
bool out_of_memory(const std::string& seen) { return seen.find("BREVE_ERROR_MEMORY") != std::string::npos; }

void compare(const std::string& one, const std::string& other, const char* what, const std::string& program) {
  if (one == other) return;
  finding(what, program + "\n--- one:\n" + one + "\n--- other:\n" + other);
}

constexpr std::string_view kPlanLine = "# plan ";
constexpr std::size_t kPlanBytes = 64;  // more than a plan takes

void run_program(const Plan& plan, const std::string& text) {
  Run run;
  run.calls_back = plan.calls_back;
  breve_runtime_config config = breve_runtime_config_default();
  config.user = &run;
  config.print = print;
  const Runtime runtime = make_runtime(config);
  breve_program* compiled = nullptr;
  if (breve_program_compile(runtime.get(), "generated.tz", text.data(), text.size(), &compiled) != BREVE_OK)
    finding(breve_runtime_last_error(runtime.get())->text, text);
  const Program program(compiled);

  const auto create = [&](std::string& seen) {
    run.printed.clear();
    run.prints = 0;
    breve_world* world = nullptr;
    const breve_status status = breve_world_create(runtime.get(), compiled, &plan.config, &world);
    if (!documented(status)) finding(breve_runtime_last_error(runtime.get())->text, text);
    seen = breve_status_name(status) + std::string("\n") + run.printed;
    if (status != BREVE_OK) seen += breve_runtime_last_error(runtime.get())->message;
    return World(world);
  };
  std::string start_one, start_other;
  const World one = create(start_one);
  const World other = create(start_other);
  compare(start_one, start_other, "two worlds of one seed start differently", text);
  if (!one) return;

  const std::string one_before = iterate(one.get(), run, plan.before, plan, text);
  const std::string hash = hash_of(one.get(), text);
  const bool whole = !out_of_memory(one_before) && !out_of_memory(hash);
  const std::string image = whole ? image_of(one.get(), text) : "";
  const std::string one_after = iterate(one.get(), run, plan.after, plan, text);
  const std::string other_before = iterate(other.get(), run, plan.before, plan, text);
  const std::string other_after = iterate(other.get(), run, plan.after, plan, text);
  compare(one_before, other_before, "two worlds of one seed differ", text);
  compare(one_after, other_after, "two worlds of one seed differ, or a snapshot changed the run", text);
  if (image.empty() || out_of_memory(one_after)) return;

  for (const World* world : {&one, &other}) {
    const breve_status restored = breve_world_restore(world->get(), image.data(), image.size());
    if (restored == BREVE_ERROR_MEMORY) return;
    if (restored != BREVE_OK) finding(breve_world_last_error(world->get())->text, text);
    const std::string restored_hash = hash_of(world->get(), text);
    if (!out_of_memory(restored_hash)) compare(hash, restored_hash, "a restored world has another hash", text);
    const std::string again = iterate(world->get(), run, plan.after, plan, text);
    if (!out_of_memory(again)) compare(one_after, again, "a restored world goes on differently", text);
  }
}

}  // namespace

void skip_plan(Choices& choices) { const Plan plan(choices); }

void fuzz_run(Bytes bytes) {
  Choices choices(bytes);
  const Plan plan(choices);
  run_program(plan, generate_program(choices));
}

std::string kept_program_of(Bytes bytes) {
  std::string line(kPlanLine);
  for (const std::uint8_t byte : bytes.first(std::min(bytes.size(), kPlanBytes))) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    line += kDigits[byte / 16];
    line += kDigits[byte % 16];
  }
  Choices choices(bytes);
  skip_plan(choices);
  return line + "\n" + generate_program(choices);
}

void fuzz_text(Bytes bytes) {
  const std::string text(bytes.begin(), bytes.end());
  require(text.starts_with(kPlanLine), "the program does not begin with its plan");
  std::vector<std::uint8_t> drawn;
  for (std::size_t at = kPlanLine.size(); at + 1 < text.size() && text[at] != '\n'; at += 2)
    drawn.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(at, 2), nullptr, 16)));
  Choices choices(drawn);
  const Plan plan(choices);
  run_program(plan, text);
}

}  // namespace breve::fuzz
