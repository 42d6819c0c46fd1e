// The loop of `breve repl`: read an entry, run it or do what it commands, show the value.
#include "repl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "repl_names.hpp"
#include "report.hpp"
#include "session.hpp"
#include "watch.hpp"

namespace breve::command {

namespace {

constexpr const char* kHelp =
    "Statements run as in a method of the controller; the last period may be omitted. The value of an expression\n"
    "is shown. Assigning to an unknown name creates a variable of this session.\n"
    "  :step [N]         run N iterations, or one\n"
    "  :run SECONDS      run so many simulated seconds\n"
    "  :time             the current time in the world\n"
    "  :objects [CLASS]  count the objects of each class, or list those of one\n"
    "  :describe EXPR    an object with its variables, or any value with its type\n"
    "  :effects          what the simulation does, why, and the cost\n"
    "  :reload           compile the program's files again and continue with the same objects\n"
    "  :quit             leave (Ctrl-D)\n"
    "Tab completes names, Ctrl-C discards the line or stops the running statement.\n";

constexpr std::size_t kMostListed = 50;      // objects
constexpr std::size_t kLongestValue = 1000;  // bytes of a value that are shown

/// A long text keeps its beginning; a character is not cut.
std::string shortened(std::string text) {
  if (text.size() <= kLongestValue) return text;
  std::size_t end = kLongestValue;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return fmt::format("{}… ({} bytes; print shows all of them)", text.substr(0, end), text.size());
}

/// The whole class library and an empty controller.
std::string bare_program() {
  std::string text;
  for (std::size_t i = 0; i < breve_library_module_count(); ++i) {
    breve_source module;
    if (breve_library_module(i, &module) != BREVE_OK) continue;
    std::string_view name = module.name;
    if (name.starts_with("library:")) name.remove_prefix(8);
    if (name.ends_with(".tz")) name.remove_suffix(3);
    text += fmt::format("@use {}.\n", name);
  }
  return text + "Controller Repl.\nControl : Repl {\n}\n";
}

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) switch (c) {
      case '\n': out += "\\n"; break;
      case '\t': out += "\\t"; break;
      case '"': out += "\\\""; break;
      case '\\': out += "\\\\"; break;
      default: out += c;
    }
  return out + "\"";
}

const char* type_text(std::uint32_t type) {
  static constexpr const char* kNames[] = {"NULL",   "int",  "float", "vector",  "matrix", "string",
                                           "object", "list", "hash",  "pointer", "data"};
  return type < std::size(kNames) ? kNames[type] : "?";
}

/// A number, all of the text; `other` if there is no text.
template <class Number>
bool parse(std::string_view text, Number& number, Number other) {
  number = other;
  if (text.empty()) return true;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && number >= 0;
}

class Repl {
 public:
  Repl(const ReplOptions& options, Output& output)
      : options_(options),
        output_(output),
        session_(output, options.paths, options.quiet, options.strict, &options.access),
        names_(session_.runtime()) {}

  int run() {
    if (const ExitStatus status = start(); status != kEndedWell) return status;
    interrupts_go_to([](void* world) { breve_world_interrupt(static_cast<breve_world*>(world)); }, world_.get());
    const auto reader = make_line_reader(names_);
    std::string entry, line;
    while (!left_ && output_.open()) {
      output_.flush();
      const Reading reading = reader->read(!entry.empty(), line);
      if (reading == Reading::Abandoned) {
        output_.print("\n");
        entry.clear();
        continue;
      }
      if (reading == Reading::Line) entry += entry.empty() ? line : "\n" + line;
      const bool command = !entry.empty() && entry.front() == ':';
      if (reading == Reading::Line && !command && !breve_statements_complete(entry.data(), entry.size())) continue;
      reader->remember(entry);
      take_interrupt();
      if (command)
        obey(entry);
      else if (entry.find_first_not_of(" \t\r\n") != std::string::npos)
        show(entry);
      entry.clear();
      if (reading == Reading::End) break;
    }
    interrupts_go_to(nullptr, nullptr);
    return kEndedWell;
  }

