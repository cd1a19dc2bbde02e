#include "study/tune_state.hpp"

#include <fstream>

#include "base/files.hpp"
#include "base/finite_json.hpp"
#include "base/ordered_json.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Json = OrderedJson;

Json numbers(const double* values, std::size_t n) {
  Json list = Json::array();
  for (std::size_t i = 0; i < n; ++i) list.push_back(numberOrNull(values[i]));
  return list;
}

TuningStep stepOf(const Json& json) {
  TuningStep step;
  const Json& shares = json.at("shares");
  step.shares.resize(static_cast<Eigen::Index>(shares.size()));
  for (std::size_t i = 0; i < shares.size(); ++i)
    step.shares[static_cast<Eigen::Index>(i)] = numberOrInfinity(shares[i]);
  for (const Json& cost : json.at("scenarios")) step.scenarios.push_back(numberOrInfinity(cost));
  step.cost = numberOrInfinity(json.at("cost"));
  step.failures = json.at("failures");
  return step;
}

}  // namespace

std::string identityOf(const TuningObjective& objective, const SearchParams& search) {
  std::string text = objective.fingerprint() + " " + wordOf(search.method) + " " +
                     std::to_string(search.population) + " " + std::to_string(search.evaluations) +
                     " " + std::to_string(search.seed);
  for (const double value : {search.cognitive, search.social, search.speed_upper, search.inertia,
                             search.inertia_start, search.inertia_end, search.differential_weight,
                             search.crossover, static_cast<double>(search.variant), search.step})
    text += " " + exactText(value);
  return text;
}

void writeState(const std::string& file, const std::string& identity, const TuneState& state) {
  Json steps = Json::array();
  for (const auto& step : state.steps)
    steps.push_back(
        {{"shares", numbers(step.shares.data(), static_cast<std::size_t>(step.shares.size()))},
         {"cost", numberOrNull(step.cost)},
         {"scenarios", numbers(step.scenarios.data(), step.scenarios.size())},
         {"failures", step.failures}});
  const Json json{{"tuning", identity}, {"seconds", state.seconds}, {"evaluations", steps}};
  writeText(json.dump() + "\n", file);
}

TuneState parseState(const std::string& text, const std::string& file,
                     const std::string& identity) {
  try {
    const Json json = Json::parse(text);
    require(json.at("tuning") == identity, file,
            "the state of this tuning: loop, tuning file, method, seed, population and evaluations "
            "as they were when it stopped, and so the files that the loop names");
    TuneState state;
    state.seconds = json.at("seconds");
    for (const Json& step : json.at("evaluations")) state.steps.push_back(stepOf(step));
    return state;
  } catch (const Json::exception& e) {
    throw InputError(file + ": expected the state of a tuning: " + e.what());
  }
}

}  // namespace fpc
