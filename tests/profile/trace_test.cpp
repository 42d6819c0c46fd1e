// What `breve run --trace` and `--profile` write, read as a viewer reads it.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kProgram = R"(@use Control.
Controller Main.
Control : Main {
  + variables:
    helper (object).
  + to init:
    helper = new Helper.
  + to iterate:
    self think-hard.
    if (self get-time) > 0.5: helper fail.
    super iterate.
  + to think-hard:
    helper count to 20.
    print sqrt(2.0).
}
Object : Helper {
  + to count to n (int):
    i (int).
    for i = 0, i < n, i++: self tick.
  + to tick:
    return 1.
  + to fail:
    die "enough".
}
)";
constexpr int kIterateLine = 8, kThinkCall = 9, kThinkLine = 12, kCountCall = 13, kFailCall = 10;

class TraceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("breve-trace-" + std::string(info->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(folder_ / "a \"quoted\" name.tz") << kProgram;
    std::ofstream(folder_ / "p.tz") << kProgram;
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Exit status of the command in the folder; its output in out and err.
  int run(const std::string& arguments) const {
    const int status =
        std::system(("cd '" + folder_.string() + "' && '" BREVE_COMMAND "' run " + arguments + " >out 2>err").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string text(const std::string& file) const {
    std::ifstream in(folder_ / file);
    std::stringstream all;
    all << in.rdbuf();
    return all.str();
  }
  json trace() const { return json::parse(text("t.json")); }
  /// The trace of a run that was killed in the middle of a write, perhaps: then its last line is not an event.
  json killed_trace() const {
    const std::string all = text("t.json");
    return json::parse(json::accept(all) ? all : all.substr(0, all.rfind(",\n")) + "]}");
  }
  /// The calls of a trace by name, once it is known that they nest.
  static std::map<std::string, std::vector<json>> calls(const json& trace) {
    std::map<std::string, std::vector<json>> result;
    std::vector<json> sorted;
    for (const auto& event : trace["traceEvents"]) {
      if (event["ph"] != "X") continue;
      EXPECT_TRUE(event["ts"].is_number() && event["dur"].is_number());
      EXPECT_GE(event["dur"].get<double>(), 0);
      EXPECT_EQ(event["pid"], 1);
      EXPECT_EQ(event["tid"], 1);
      result[event["name"]].push_back(event);
      sorted.push_back(event);
    }
    std::stable_sort(sorted.begin(), sorted.end(), [](const json& a, const json& b) {
      return a["ts"] != b["ts"] ? a["ts"] < b["ts"] : a["dur"] > b["dur"];
    });
    constexpr double kRounding = 0.0021;  // µs: each number is rounded to a thousandth
    std::vector<double> ends;
    for (const auto& event : sorted) {
      const double begin = event["ts"], end = begin + event["dur"].get<double>();
      while (!ends.empty() && ends.back() <= begin + kRounding) ends.pop_back();
      if (!ends.empty()) {
        EXPECT_LE(end, ends.back() + kRounding) << event;
      }
      ends.push_back(end);
    }
    return result;
  }

  fs::path folder_;
};

TEST_F(TraceTest, CallsNestAndNameTheirLines) {
  ASSERT_EQ(run("p.tz --iterations 4 --seed 1 --trace t.json"), 0) << text("err");
  const auto by_name = calls(trace());
  ASSERT_EQ(by_name.count("Main.iterate"), 1U);
  EXPECT_EQ(by_name.at("Main.iterate").size(), 4U);
  EXPECT_EQ(by_name.at("Main.iterate")[0]["args"]["declared"], "p.tz:" + std::to_string(kIterateLine));
  const auto& think = by_name.at("Main.think-hard");
  EXPECT_EQ(think.size(), 4U);
  EXPECT_EQ(think[0]["cat"], "method");
  EXPECT_EQ(think[0]["args"]["declared"], "p.tz:" + std::to_string(kThinkLine));
  EXPECT_EQ(think[0]["args"]["called"], "p.tz:" + std::to_string(kThinkCall));
  EXPECT_EQ(by_name.at("Helper.count")[0]["args"]["called"], "p.tz:" + std::to_string(kCountCall));
  EXPECT_EQ(by_name.at("Helper.tick").size(), 80U);
  EXPECT_EQ(by_name.at("new Helper")[0]["cat"], "act");
  EXPECT_EQ(by_name.at("sqrt").size(), 4U);
  EXPECT_EQ(by_name.at("sqrt")[0]["cat"], "function");
}

TEST_F(TraceTest, IterationsAreMarkedAndTheThreadIsNamed) {
  ASSERT_EQ(run("p.tz --iterations 3 --seed 1 --trace t.json"), 0) << text("err");
  const auto t = trace();
  const auto by_name = calls(t);
  ASSERT_EQ(by_name.at("iteration").size(), 3U);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(by_name.at("iteration")[static_cast<std::size_t>(i)]["args"]["iteration"], i);
  std::map<std::string, json> names;
  for (const auto& event : t["traceEvents"])
    if (event["ph"] == "M") names[event["name"]] = event["args"]["name"];
  EXPECT_EQ(names["thread_name"], "world");
  EXPECT_EQ(names["process_name"], "breve run p.tz");
}

TEST_F(TraceTest, AnErrorLeavesAWholeFile) {
  ASSERT_EQ(run("p.tz --seed 1 --trace t.json --profile=p.txt"), 1);
  const auto by_name = calls(trace());
  ASSERT_EQ(by_name.at("Helper.fail").size(), 1U);
  EXPECT_EQ(by_name.at("Helper.fail")[0]["args"]["called"], "p.tz:" + std::to_string(kFailCall));
  EXPECT_EQ(by_name.at("Main.iterate").size(), by_name.at("iteration").size());
  EXPECT_NE(text("p.txt").find("Helper.fail"), std::string::npos);
  EXPECT_NE(text("err").find("enough"), std::string::npos);
}

TEST_F(TraceTest, ARunThatIsKilledLeavesAFileToRead) {
  std::string program = kProgram;
  program.replace(program.find("> 0.5"), 5, "> 1e9");
  std::ofstream(folder_ / "p.tz") << program;
  // The first interrupt ends the run after its iteration; a kill gives no time for anything.
  const std::string wait_for_some = "while [ $(wc -c <t.json) -lt 300000 ]; do sleep 0.05; done; ";
  for (const std::string signal : {"INT", "KILL"}) {
    const std::string script = "cd '" + folder_.string() +
                               "' && rm -f t.json && touch t.json && { '" BREVE_COMMAND
                               "' run p.tz --seed 1 --trace t.json >out 2>err & } && " +
                               wait_for_some + "kill -" + signal + " $!; wait $!; true";
    ASSERT_EQ(std::system(script.c_str()), 0);
    EXPECT_GT(calls(signal == "INT" ? trace() : killed_trace()).at("Main.iterate").size(), 10U) << signal;
  }
}

TEST_F(TraceTest, AFullTraceIsCutWithAWord) {
  ASSERT_EQ(run("p.tz --iterations 8 --seed 1 --trace t.json --trace-limit 0"), 0);
  EXPECT_TRUE(calls(trace()).empty());
  EXPECT_NE(text("err").find("--trace-limit"), std::string::npos);
  EXPECT_EQ(run("p.tz --iterations 8 --seed 1 --trace-limit 1"), 2);
}

TEST_F(TraceTest, NamesOfFilesAreEscaped) {
  ASSERT_EQ(run("'a \"quoted\" name.tz' --iterations 1 --seed 1 --trace t.json"), 0) << text("err");
  EXPECT_EQ(calls(trace()).at("Main.iterate")[0]["args"]["declared"],
            "a \"quoted\" name.tz:" + std::to_string(kIterateLine));
}

TEST_F(TraceTest, AFileThatCannotBeWrittenIsAnError) {
  EXPECT_EQ(run("p.tz --iterations 1 --seed 1 --trace nowhere/t.json"), 1);
  EXPECT_NE(text("err").find("nowhere/t.json"), std::string::npos);
  EXPECT_EQ(run("p.tz --iterations 1 --seed 1 --profile=nowhere/p.txt"), 1);
  EXPECT_NE(text("err").find("nowhere/p.txt"), std::string::npos);
}

TEST_F(TraceTest, AProfileShowsTheTreeTheMethodsAndTheLines) {
  // Enough work that nothing else can hide it, whatever else the machine does.
  std::string program = kProgram;
  program.replace(program.find("to 20."), 6, "to 20000.");
  std::ofstream(folder_ / "p.tz") << program;
  ASSERT_EQ(run("p.tz --iterations 8 --seed 1 --profile"), 0);
  const std::string err = text("err");
  EXPECT_EQ(err.rfind("Profile of p.tz: 8 iterations", 0), 0U) << err;
  for (const char* part : {"100.0", "[iteration]", "Main.think-hard", "p.tz:12, from p.tz:9", "Hottest",
                           "Lines with the most expensive calls", "p.tz:13", "Helper.count"})
    EXPECT_NE(err.find(part), std::string::npos) << part << "\n" << err;
  EXPECT_EQ(text("out").find("Hottest"), std::string::npos);
}

TEST_F(TraceTest, ProfilesAndTracesChangeNeitherOutputNorHash) {
  ASSERT_EQ(run("p.tz --iterations 8 --seed 1 --hash"), 0);
  const std::string plain = text("out");
  ASSERT_EQ(run("p.tz --iterations 8 --seed 1 --hash --profile=p.txt --trace t.json"), 0);
  EXPECT_EQ(text("out"), plain);
}

}  // namespace
