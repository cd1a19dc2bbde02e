#include "study/study_state.hpp"

#include <fstream>

#include "base/files.hpp"
#include "base/finite_json.hpp"
#include "base/ordered_json.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Json = OrderedJson;

Json toJson(const RunJudgement& run) {
  return {{"cost", numberOrNull(run.cost)},
          {"move", numberOrNull(run.move)},
          {"least", numberOrNull(run.least)},
          {"largest_move", numberOrNull(run.largest_move)},
          {"failures", run.failures},
          {"trajectory", run.trajectory},
          {"trouble", run.trouble}};
}

RunJudgement runOf(const Json& json) {
  RunJudgement run;
  run.cost = numberOrInfinity(json.at("cost"));
  run.move = numberOrInfinity(json.at("move"));
  run.least = numberOrInfinity(json.at("least"));
  run.largest_move = numberOrInfinity(json.at("largest_move"));
  run.failures = json.at("failures").get<std::vector<std::uint64_t>>();
  run.failures.resize(kRunFailures, 0);
  run.trajectory = json.at("trajectory").get<std::uint64_t>();
  run.trouble = json.at("trouble");
  return run;
}

}  // namespace

std::string textOf(const RunJudgement& run) { return toJson(run).dump(); }

RunJudgement judgementOf(const std::string& text) { return runOf(Json::parse(text)); }

void writeStudyState(const std::string& file, const std::string& fingerprint,
                     const std::vector<std::optional<RunJudgement>>& runs) {
  Json done = Json::object();
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (runs[i]) done[std::to_string(i)] = toJson(*runs[i]);
  const Json json{{"study", fingerprint}, {"runs", done}};
  writeText(json.dump() + "\n", file);
}

std::vector<std::optional<RunJudgement>> readStudyState(const std::string& file,
                                                        const std::string& fingerprint,
                                                        std::size_t runs) {
  std::ifstream stream(file);
  require(stream.good(), file, "a readable file, as a stopped `fmbpc study --out` leaves it");
  try {
    const Json json = Json::parse(stream);
    require(json.at("study") == fingerprint, file,
            "the state of this study: loops, seeds and options as they were when it stopped, and "
            "so the files that the loops name");
    std::vector<std::optional<RunJudgement>> done(runs);
    for (const auto& [index, run] : json.at("runs").items()) {
      const std::size_t at = std::stoul(index);
      require(at < runs, file, "runs of this study");
      done[at] = runOf(run);
    }
    return done;
  } catch (const Json::exception& e) {
    throw InputError(file + ": expected the state of a study: " + e.what());
  }
}

}  // namespace fpc
