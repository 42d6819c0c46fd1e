// Worlds: making, stepping, ending; the clock; what the machine knows about its host.
#include <cmath>
#include <optional>

#include "functions.hpp"
#include "internal.hpp"
#include "steve/library/library.hpp"
#include "steve/library/requests.hpp"

namespace breve::host {

namespace {

// Calls of the host inside callbacks inside calls of the host: each takes C++ stack, so there is an end.
constexpr std::uint32_t kNestingLimit = 64;
constexpr std::uint32_t kMostNesting = 200;

void speak(breve_world& world, breve_channel channel, std::string_view text) {
  if (channel == BREVE_CHANNEL_WARNING) ++world.warnings;
  if (channel == BREVE_CHANNEL_ERROR) ++world.errors;
  const auto& config = world.runtime->config;
  if (!config.print || text.empty()) return;
  std::string ended(text);
  const bool lines = channel != BREVE_CHANNEL_PRINT;
  if (lines && !ended.empty() && ended.back() != '\n') ended += '\n';
  const CallbackScope callback(world);
  config.print(config.user, &world, channel, ended.c_str(), ended.size());
}

/// What the runtime's `system` writes; "" if it says no.
std::string ask_system(breve_world& world, std::string_view command) {
  const std::string asked(command);
  Answer answer;
  const CallbackScope busy(world);
  const auto& config = world.runtime->config;
  return config.system(config.user, &world, asked.c_str(), &Answer::add, &answer) ? answer.text() : std::string();
}

/// The same, recorded or replayed.
std::string run_command(breve_world& world, std::string_view command) {
  if (world.inputs && world.inputs->replaying())
    return std::string(world.inputs->next(Inputs::Kind::Command).value_or(std::string_view()));
  std::string output = ask_system(world, command);
  if (world.inputs) world.inputs->add(Inputs::Kind::Command, output);
  return output;
}

/// Physics is as untrusted as the script that asks for it; but scripts that run in a small budget also have bodies.
std::uint64_t physics_budget(const breve_world_config& config) {
  constexpr std::uint64_t kLeast = 1'000'000;  // some 0.05 s
  if (config.physics_budget != 0 || config.budget == 0) return config.physics_budget;
  return std::max(kLeast, config.budget);
}

steve::MachineHost machine_host(breve_world& world) {
  const auto& config = world.config;
  steve::MachineHost host;
  host.print = [&world](std::string_view text) { speak(world, BREVE_CHANNEL_PRINT, text); };
  host.warn = [&world](std::string_view text) { speak(world, BREVE_CHANNEL_WARNING, text); };
  host.error = [&world](std::string_view text) { speak(world, BREVE_CHANNEL_ERROR, text); };
  const auto& callbacks = world.runtime->config;
  open_files(world, host);
  let_draw(world, host);
  host.network = network_of(world);
  host.may_sleep = (callbacks.rights & BREVE_RIGHT_SLEEP) != 0;
  host.may_read_clock = (callbacks.rights & BREVE_RIGHT_REAL_TIME) != 0;
  host.may_draw_entropy = (callbacks.rights & BREVE_RIGHT_ENTROPY) != 0;
  if (callbacks.system) host.system = [&world](std::string_view command) { return run_command(world, command); };
  host.from_outside = [&world](void* bytes, std::size_t size) { pass_number(world, bytes, size); };
  host.replays = [&world] { return world.inputs && world.inputs->replaying(); };
  host.call_foreign = [&world](const steve::ForeignFunction& function, steve::Instance& self,
                               std::span<const steve::Value> arguments) {
    return call_function(world, function, self, arguments);
  };
  host.places = [&world](std::size_t depth) { return places_of(world, depth); };
  host.gone = [&world](ObjectId id) { end_data(world, id); };
  for (std::size_t i = 0; i < config.argument_count; ++i) {
    need(config.arguments, "breve_world_config.arguments");
    need(config.arguments[i], "one of breve_world_config.arguments");
    host.arguments.emplace_back(config.arguments[i]);
  }
  for (std::size_t i = 0; i < config.setting_count; ++i) {
    need(config.settings, "breve_world_config.settings");
    need(config.settings[i].name, "the name of one of breve_world_config.settings");
    need(config.settings[i].value, "the value of one of breve_world_config.settings");
    host.settings.emplace_back(config.settings[i].name, config.settings[i].value);
  }
  host.patience = config.patience;
  host.seed = config.seed;
  host.verbose = config.verbose;
  host.strict = config.strict;
  host.budget = config.budget;
  host.call_budget = config.call_budget;
  host.physics_budget = physics_budget(config);
  if (config.depth_limit != 0) host.depth_limit = config.depth_limit;
  return host;
}

/// The rung that the host asked for holds whatever rung the controller's init chose. Single settings that init made
/// stay, unless it made them of another rung.
void keep_rung(breve_world& world, Rung asked) {
  Mechanics& mechanics = world.world->mechanics();
  const Accuracy chosen = mechanics.accuracy();
  if (chosen.rung == asked) return;
  mechanics.set_accuracy(asked);
  if (!chosen.custom) return;
  world.machine->warn_once("accuracy:settings-dropped", [&] {
    return "the accuracy '" + std::string(name_of(asked)) + "' that the host asked for replaces '" +
           std::string(name_of(chosen.rung)) +
           "' and the settings of it that the program made in init (settings stay if init does not call set-accuracy)";
  });
}

void start(breve_world& world) {
  const ScriptScope script(world);
  if (world.config.dimension == 2) world.world->flatten();
  std::optional<Rung> rung;
  if (world.config.accuracy) rung = rung_named(world.config.accuracy);
  if (rung) world.world->mechanics().set_accuracy(*rung);
  world.machine->start();
  if (world.config.dimension == 3 && world.world->dimension() != 3)
    fail(BREVE_ERROR_ARGUMENT, "dimension is 3, but the program's controller makes the world flat");
  if (world.config.length_unit > 0) world.world->mechanics().set_length_unit(world.config.length_unit);
  if (world.config.integration_step > 0) world.world->set_integration_step(world.config.integration_step);
  if (world.config.iteration_step > 0) world.world->set_iteration_step(world.config.iteration_step);
  if (rung) keep_rung(world, *rung);
  world.config.accuracy = nullptr;  // the host's text may go
}

/// Whole iterations that fit, and the rest kept. Decimal steps that do not add up in binary must not lose an iteration.
void advance(breve_world& world, double seconds) {
  constexpr double kRounding = 1e-9;  // of a step
  World& w = *world.world;
  double left = world.remainder + seconds * world.time_scale;
  world.remainder = 0;  // unless everything goes well
  std::uint32_t done = 0;
  while (left >= w.iteration_step() * (1 - kRounding) && !w.end_requested() && !w.paused()) {
    if (world.config.advance_limit != 0 && done++ == world.config.advance_limit) {
      left = std::fmod(left, w.iteration_step());
      break;
    }
    step(world);
    left = std::max(0.0, left - w.iteration_step());
  }
  world.remainder = left < w.iteration_step() ? left : 0;
}

}  // namespace

void iterate(breve_world& world) {
  const ScriptScope script(world);
  steve::serve_requests(*world.machine);
  world.previous.record(world.world->bodies());
  world.world->step();
}

void step(breve_world& world) {
  if (world.recorder)
    record_iteration(world);
  else
    iterate(world);
}

void check_world_config(const breve_world_config& config) {
  if (config.nesting_limit > kMostNesting)
    fail(BREVE_ERROR_ARGUMENT, "nesting_limit must be at most " + std::to_string(kMostNesting));
  for (const double step : {config.iteration_step, config.integration_step})
    if (!std::isfinite(step) || step < 0)
      fail(BREVE_ERROR_ARGUMENT, "iteration_step and integration_step must be finite and >= 0");
  for (const bool reserved : config.reserved)
    if (reserved) fail(BREVE_ERROR_ARGUMENT, "a reserved field is not false");
  if (config.dimension != 0 && config.dimension != 2 && config.dimension != 3)
    fail(BREVE_ERROR_ARGUMENT, "dimension must be 2, 3, or 0 for the script's own");
  if (!std::isfinite(config.patience) || config.patience < 0)
    fail(BREVE_ERROR_ARGUMENT, "patience must be finite and >= 0");
  if (!std::isfinite(config.length_unit) || config.length_unit < 0)
    fail(BREVE_ERROR_ARGUMENT, "length_unit must be finite and >= 0");
  if (config.accuracy) rung_named(config.accuracy);  // an error that names the rungs
}

breve_status make_world(const std::shared_ptr<RuntimeState>& state, std::uint32_t number,
                        std::shared_ptr<const steve::Program> program, const breve_world_config* config,
                        ErrorRecord& error, breve_world** world) noexcept {
  std::unique_ptr<breve_world> handle;
  const breve_status status = guard(error, [&] {
    const auto c = read_config(config, breve_world_config_default(), "breve_world_config");
    check_world_config(c);
    handle = make_in<breve_world>(state->memory(), state, number);
    handle->config = c;
    handle->program = std::move(program);
    handle->meter.set_limit(c.memory_limit);
    auto host = machine_host(*handle);
    handle->config.arguments = nullptr;  // copied; the host's arrays may go
    handle->config.settings = nullptr;
    handle->world = make_in<World>(&handle->meter, &handle->meter, c.seed);
    handle->world->share_workers(&handle->runtime->workers);
    handle->world->random().set_coarse(c.coarse_random);
    steve::register_resource_kinds(*handle->world);
    handle->user = UserData(c.user, nullptr);
    handle->machine =
        make_in<steve::Machine>(&handle->meter, handle->program, *handle->world, &handle->meter, std::move(host));
  });
  if (status != BREVE_OK) return status;
  const breve_status started = guard(handle->error, [&] {
    bind_classes(*handle, *handle->program);
    if (handle->config.profile) start_profile(*handle, handle->config.trace, handle->config.trace_user);
    start(*handle);
  });
  if (started != BREVE_OK) {
    error.take(std::move(handle->error));
    return started;
  }
  *world = handle.release();
  return BREVE_OK;
}

ScriptScope::ScriptScope(breve_world& world) : world_(world) {
  if (world_.tracing) fail(BREVE_ERROR_BUSY, "a breve_trace_fn may not run script");
  const std::uint32_t limit = world_.config.nesting_limit != 0 ? world_.config.nesting_limit : kNestingLimit;
  if (static_cast<std::uint32_t>(world_.running) >= limit)
    fail(BREVE_ERROR_DEPTH, "calls of host and script are nested more than " + std::to_string(limit) +
                                " deep: does a callback call itself?");
  world_.references.forget_all();
  if (world_.running++ == 0) world_.machine->begin_run();
}

// A call that failed, perhaps for lack of memory, has left garbage: it goes now, not at the end of an iteration that
// may not be reached for lack of memory.
ScriptScope::~ScriptScope() {
  if (world_.running == 1 && std::uncaught_exceptions() != exceptions_) {
    try {
      world_.machine->heap().reclaim();
    } catch (...) {
      // A destroy method that finds no memory either; what it has not freed waits for the end of the iteration.
    }
  }
  --world_.running;
  world_.references.forget_all();
}

CallbackScope::CallbackScope(breve_world& world) : world_(world), holds_(world.running == 0) {
  if (!holds_) return;
  ++world_.running;
  if (world_.machine) world_.machine->begin_run();
}

CallbackScope::~CallbackScope() {
  if (holds_) --world_.running;
  world_.references.forget_all();
}

void need_idle(const breve_world& world, const char* what) {
  if (world.running != 0)
    fail(BREVE_ERROR_BUSY, std::string(what) + " may not be called while a script of this world runs");
}

}  // namespace breve::host

