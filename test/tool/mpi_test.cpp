// fmbpc study and tune over the ranks of mpirun.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "study/tuning_fixture.hpp"
#include "tool/tool_run.hpp"

namespace fpc {
namespace tool_mpi_test {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Root may run it, there may be more ranks than cores, ranks go where they like.
const std::string kMpirun = FMBPC_MPIEXEC " --allow-run-as-root --oversubscribe --bind-to none -n ";

std::string contentOf(const std::string& file) {
  std::ifstream stream(file);
  EXPECT_TRUE(stream.good()) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

class Mpi : public LoopFolder {
 protected:
  Mpi() {
    write("lag.yaml", lagLoop());
    write("good.yaml",
          "extends: lag.yaml\ncontroller:\n  loops:\n"
          "    - {input: u, output: y, kp: 1, ki_per_h: 6}\n");
    write("tuning.yaml", lagTuning());
  }
  std::string study(const std::string& out, int seeds = 9) const {
    return "study " + path("good.yaml") + " " + path("lag.yaml") +
           " --seeds 1:" + std::to_string(seeds) + " --no-plot --out " + path(out);
  }
  std::string tune(const std::string& out) const {
    return "tune " + path("lag.yaml") + " " + path("tuning.yaml") + " --no-plot --out " + path(out);
  }
  Outcome ranks(int n, const std::string& arguments) const {
    return shell(kMpirun + std::to_string(n) + " " FMBPC_MPI " " + arguments + " 2>&1");
  }
  Json studyJson(const std::string& out) const {
    Json json = Json::parse(std::ifstream(path(out) + "/study.json"));
    json.erase("resumed");
    return json;
  }
  /// Runs that the files of a study hold that was killed: whole lines only.
  std::size_t kept(const std::string& out) const {
    std::ifstream stream(path(out) + "/state.json");
    const Json state = stream.good() ? Json::parse(stream) : Json{{"runs", Json::object()}};
    const std::string lines = contentOf(path(out) + "/state.json.runs");
    const auto whole = std::count(lines.begin(), lines.end(), '\n') - 1;  // the first names it
    return state["runs"].size() + static_cast<std::size_t>(whole);
  }
  /// Kills one rank of two by SIGKILL when at least ten runs are done.
  int kill(const std::string& arguments, const std::string& out, int rank) const {
    const std::string journal = path(out) + "/state.json.runs";
    return shell(kMpirun + "2 " FMBPC_MPI " " + arguments + " >/dev/null 2>&1 & P=$!; " +
                 "while [ $(cat " + journal +
                 " 2>/dev/null | wc -l) -lt 11 ]; do kill -0 $P || "
                 "exit 9; done; set -- $(cat /proc/$P/task/$P/children); kill -9 $" +
                 std::to_string(rank + 1) + "; wait $P")
        .code;
  }
};

TEST_F(Mpi, AStudyOnOneTwoAndFourRanksIsTheSerialOne) {
  ASSERT_EQ(tool(study("serial")).code, 0);
  for (const int n : {1, 2, 4}) {
    const std::string out = "ranks" + std::to_string(n);
    const Outcome outcome = ranks(n, study(out));
    ASSERT_EQ(outcome.code, 0) << outcome.printed;
    EXPECT_EQ(contentOf(path(out) + "/runs.csv"), contentOf(path("serial") + "/runs.csv")) << n;
    EXPECT_EQ(studyJson(out), studyJson("serial")) << n;
    EXPECT_FALSE(fs::exists(path(out) + "/state.json.runs"));
  }
}

TEST_F(Mpi, ATuningOnOneTwoAndFourRanksIsTheSerialOne) {
  ASSERT_EQ(tool(tune("serial")).code, 0);
  for (const int n : {1, 2, 4}) {
    const std::string out = "ranks" + std::to_string(n);
    const Outcome outcome = ranks(n, tune(out));
    ASSERT_EQ(outcome.code, 0) << outcome.printed;
    for (const char* file : {"/history.csv", "/lag_tuned.yaml"})
      EXPECT_EQ(contentOf(path(out) + file), contentOf(path("serial") + file)) << n;
  }
}

// mpirun ends the job when a rank is killed; what was finished stands in the files.
TEST_F(Mpi, AKilledRankLosesNoFinishedRunOfAStudy) {
  constexpr int kSeeds = 300;
  ASSERT_EQ(tool(study("serial", kSeeds)).code, 0);
  for (const int rank : {0, 1}) {
    const std::string out = "killed" + std::to_string(rank);
    EXPECT_EQ(kill(study(out, kSeeds), out, rank), 137);
    const std::size_t done = kept(out);
    EXPECT_GE(done, 10U);
    EXPECT_LT(done, 2U * kSeeds);
    EXPECT_FALSE(fs::exists(path(out) + "/study.json"));
    const Outcome rest = ranks(2, study(out, kSeeds) + " --resume");
    ASSERT_EQ(rest.code, 0) << rest.printed;
    EXPECT_EQ(Json::parse(contentOf(path(out) + "/study.json"))["resumed"], done);
    EXPECT_EQ(studyJson(out), studyJson("serial"));
  }
}

TEST_F(Mpi, AKilledRankLosesNoFinishedRunOfATuning) {
  const std::string more = " --population 400 --evaluations 400";
  ASSERT_EQ(tool(tune("serial") + more).code, 0);
  EXPECT_EQ(kill(tune("killed") + more, "killed", 1), 137);
  EXPECT_FALSE(fs::exists(path("killed") + "/state.json"));  // within the first generation
  const std::string journal = contentOf(path("killed") + "/state.json.runs");
  // A cost that only the journal can know shows that finished runs are not made again.
  const std::size_t first = journal.find('\n') + 1, text = journal.find(' ', first) + 1;
  const std::string marked = journal.substr(0, text) + "{\"cost\":1e-99,\"trouble\":\"\"}" +
                             journal.substr(journal.find('\n', text));
  for (const bool mark : {false, true}) {
    fs::remove_all(path("killed"));
    fs::create_directories(path("killed"));
    std::ofstream(path("killed") + "/state.json.runs") << (mark ? marked : journal);
    const Outcome rest = ranks(2, tune("killed") + more + " --resume");
    ASSERT_EQ(rest.code, 0) << rest.printed;
    const std::string history = contentOf(path("killed") + "/history.csv");
    EXPECT_EQ(history == contentOf(path("serial") + "/history.csv"), !mark);
    EXPECT_EQ(history.find(",1e-99") != std::string::npos, mark);
  }
}

TEST_F(Mpi, MistakesAreOneLineOfTheTool) {
  for (const std::string& wrong :
       {"study " + path("nobody.yaml") + " --seeds 1:2", study("out") + " --resume",
        study("out") + " --threads 2", tune("out") + " --method nothing", std::string("run x")}) {
    const Outcome outcome = ranks(2, wrong);
    EXPECT_NE(outcome.code, 0) << wrong;
    const std::string said = "\n" + outcome.printed;
    const std::size_t first = said.find("\nfmbpc: ");
    ASSERT_NE(first, std::string::npos) << wrong << said;
    EXPECT_EQ(said.find("\nfmbpc: ", first + 1), std::string::npos) << said;
  }
}

TEST_F(Mpi, TheToolBecomesTheProgramForRanks) {
  ASSERT_EQ(tool(study("serial")).code, 0);
  const Outcome outcome = shell(kMpirun + "2 " FMBPC_TOOL " " + study("ranks") + " 2>&1");
  ASSERT_EQ(outcome.code, 0) << outcome.printed;
  EXPECT_EQ(contentOf(path("ranks") + "/runs.csv"), contentOf(path("serial") + "/runs.csv"));
  // A tool without that program beside it, as built without Open MPI.
  fs::copy_file(FMBPC_TOOL, path("alone"));
  const Outcome alone = shell("OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=0 " + path("alone") +
                              " " + study("none") + " 2>&1");
  EXPECT_EQ(alone.code, 1);
  EXPECT_NE(alone.printed.find("built without Open MPI"), std::string::npos) << alone.printed;
  EXPECT_EQ(std::count(alone.printed.begin(), alone.printed.end(), '\n'), 1);
}

}  // namespace tool_mpi_test
}  // namespace fpc
