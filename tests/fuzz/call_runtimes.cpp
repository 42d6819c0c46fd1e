// Calls of versions, runtimes, programs, lints and files, and the programs that are compiled.
#include <array>

#include "call_functions.hpp"
#include "image_scenes.hpp"

namespace breve::fuzz {

namespace call_runtimes {

// --- versions --------------------------------------------------------------------------------------------------------

breve_status version(Caller&) {
  read_text(breve_version());
  return BREVE_OK;
}
breve_status abi(Caller&) {
  require(breve_abi() == BREVE_ABI, "another number of the interface");
  return BREVE_OK;
}
breve_status status_name(Caller& c) {
  read_text(breve_status_name(static_cast<breve_status>(c.choose().below(32))));
  return BREVE_OK;
}

// --- runtimes --------------------------------------------------------------------------------------------------------

/// A runtime for a moment.
breve_status runtime_create(Caller& c) {
  breve_runtime_config config = c.chance(80) ? c.runtime_config() : breve_runtime_config_default();
  const std::size_t spoiled = c.choose().below(8);
  switch (spoiled) {
    case 0: config.struct_size = c.struct_size(sizeof config); break;
    case 1: config.worker_threads = 3, c.expect_refusal(); break;
    case 2: config.rights = 64, c.expect_refusal(); break;
    case 4: config.rights = BREVE_RIGHT_SLEEP | BREVE_RIGHT_REAL_TIME | BREVE_RIGHT_ENTROPY; break;
    case 3:
      if (config.allocate) config.allocate = nullptr, c.expect_refusal();
      break;
    default: break;
  }
  Out<breve_runtime*> made(c);
  const bool defaults = spoiled > 4 && c.chance(10), other = c.chance(5);
  if (other) c.expect_refusal();
  const std::uint32_t abi = other ? BREVE_ABI - 1 : BREVE_ABI;
  const breve_status status = made.after(breve_runtime_create_for(abi, defaults ? nullptr : &config, made.to()));
  if (made) require(breve_runtime_destroy(*made) == BREVE_OK, "an idle runtime cannot be destroyed");
  return status;
}

/// NULL, or a runtime whose place another one takes.
breve_status runtime_destroy(Caller& c) {
  if (c.chance(60)) return breve_runtime_destroy(nullptr);
  breve_runtime*& runtime = c.choose().one_of(c.runtimes());
  if (!runtime) return BREVE_OK;  // it is being replaced further out
  const breve_status status = breve_runtime_destroy(runtime);
  if (status != BREVE_OK) return status;
  runtime = nullptr;
  const breve_runtime_config config = c.runtime_config();
  breve_runtime* made = nullptr;
  require(breve_runtime_create(&config, &made) == BREVE_OK, "no runtime");
  runtime = made;
  return BREVE_OK;
}

breve_status runtime_last_error(Caller& c) {
  const breve_runtime* runtime = c.runtime();
  const breve_error* error = breve_runtime_last_error(runtime);
  require(runtime || !error, "an error of no runtime");
  if (error) read_text(error->text);
  return BREVE_OK;
}

void read_diagnostic(const breve_diagnostic& told) {
  for (const char* text : {told.code, told.message, told.help, told.file, told.text}) read_text(text);
}

breve_status runtime_diagnostic_count(Caller& c) {
  const breve_runtime* runtime = c.runtime();
  const std::size_t count = breve_runtime_diagnostic_count(runtime);
  require(runtime || count == 0, "diagnostics of no runtime");
  return BREVE_OK;
}
breve_status runtime_diagnostic(Caller& c) {
  const breve_runtime* runtime = c.runtime();
  const std::size_t count = breve_runtime_diagnostic_count(runtime);
  const std::size_t index = c.chance(20) ? c.word() : c.choose().below(count + 1);
  if (index >= count) c.expect_refusal();
  Out<breve_diagnostic> told(c);
  const breve_status status = told.after(breve_runtime_diagnostic(runtime, index, told.to()));
  if (told) read_diagnostic(*told);
  return status;
}

breve_status lint_count(Caller&) {
  require(breve_lint_count() != 0, "no lints");
  return BREVE_OK;
}
breve_status lint(Caller& c) {
  const std::size_t index = c.choose().below(breve_lint_count() + 2);
  if (index >= breve_lint_count()) c.expect_refusal();
  Out<breve_lint_info> info(c);
  const breve_status status = info.after(breve_lint(index, info.to()));
  if (info) read_text(info->code), read_text(info->summary);
  return status;
}
breve_status runtime_allow(Caller& c) {
  breve_runtime* runtime = c.runtime();
  const char* code = c.text_or_null(c.chance(60) ? "lint-unused-variable" : "lint-nothing");
  return breve_runtime_allow_lint(runtime, code);
}

// --- functions of the host -------------------------------------------------------------------------------------------

breve_status first_argument(void*, const breve_call* call, breve_value* result) {
  if (call->count != 0) *result = call->arguments[0];
  return BREVE_OK;
}
breve_status runtime_add_function(Caller& c) {
  static constexpr const char* kNames[] = {"hostOne", "hostTwo", "hostThree", "sqrt", "1st", ""};
  static constexpr std::uint32_t kTypes[] = {BREVE_TYPE_NULL,   BREVE_TYPE_INT,     BREVE_TYPE_MATRIX,
                                             BREVE_TYPE_STRING, BREVE_TYPE_POINTER, 4711};
  breve_runtime* runtime = c.runtime();
  breve_function f = breve_function_default();
  f.name = c.text_or_null(c.choose().one_of(kNames));
  const std::uint32_t parameter = c.choose().one_of(kTypes);
  f.parameters = &parameter;
  f.parameter_count = c.chance(80) ? 1 : 0;
  f.result = c.choose().one_of(kTypes);
  f.call = c.chance(90) ? first_argument : nullptr;
  if (!f.call || f.result >= BREVE_TYPE_POINTER) c.expect_refusal();
  return breve_runtime_add_function(runtime, &f);
}

breve_status runtime_add_class(Caller& c) {
  static constexpr const char* kNames[] = {"HostOne", "HostTwo", "Chatter", "1st", "two words", ""};
  static constexpr const char* kParents[] = {"Object", "Mobile", "HostOne", "Nobody", "-"};
  static constexpr std::uint32_t kTypes[] = {BREVE_TYPE_NULL, BREVE_TYPE_VECTOR, BREVE_TYPE_POINTER, 4711};
  breve_runtime* runtime = c.runtime();
  breve_class description = breve_class_default();
  if (c.chance(10)) description.struct_size = c.struct_size(sizeof description);
  // Fields beyond it are not looked at.
  if (description.struct_size != sizeof description) return breve_runtime_add_class(runtime, &description);
  const bool has_method = c.chance(80), has_parameter = c.chance(80);
  const breve_parameter parameter{has_method && has_parameter ? c.text_or_null("to") : nullptr,
                                  c.choose().one_of(kTypes), 0};
  const breve_variable variable{"kept", c.choose().one_of(kTypes), 0};
  breve_method method{};
  method.name = has_method ? c.text_or_null("host-method") : nullptr;
  method.parameters = &parameter;
  method.parameter_count = has_parameter ? 1 : 0;
  method.call = c.chance(90) ? first_argument : nullptr;
  description.name = c.text_or_null(c.choose().one_of(kNames));
  description.parent = c.text_or_null(c.choose().one_of(kParents));
  const breve_place place{nullptr, c.chance(50) ? "host.lua" : nullptr, 3};
  description.method_places = c.chance(50) ? &place : nullptr;
  description.methods = &method;
  description.method_count = has_method ? 1 : 0;
  description.variables = &variable;
  description.variable_count = c.chance(50) ? 1 : 0;
  return breve_runtime_add_class(runtime, &description);
}

// --- programs --------------------------------------------------------------------------------------------------------

constexpr std::size_t kMostPrograms = 4;

/// There is room for another program; to make one takes long, so that it is seldom made where `percent` is small.
bool may_make(Caller& c, std::size_t percent) { return c.chance(percent) && c.programs().size() < kMostPrograms; }

breve_status program_load(Caller& c) {
  static constexpr const char* kNames[] = {"Chatter.tz", "Nowhere.tz", "Broken.tz", "Empty.tz", ""};
  breve_runtime* runtime = c.runtime();
  const char* name = c.text_or_null(may_make(c, 50) ? c.choose().one_of(kNames) : "Nowhere.tz");
  Out<breve_program*> made(c);
  const breve_status status = made.after(breve_program_load(runtime, name, made.to()));
  if (made) c.keep(*made);
  return status;
}

/// Its plugin may be refused.
constexpr std::string_view kPlugged = R"(@plugin "plugin.so"(start).
@use Control.
Controller Plugged.
Control : Plugged { + to iterate: print pluggedIn(). }
)";

breve_status program_compile(Caller& c) {
  breve_runtime* runtime = c.runtime();
  const char* name = c.text_or_null("other.tz");
  std::string_view text = "Controller Nobody. Object : Half { + to init: (";
  if (may_make(c, 40)) text = c.choose().one_of(call_programs());
  if (may_make(c, 10)) text = kPlugged;
  if (c.chance(5)) text = {};
  if (c.chance(3)) text = {nullptr, 7}, c.expect_refusal();
  Out<breve_program*> made(c);
  const breve_status status = made.after(breve_program_compile(runtime, name, text.data(), text.size(), made.to()));
  if (made) c.keep(*made);
  return status;
}

breve_status program_create_library(Caller& c) {
  static constexpr const char* kControllers[] = {nullptr, "Control", "PhysicalControl", "PlanarControl", "Mobile"};
  breve_runtime* runtime = c.runtime();
  const char* controller = may_make(c, 10) ? c.choose().one_of(kControllers) : "Nobody";
  Out<breve_program*> made(c);
  const breve_status status = made.after(breve_program_create_library(runtime, controller, made.to()));
  if (made) c.keep(*made);
  return status;
}

breve_status program_destroy(Caller& c) {
  if (c.programs().size() < 2 || c.chance(50)) return breve_program_destroy(nullptr), BREVE_OK;
  const auto at = c.programs().begin() + static_cast<std::ptrdiff_t>(c.choose().below(c.programs().size()));
  breve_program* program = *at;
  c.programs().erase(at);
  breve_program_destroy(program);
  return BREVE_OK;
}

breve_status program_class_count(Caller& c) {
  const breve_program* program = c.program();
  require((breve_program_class_count(program) != 0) == (program != nullptr), "a number of classes is wrong");
  return BREVE_OK;
}
breve_status program_class(Caller& c) {
  const breve_program* program = c.program();
  const std::size_t count = breve_program_class_count(program);
  const std::size_t index = c.chance(10) ? c.word() : c.choose().below(count + 1);
  if (index >= count) c.expect_refusal();
  Out<breve_class_info> info(c);
  const breve_status status = info.after(breve_program_class(program, index, info.to()));
  if (info)
    for (const char* text : {info->name, info->alias, info->parent}) read_text(text);
  return status;
}

// --- files -----------------------------------------------------------------------------------------------------------

breve_status files_within(Caller& c) {
  static constexpr const char* kDirectories[] = {".", ".", "nowhere", "", "/dev/null"};
  breve_files files{};
  const bool foreign = c.chance(10);
  if (foreign) files = c.runtime_config().files, c.expect_refusal();
  const breve_files before = files;
  const char* directory = c.text_or_null(c.choose().one_of(kDirectories));
  const bool null = c.chance(3);
  if (null) c.expect_refusal();
  const std::uint64_t most = c.chance(50) ? 0 : c.word();
  const breve_status status = breve_files_add_directory(directory, false, most, null ? nullptr : &files);
  if (status != BREVE_OK) {
    require(std::memcmp(&files, &before, sizeof files) == 0, "files were changed in spite of an error");
    return status;
  }
  breve_runtime_config config = breve_runtime_config_default();
  config.files = files;
  breve_runtime* runtime = nullptr;
  if (c.chance(50)) require(breve_runtime_create(&config, &runtime) == BREVE_OK, "no runtime with files");
  require(breve_files_release(&files) == BREVE_OK, "files cannot be released");
  require(breve_runtime_destroy(runtime) == BREVE_OK, "a runtime with files cannot be destroyed");
  return status;
}
breve_status files_release(Caller& c) {
  breve_files files{};
  return breve_files_release(c.chance(50) ? nullptr : &files);
}

constexpr Statuses kCompilation = kCompile | kFile | kBusy;

constexpr Function kFunctions[] = {
    {"breve_version", version},
    {"breve_abi", abi},
    {"breve_status_name", status_name},
    {"breve_runtime_create_for", runtime_create, kUnsupported},
    {"breve_runtime_destroy", runtime_destroy, kBusy},
    {"breve_runtime_last_error", runtime_last_error, kPlain},
    {"breve_runtime_diagnostic_count", runtime_diagnostic_count, kPlain},
    {"breve_runtime_diagnostic", runtime_diagnostic, kNotFound},
    {"breve_lint_count", lint_count},
    {"breve_lint", lint, kNotFound},
    {"breve_runtime_allow_lint", runtime_allow, kNotFound | kBusy},
    {"breve_runtime_add_function", runtime_add_function, kBusy},
    {"breve_runtime_add_class", runtime_add_class, kBusy},
    {"breve_program_load", program_load, kCompilation},
    {"breve_program_compile", program_compile, kCompilation},
    {"breve_program_create_library", program_create_library, kCompilation},
    {"breve_program_destroy", program_destroy},
    {"breve_program_class_count", program_class_count, kPlain},
    {"breve_program_class", program_class, kNotFound},
    {"breve_files_add_directory", files_within, kFile},
    {"breve_files_release", files_release},
};

}  // namespace call_runtimes