using namespace breve::host;

breve_status breve_world_create(breve_runtime* runtime, const breve_program* program, const breve_world_config* config,
                                breve_world** world) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  const breve_status status = guard(runtime->error, [&] {
    need(program, "program");
    need(world, "world");
    check_world_config(read_config(config, breve_world_config_default(), "breve_world_config"));
  });
  if (status != BREVE_OK) return status;
  const CreationScope busy(*runtime);
  return make_world(runtime->state, runtime->state->worlds++, program->program, config, runtime->error, world);
}

breve_status breve_world_destroy(breve_world* world) {
  if (!world) return BREVE_OK;
  const breve_status status = guard(world->error, [&] {
    need_idle(*world, "breve_world_destroy");
    if (world->in_batch) fail(BREVE_ERROR_BUSY, "breve_world_destroy: the batch that runs this world destroys it");
  });
  if (status != BREVE_OK) return status;
  const auto memory_outlives_it = world->runtime;
  ++world->running;        // for the callbacks that destroy what the host keeps with it
  world->machine.reset();  // closes files that scripts have open, while the rest is still there
  delete world;
  return status;
}

void* breve_world_user(const breve_world* world) { return world ? world->user.get() : nullptr; }

const breve_error* breve_world_last_error(const breve_world* world) { return world ? world->error.view() : nullptr; }

