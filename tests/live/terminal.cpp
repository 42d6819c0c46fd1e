// `breve repl` on a terminal: what is typed at the other end of a pseudo-terminal is edited, completed and remembered.
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

namespace fs = std::filesystem;

class Terminal {
 public:
  explicit Terminal(const fs::path& home) {
    child_ = ::forkpty(&end_, nullptr, nullptr, nullptr);
    if (child_ != 0) return;
    ::setenv("HOME", home.c_str(), 1);
    ::setenv("TERM", "dumb", 1);
    ::setenv("INPUTRC", "/dev/null", 1);
    ::unsetenv("XDG_STATE_HOME");
    ::unsetenv("BREVE_HISTORY");
    const char* breve = std::getenv("BREVE");
    ::execl(breve, breve, "repl", "--quiet", (home / "a.tz").c_str(), nullptr);
    ::_exit(127);
  }
  ~Terminal() {
    ::kill(child_, SIGKILL);
    ::close(end_);
    if (!waited_) ::waitpid(child_, nullptr, 0);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void type(const std::string& keys) {
    seen_ = text_.size();
    ASSERT_EQ(::write(end_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }

  /// Does `wanted` appear behind what was there when something was typed last? Generous: the machine may be busy.
  bool shows(const std::string& wanted) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (text_.find(wanted, seen_) == std::string::npos) {
      pollfd wait{end_, POLLIN, 0};
      if (std::chrono::steady_clock::now() > end) return false;
      if (::poll(&wait, 1, 1000) <= 0) continue;
      char bytes[4096];
      const ssize_t size = ::read(end_, bytes, sizeof bytes);
      if (size <= 0) return text_.find(wanted, seen_) != std::string::npos;
      text_.append(bytes, static_cast<std::size_t>(size));
    }
    return true;
  }

  /// The same, and then the prompt: keys typed before that would be read by a terminal that is not set up for them.
  bool answers(const std::string& wanted) {
    if (!shows(wanted)) return false;
    seen_ = text_.find(wanted, seen_) + wanted.size();
    return shows("> ");
  }

  int leave() {
    type("\x04");
    int status = -1;
    while (shows("no such text")) continue;
    ::waitpid(child_, &status, 0);
    waited_ = true;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  const std::string& text() const { return text_; }

 private:
  int end_ = -1;
  pid_t child_ = -1;
  bool waited_ = false;
  std::string text_;
  std::size_t seen_ = 0;
};

class Repl : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "breve-live-XXXXXX").string();
    home_ = ::mkdtemp(name.data());
    std::ofstream(home_ / "a.tz") << "@use Control.\nController Main.\nControl : Main {\n"
                                     "  + variables: turns (int).\n"
                                     "  + to say-something-rare with-loudness l (int): return l + turns.\n"
                                     "}\n";
  }
  void TearDown() override { fs::remove_all(home_); }
  fs::path home_;
};

TEST_F(Repl, CompletesSelectorsKeywordsVariablesAndSessionVariables) {
  Terminal terminal(home_);
  ASSERT_TRUE(terminal.shows("> ")) << terminal.text();
  terminal.type("self say-some\t");
  EXPECT_TRUE(terminal.shows("say-something-rare")) << terminal.text();
  terminal.type(" with-lou\t");
  EXPECT_TRUE(terminal.shows("with-loudness")) << terminal.text();
  terminal.type(" 40 + 2.\n");
  EXPECT_TRUE(terminal.answers("42")) << terminal.text();
  terminal.type("remarkable = 7.\n");
  EXPECT_TRUE(terminal.answers("\n7")) << terminal.text();
  terminal.type("remark\t + 1\n");
  EXPECT_TRUE(terminal.answers("8")) << terminal.text();
  terminal.type("tur\t + 5\n");
  EXPECT_TRUE(terminal.answers("\n5")) << terminal.text();
  terminal.type(":ti\t\n");
  EXPECT_TRUE(terminal.answers("iteration 0")) << terminal.text();
  EXPECT_EQ(terminal.leave(), 0) << terminal.text();
}

TEST_F(Repl, AsksForMoreLines) {
  Terminal terminal(home_);
  ASSERT_TRUE(terminal.shows("> "));
  terminal.type("if turns == 0: {\n");
  EXPECT_TRUE(terminal.shows("| ")) << terminal.text();
  terminal.type("print \"in\" + \"side\".\n}\n");
  EXPECT_TRUE(terminal.answers("inside")) << terminal.text();
  EXPECT_EQ(terminal.leave(), 0);
}

TEST_F(Repl, CtrlCAbandonsTheLineAndStopsWhatRuns) {
  Terminal terminal(home_);
  ASSERT_TRUE(terminal.shows("> "));
  terminal.type("x = { 1,\n");
  EXPECT_TRUE(terminal.shows("| ")) << terminal.text();
  terminal.type("2, 3\x03");
  EXPECT_TRUE(terminal.shows("> ")) << terminal.text();
  terminal.type("print \"begun\". while 1: turns += 1.\n");
  EXPECT_TRUE(terminal.shows("begun\r\n")) << terminal.text();
  terminal.type("\x03");
  EXPECT_TRUE(terminal.answers("interrupted")) << terminal.text();
  terminal.type("20 + 1\n");
  EXPECT_TRUE(terminal.answers("21")) << terminal.text();
  EXPECT_EQ(terminal.leave(), 0) << terminal.text();
}

TEST_F(Repl, RemembersWhatWasTypedInEarlierSessions) {
  {
    Terminal terminal(home_);
    ASSERT_TRUE(terminal.shows("> "));
    terminal.type("111 + 222\n");
    EXPECT_TRUE(terminal.answers("333"));
    EXPECT_EQ(terminal.leave(), 0);
  }
  const fs::path history = home_ / ".local" / "state" / "breve" / "history";
  ASSERT_TRUE(fs::exists(history));
  EXPECT_EQ(fs::status(history).permissions() & fs::perms::others_all, fs::perms::none);
  Terminal terminal(home_);
  ASSERT_TRUE(terminal.shows("> "));
  terminal.type("\x10");  // Ctrl-P: the line before
  EXPECT_TRUE(terminal.shows("111 + 222")) << terminal.text();
  terminal.type("\n");
  EXPECT_TRUE(terminal.answers("333")) << terminal.text();
  EXPECT_EQ(terminal.leave(), 0);
}

}  // namespace