std::span<const Function> runtime_functions() { return call_runtimes::kFunctions; }

std::span<const std::string_view> call_programs() {
  /// A program that calls its host back from wherever script runs.
  static constexpr std::string_view kSpeaking = R"(@path "here".
@use PhysicalControl.
@use Mobile.
@use Stationary.
@use Shape.
@use MenuItem.
@use MultiBody.
@use Link.
@use Joint.
@use Spring.
@use PatchGrid.
@use Guest.
Controller Chatter.
Mobile : Parrot (aka Parrots) {
  + variables:
    friend (object).
    words (list).
    book (hash).
    turn (matrix).
    bytes (data).
    number (int).
    real (float).
    place (vector).
    name (string).
    marks (3 ints).
  + to init:
    print "born".
    words = { 1, "two", (3, 3, 3) }.
    book{"self"} = self.
    name = "Polly".
    self set-shape to (new Sphere init-with radius 0.5).
    self move to random[(4, 4, 4)] + (0, 2, 0).
    self enable-physics.
    self handle-collisions with-type "Parrot" with-method "peck".
  + to peck other guest (object): print "peck $guest".
  + to iterate: print "flaps".
  + to destroy: print "gone".
  + to description: print "described". return "a parrot".
  + to say to other (object) text t = "hello" (string) times n = 2 (int):
    friend = other.
    push t onto words.
    print "$t $n $words". return words.
  + to recurse: self recurse.
  + to sprint: while number < 50000: number++.
  + to fail: print sqrt(-1.0), words{99}.
  + to vanish: free self.
  + to fetch: print findFile("a.txt"), system("b"), !openFileForReading("c"), !openFileForWriting("d").
}
PhysicalControl : Chatter {
  + variables:
    flock (list).
    guest, arm, hinge, tie, board, salt (object).
  + to init:
    print "hello".
    new Floor.
    guest = new Guest.
    arm = new Link.
    arm move to (8, 4, 0).
    hinge = new RevoluteJoint.
    hinge link with-normal (0, 0, 1) parent arm to-child (new Link) with-parent-point (1, 0, 0) with-child-point (-1, 0, 0).
    hinge set-strength-limit to 30.0.
    tie = new Spring.
    tie connect from arm to (new Mobile) with-length 2.0 with-strength 5.0 with-damping 0.5.
    board = ((new PatchGrid) init-with x-count 3 y-count 3 z-count 2).
    salt = ((new PatchChemical) init-with diffusion-rate 0.1 decay-rate 0.01).
    board track patch-chemical salt.
    flock = 2 new Parrots.
    flock{0} observe instance self for-notification "news" with-method "say".
    self add-menu named "Talk" for-method "talk".
    self schedule method-call "talk" at-time 0.2.
  + to talk: print "talk". guest greet.
  + to iterate: print "turn". super iterate. self announce message "news".
  + to post-iterate: print "turned".
  + to a-key-down: (new Parrot) say to self.
  + to click on item (object): print "click $item".
}
)";
  static constexpr std::array<std::string_view, 8> kPrograms = {kSpeaking,       kSpeaking,       kSpeaking,
                                                                kImageScenes[0], kImageScenes[1], kImageScenes[2],
                                                                kImageScenes[3], kImageScenes[4]};
  return kPrograms;
}

}  // namespace breve::fuzz