breve_status breve_world_step(breve_world* world) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need_idle(*world, "breve_world_step");
    step(*world);
  });
}

breve_status breve_world_advance(breve_world* world, double seconds, double* fraction) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need_idle(*world, "breve_world_advance");
    if (!std::isfinite(seconds) || seconds < 0) fail(BREVE_ERROR_ARGUMENT, "seconds must be finite and >= 0");
    if (!world->world->paused()) advance(*world, seconds);
    if (fraction) *fraction = std::min(world->remainder / world->world->iteration_step(), std::nextafter(1.0, 0.0));
  });
}

double breve_world_time(const breve_world* world) { return world ? world->world->time() : 0; }

uint64_t breve_world_iteration(const breve_world* world) { return world ? world->world->iteration() : 0; }

double breve_world_iteration_step(const breve_world* world) { return world ? world->world->iteration_step() : 0; }

bool breve_world_ended(const breve_world* world) { return world && world->world->end_requested(); }

bool breve_world_paused(const breve_world* world) { return world && world->world->paused(); }

breve_status breve_world_set_paused(breve_world* world, bool paused) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] { world->world->set_paused(paused); });
}

uint64_t breve_world_seed(const breve_world* world) { return world ? world->world->random().seed() : 0; }

breve_status breve_world_draw_random(breve_world* world, double* number) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(number, "number");
    *number = world->world->random().uniform();
  });
}

breve_status breve_world_random(breve_world* world, const breve_value* bound, breve_value* result) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(bound, "bound");
    need(result, "result");
    if (bound->type != BREVE_TYPE_INT && bound->type != BREVE_TYPE_DOUBLE && bound->type != BREVE_TYPE_VECTOR)
      fail(BREVE_ERROR_TYPE, "a bound of random numbers is an int, a double or a vector");
    *result = to_host(*world, world->machine->random(from_host(*world, *bound)));
  });
}

breve_status breve_world_print(breve_world* world, const char* text, size_t size) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (size != 0) need(text, "text");
    world->machine->print({text ? text : "", size});
  });
}
