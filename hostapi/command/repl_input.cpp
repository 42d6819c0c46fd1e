// Reading lines with GNU Readline. Readline has one line, one history and one set of callbacks for the whole process,
// and a signal handler reaches nothing but globals: so this file has some, and no other file sees them.
#include "repl_input.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>

#include <readline/history.h>
#include <readline/readline.h>

namespace breve::command {

namespace fs = std::filesystem;

namespace {

volatile std::sig_atomic_t interrupted = 0;
void (*volatile interrupt_function)(void*) = nullptr;
void* volatile interrupt_context = nullptr;

void on_interrupt(int) {
  interrupted = 1;
  if (auto* const function = interrupt_function) function(interrupt_context);
}

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;  // no SA_RESTART: reading a key ends
  sigaction(SIGINT, &action, nullptr);
}

constexpr int kHistoryEntries = 1000;

/// Where the history is kept: BREVE_HISTORY if it is set (empty: nowhere), else as the XDG directories say.
std::string history_file() {
  if (const char* file = std::getenv("BREVE_HISTORY")) return file;
  fs::path directory;
  if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state)
    directory = state;
  else if (const char* home = std::getenv("HOME"); home && *home)
    directory = fs::path(home) / ".local" / "state";
  else
    return {};
  directory /= "breve";
  std::error_code error;
  fs::create_directories(directory, error);
  return error ? std::string() : (directory / "history").string();
}

/// What readline's callbacks need.
struct Completion {
  NameSource* names = nullptr;
  std::string before;  // lines of the entry before this one
  std::vector<std::string> found;
  std::size_t next = 0;  // of `found`, to be given to readline
};
Completion completion;

char* next_match(const char*, int state) {
  if (state == 0) completion.next = 0;
  if (completion.next == completion.found.size()) return nullptr;
  return ::strdup(completion.found[completion.next++].c_str());
}

char** complete(const char* text, int, int end) {
  rl_attempted_completion_over = 1;  // no file names
  rl_completion_append_character = '\0';
  const std::string line(rl_line_buffer, static_cast<std::size_t>(end));
  try {
    completion.found = completion.names->names(completion.before + line, text);
  } catch (const std::exception&) {
    completion.found.clear();
  }
  return rl_completion_matches(text, next_match);
}

/// A key, or the end of the line that Ctrl-C abandons.
int read_key(std::FILE* stream) {
  for (;;) {
    if (interrupted) {
      rl_replace_line("", 0);
      rl_point = 0;
      return '\n';
    }
    unsigned char key = 0;
    const ssize_t size = ::read(::fileno(stream), &key, 1);
    if (size == 1) return key;
    if (size == 0 || errno != EINTR) return EOF;
  }
}

class Terminal final : public LineReader {
 public:
  explicit Terminal(NameSource& names) : file_(history_file()) {
    completion.names = &names;
    rl_readline_name = "breve";
    rl_catch_signals = 0;
    rl_getc_function = read_key;
    rl_attempted_completion_function = complete;
    // Everything but what names are made of.
    rl_basic_word_break_characters = " \t\n\"'`@$%^&*()+={}[]|\\:;,.<>/?!~#";
    rl_completer_word_break_characters = rl_basic_word_break_characters;
    rl_completer_quote_characters = "";
    using_history();
    stifle_history(kHistoryEntries);
    if (!file_.empty()) read_history(file_.c_str());
  }
  ~Terminal() override { completion.names = nullptr; }

  Reading read(bool more, std::string& line) override {
    if (!more) completion.before.clear();
    interrupted = 0;
    char* const typed = readline(more ? "| " : "> ");
    if (interrupted) {
      interrupted = 0;
      std::free(typed);
      return Reading::Abandoned;
    }
    if (!typed) {
      std::cout << std::endl;
      return Reading::End;
    }
    line = typed;
    std::free(typed);
    completion.before += line + "\n";
    return Reading::Line;
  }

  void remember(const std::string& entry) override {
    if (entry.find_first_not_of(" \t\n") == std::string::npos) return;
    const HIST_ENTRY* last = history_length > 0 ? history_get(history_base + history_length - 1) : nullptr;
    if (last && entry == last->line) return;
    add_history(entry.c_str());
    if (file_.empty()) return;
    // The input may be private.
    const mode_t mask = ::umask(077);
    if (append_history(1, file_.c_str()) != 0) write_history(file_.c_str());
    ::umask(mask);
  }

 private:
  std::string file_;
};

class Pipe final : public LineReader {
 public:
  Reading read(bool, std::string& line) override { return std::getline(std::cin, line) ? Reading::Line : Reading::End; }
  void remember(const std::string&) override {}
};

}  // namespace

std::unique_ptr<LineReader> make_line_reader(NameSource& names) {
  catch_interrupts();
  if (::isatty(STDIN_FILENO) != 0) return std::make_unique<Terminal>(names);
  return std::make_unique<Pipe>();
}

bool take_interrupt() {
  const bool was = interrupted != 0;
  interrupted = 0;
  return was;
}

void interrupts_go_to(void (*interrupt)(void* context), void* context) {
  interrupt_function = nullptr;
  interrupt_context = context;
  interrupt_function = interrupt;
}

}  // namespace breve::command