 private:
  ExitStatus start() {
    ProgramHandle program;
    std::string text;
    if (options_.file.empty()) text = bare_program();
    const ExitStatus loaded =
        options_.file.empty() ? session_.compile("repl", text, program) : session_.load(options_.file, program);
    if (loaded != kEndedWell) return loaded;
    const char* arguments[] = {options_.file.c_str()};
    breve_world_config config = breve_world_config_default();
    config.seed = options_.seed.value_or(1);
    config.arguments = arguments;
    config.argument_count = 1;
    config.strict = options_.strict;
    breve_world* world = nullptr;
    if (breve_world_create(session_.runtime(), program.get(), &config, &world) != BREVE_OK) {
      const breve_error* error = breve_runtime_last_error(session_.runtime());
      output_.complain(error ? error->text : "breve: cannot make the world\n");
      return kFailed;
    }
    world_.reset(world);
    names_.use(options_.file.empty() ? "repl" : options_.file, options_.file.empty() ? &text : nullptr, world);
    if (!options_.file.empty()) reloader_.emplace(session_, output_, options_.file);
    return kEndedWell;
  }

  void complain() {
    const breve_error* error = breve_world_last_error(world_.get());
    output_.complain(error ? error->text : "breve: an unknown error\n");
  }

  std::string text_of(const breve_value& value) { return shortened(whole_text_of(value)); }

  std::string whole_text_of(const breve_value& value) {
    if (value.type == BREVE_TYPE_STRING) return quoted({value.as.string.bytes, value.as.string.size});
    const char* text = nullptr;
    std::string out = breve_value_text(world_.get(), &value, &text) == BREVE_OK ? text : "?";
    out.erase(out.find_last_not_of(' ') + 1);  // of an object without a description
    return out;
  }

  bool evaluate(std::string_view text, breve_value& value) {
    if (breve_world_evaluate(world_.get(), {}, text.data(), text.size(), &value) == BREVE_OK) return true;
    complain();
    return false;
  }

  void show(std::string_view entry) {
    breve_value value;
    if (evaluate(entry, value) && value.type != BREVE_TYPE_NULL) output_.print(text_of(value) + "\n");
  }

  // --- commands
  void obey(const std::string& entry) {
    const auto space = entry.find_first_of(" \t");
    const auto name = entry.substr(1, space == std::string::npos ? space : space - 1);
    std::string rest = space == std::string::npos ? std::string() : entry.substr(space);
    rest.erase(0, rest.find_first_not_of(" \t"));
    if (const auto last = rest.find_last_not_of(" \t"); last != std::string::npos) rest.erase(last + 1);
    if (name == "help") return output_.print(kHelp);
    if (name == "quit" || name == "q") return void(left_ = true);
    if (name == "time") return tell_time();
    if (name == "step") return step(rest);
    if (name == "run") return run_seconds(rest);
    if (name == "objects") return objects(rest);
    if (name == "describe") return describe(rest);
    if (name == "effects") return output_.print(effects_table(world_.get()));
    if (name == "reload") return reload();
    output_.complain(fmt::format("breve: there is no command :{}; :help lists them\n", name));
  }

  void tell_time() {
    const breve_world* w = world_.get();
    output_.print(fmt::format("{:g} s, iteration {}, one is {:g} s{}\n", breve_world_time(w), breve_world_iteration(w),
                              breve_world_iteration_step(w),
                              breve_world_ended(w) ? "; the program has ended the simulation" : ""));
  }

  /// Iterations until `enough`, or an error or Ctrl-C.
  template <class Enough>
  void iterate(Enough enough) {
    while (!enough()) {
      if (take_interrupt()) return output_.complain("breve: interrupted\n");
      if (breve_world_step(world_.get()) != BREVE_OK) return complain();
      output_.flush_sometimes();
    }
    tell_time();
  }

