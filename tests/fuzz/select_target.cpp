// Programs that call any selector of the class library: whatever they do has a status that breve.h names, and a world
// that was restored from an image, after each iteration, goes on exactly like the one that the image was taken of.
#include <string>

#include "selector_program.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace breve::fuzz {

namespace {

bool documented(breve_status status) {
  return status == BREVE_OK || status == BREVE_ERROR_SCRIPT || status == BREVE_ERROR_BUDGET ||
         status == BREVE_ERROR_DEPTH || status == BREVE_ERROR_MEMORY;
}

/// How a program is run; drawn before the program itself.
struct SelectPlan {
  explicit SelectPlan(Choices& choices) {
    static constexpr std::size_t kMemory[] = {64u << 20, 64u << 20, 256u << 20, 16u << 20};
    static constexpr const char* kRungs[] = {"fast", "fast", "balanced", "precise"};
    config = breve_world_config_default();
    config.seed = choices.below(16);
    config.memory_limit = choices.one_of(kMemory);
    config.budget = 60'000;
    config.physics_budget = 200'000;
    config.call_budget = choices.chance(50) ? 5'000 : 0;
    config.depth_limit = 60;
    config.accuracy = choices.one_of(kRungs);
    iterations = choices.chance(3) ? 50 : 1 + choices.below(4);
  }
  breve_world_config config;
  std::size_t iterations;
};

/// The hash; 0 if there is no memory to compute it.
std::uint64_t hash_of(const breve_world* world, const std::string& text) {
  std::uint64_t hash = 0;
  const breve_status status = breve_world_hash(world, &hash);
  if (status != BREVE_OK && status != BREVE_ERROR_MEMORY) finding(breve_world_last_error(world)->text, text);
  return hash;
}

breve_status step(breve_world* world, const std::string& text) {
  const breve_status status = breve_world_step(world);
  if (!documented(status)) finding(breve_world_last_error(world)->text, text);
  return status;
}

std::string told(const breve_world* world) {
  const breve_error* error = breve_world_last_error(world);
  return error && error->text && *error->text ? error->text : "no error";
}

/// Each iteration in `one` and, from an image taken before it, in `other`.
void run(breve_world* one, breve_world* other, std::size_t iterations, const std::string& text) {
  std::size_t size = 0;
  std::uint64_t before = hash_of(one, text);
  for (std::size_t i = 0; i < iterations; ++i) {
    const std::string image = image_of(one, text, 2 * size);
    if (image.empty()) return;
    size = image.size();
    const breve_status restored = breve_world_restore(other, image.data(), image.size());
    if (restored == BREVE_ERROR_MEMORY) return;
    if (restored != BREVE_OK) finding(breve_world_last_error(other)->text, text);
    const std::uint64_t same = hash_of(other, text);
    if (before != 0 && same != 0) require(before == same, "a restored world has another hash", text);
    const breve_status status = step(one, text), again = step(other, text);
    // A world that is short of memory may get by with other amounts after a restore.
    if (status == BREVE_ERROR_MEMORY || again == BREVE_ERROR_MEMORY) return;
    const std::uint64_t after = hash_of(one, text), restored_after = hash_of(other, text);
    if (after == 0 || restored_after == 0) return;
    require(status == again && after == restored_after,
            "a restored world goes on differently in iteration " + std::to_string(i + 1) + ": " + told(one) + " and " +
                told(other),
            text);
    before = after;
  }
}

std::size_t programs = 0;

/// @param change  what is not to be as the plan says
void run_selected(Bytes bytes, void (*change)(SelectPlan&)) {
  Choices choices(bytes);
  SelectPlan plan(choices);
  change(plan);
  const SelectorProgram generated = selector_program(choices);
  const std::string& text = generated.text;
  const Runtime runtime = make_runtime(breve_runtime_config_default());
  breve_program* compiled = nullptr;
  const breve_status status = breve_program_compile(runtime.get(), "generated.tz", text.data(), text.size(), &compiled);
  if (status == BREVE_ERROR_COMPILE) return;
  if (status != BREVE_OK) finding(breve_runtime_last_error(runtime.get())->text, text);
  const Program program(compiled);
  for (std::size_t course = 0; course < generated.courses; ++course) {
    const std::string number = std::to_string(course);
    const breve_setting setting = {"course", number.c_str()};
    plan.config.settings = &setting;
    plan.config.setting_count = 1;
    const auto create = [&] {
      breve_world* made = nullptr;
      const breve_status created = breve_world_create(runtime.get(), compiled, &plan.config, &made);
      if (!documented(created)) finding(breve_runtime_last_error(runtime.get())->text, text);
      return World(made);
    };
    const World one = create(), other = create();
    ++programs;
    if (one && other) run(one.get(), other.get(), plan.iterations, "# course " + number + "\n" + text);
  }
}

}  // namespace

std::size_t selected_programs() { return programs; }

std::string select_program_of(Bytes bytes) {
  Choices choices(bytes);
  const SelectPlan plan(choices);
  return selector_program(choices).text;
}

void fuzz_select(Bytes bytes) {
  run_selected(bytes, [](SelectPlan&) {});
}

void fuzz_restore(Bytes bytes) {
  run_selected(bytes, [](SelectPlan& plan) {
    plan.iterations = 50;
    // Short ones: it is the restoring that is looked at.
    plan.config.budget = 6'000;
    plan.config.physics_budget = 20'000;
  });
}

}  // namespace breve::fuzz
