// Statements from outside, run in a world that runs a program: compiled by Fragments, called like a method. While a
// fragment is needed the machine's own tables (string constants, caches of call sites) have entries for it.
#include "steve/compile/evaluate.hpp"

#include "steve/machine/machine.hpp"
#include "steve/machine/profiler.hpp"

namespace breve::steve {

namespace {

/// All that the compiler has to say; the first error gives message and place.
ErrorReport report_of(const Diagnostics& diagnostics, const Sources& sources) {
  ErrorReport report;
  for (const auto& diagnostic : diagnostics.all()) {
    if (diagnostic.severity != Severity::Error) continue;
    report.text += format(diagnostic, sources);
    if (report.text.back() != '\n') report.text += '\n';
    if (!report.message.empty()) continue;
    report.message = diagnostic.message;
    report.help = diagnostic.help;
    report.file = sources.file(diagnostic.span.file).name;
    report.line = diagnostic.span.line;
    report.column = diagnostic.span.column;
    report.length = diagnostic.span.length;
  }
  return report;
}

}  // namespace

/// While it stands, the tables have the entries of a fragment.
class Machine::FragmentScope {
 public:
  FragmentScope(Machine& machine, const Fragment& fragment)
      : machine_(machine), fragment_(fragment), strings_(machine.strings_.size()), sites_(machine.caches_.size()) {}
  ~FragmentScope() {
    for (; machine_.strings_.size() > strings_; machine_.strings_.pop_back())
      machine_.heap_->release(machine_.strings_.back());
    machine_.caches_.resize(sites_);
    if (const auto* function = fragment_.method->function.get()) machine_.reporter_.forget_locations(function->code);
    machine_.fragments_->end(fragment_);
    if (machine_.nesting_ == 0) machine_.fragments_->all_ended();
  }
  FragmentScope(const FragmentScope&) = delete;
  FragmentScope& operator=(const FragmentScope&) = delete;

  void enter() {
    const auto& code = machine_.program_->code();
    for (std::size_t i = strings_; i < code.strings.size(); ++i) {
      machine_.strings_.push_back(nullptr);
      machine_.strings_.back() = machine_.heap_->string(code.strings[i]);
      machine_.heap_->retain(machine_.strings_.back());
    }
    machine_.caches_.resize(code.sites.size());
  }

 private:
  Machine& machine_;
  const Fragment& fragment_;
  std::size_t strings_, sites_;
};

HashCell* Machine::make_session() {
  if (!session_) {
    session_ = heap_->hash();
    heap_->retain(session_);
  }
  return session_;
}

Value Machine::evaluate(Instance& self, std::string_view text) {
  if (!self.live())
    throw RunError(RunErrorKind::FreedObject, "statements are evaluated in a freed object of class " + self.cls->name);
  if (!fragments_) {
    fragments_ = std::make_unique<Fragments>(*program_);
    program_ = fragments_->program();
  }
  const Pin pin(*this, Value::of(Tag::Object, &self));  // who hears a warning may free it
  std::vector<std::string_view> known;
  if (session_)
    for (std::uint32_t i = 0; i < session_->used; ++i)
      if (session_->entries[i].live()) known.push_back(view(session_->entries[i].key.string()));
  const auto fragment = fragments_->compile(text, *self.cls, known);
  program_ = fragments_->program();
  if (profiler_) profiler_->use(program_);
  FragmentScope scope(*this, *fragment);
  if (!fragment->compiled())
    throw ScriptError(ErrorCode::Compile, report_of(fragment->diagnostics, program_->sources()));
  for (const auto& diagnostic : fragment->diagnostics.all())
    if (host_.warn) host_.warn(format(diagnostic, program_->sources()));
  scope.enter();
  const Value session[] = {Value::of(Tag::Hash, fragment->uses_session ? make_session() : nullptr)};
  const Value result = call(self, *fragment->method, session);
  return fragment->gives_value ? result : Value();
}

}  // namespace breve::steve