  void step(const std::string& rest) {
    std::uint64_t left = 1;
    if (!parse<std::uint64_t>(rest, left, 1)) return output_.complain("breve: :step takes a number of iterations\n");
    iterate([&] { return left-- == 0; });
  }

  void run_seconds(const std::string& rest) {
    double seconds = 0;
    if (rest.empty() || !parse<double>(rest, seconds, 0))
      return output_.complain("breve: :run takes a number of seconds\n");
    constexpr double kRounding = 1e-6;  // of a step
    const breve_world* w = world_.get();
    const double end = breve_world_time(w) + seconds;
    iterate(
        [&] { return breve_world_ended(w) || breve_world_time(w) >= end - kRounding * breve_world_iteration_step(w); });
  }

  void objects(const std::string& cls) {
    std::size_t count = 0;
    const char* filter = cls.empty() ? nullptr : cls.c_str();
    if (breve_world_objects(world_.get(), filter, nullptr, 0, &count) != BREVE_OK) return complain();
    std::vector<breve_object> all(count);
    breve_world_objects(world_.get(), filter, all.data(), count, &count);
    if (cls.empty()) {
      std::vector<std::pair<std::string, std::size_t>> classes;  // in order of the first object
      for (const auto object : all) {
        const std::string name = breve_object_class(world_.get(), object);
        const auto at = std::find_if(classes.begin(), classes.end(), [&](const auto& c) { return c.first == name; });
        if (at == classes.end())
          classes.emplace_back(name, 1);
        else
          ++at->second;
      }
      for (const auto& [name, number] : classes) output_.print(fmt::format("{:>7} {}\n", number, name));
      return;
    }
    for (std::size_t i = 0; i < all.size() && i < kMostListed; ++i) output_.print(line_about(all[i]) + "\n");
    if (all.size() > kMostListed) output_.print(fmt::format("... and {} more\n", all.size() - kMostListed));
  }

  std::string line_about(breve_object object) {
    const breve_value value = breve_value_object(object);
    std::string line = text_of(value);
    breve_pose pose;
    if (breve_object_pose(world_.get(), object, &pose) == BREVE_OK)
      line += fmt::format(" at ({:g}, {:g}, {:g})", pose.location[0], pose.location[1], pose.location[2]);
    return line;
  }

  void describe(const std::string& text) {
    breve_value value;
    if (!evaluate(text.empty() ? "self" : text, value)) return;
    const auto object = value.as.object;
    if (value.type != BREVE_TYPE_OBJECT || !breve_object_alive(world_.get(), object))
      return output_.print(fmt::format("{}: {}\n", type_text(value.type), text_of(value)));
    output_.print(line_about(object) + "\n");
    for (const auto& cls : names_.line_of(breve_object_class(world_.get(), object))) {
      output_.print(fmt::format("  {}\n", cls));
      for (const auto& name : names_.variables(cls)) {
        breve_value held;
        const breve_status status = breve_object_get(world_.get(), object, name.c_str(), &held);
        if (status == BREVE_OK)
          output_.print(fmt::format("    {} = {}\n", name, text_of(held)));
        else if (status == BREVE_ERROR_UNSUPPORTED)
          output_.print(fmt::format("    {} (an array)\n", name));
      }
    }
  }

  void reload() {
    if (!reloader_) return output_.complain("breve: there is no file to reload: breve repl FILE\n");
    if (reloader_->reload(world_.get())) names_.use(options_.file, nullptr, world_.get());
  }

  const ReplOptions& options_;
  Output& output_;
  Session session_;
  ProgramNames names_;
  WorldHandle world_;
  std::optional<Reloader> reloader_;
  bool left_ = false;
};

}  // namespace

int repl(const ReplOptions& options, Output& output) { return Repl(options, output).run(); }

}  // namespace breve::command
