#include "tool/study_report.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/finite_json.hpp"
#include "base/ordered_json.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "tool/tune_report.hpp"

namespace fpc::tool {
namespace {

using Json = OrderedJson;
using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t kNamedCases = 12;
constexpr const char* kLoopLegend =
    "cost: the study's fitness of a run; move: mean of all inputs and samples, as a share of their "
    "ranges, median of the runs;\nlargest move: of any input in a sample, in its unit; least: of "
    "the output that is judged first; the rest: runs in which that happened\n";
constexpr const char* kPairLegend =
    "won: cases with the lower cost (a tie is a half); ratio: cost / cost of the loop it stands "
    "against, below 1 is better\n";

Json failuresJson(const LoopStatistics& loop) {
  Json json = Json::object();
  for (std::size_t f = 0; f < loop.failures.size(); ++f)
    json[wordOf(static_cast<RunFailure>(f))] = loop.failures[f];
  return json;
}

Json loopJson(const LoopStatistics& loop) {
  return {{"name", loop.name},
          {"runs", loop.runs},
          {"median", numberOrNull(loop.median)},
          {"lower_quartile", numberOrNull(loop.lower_quartile)},
          {"upper_quartile", numberOrNull(loop.upper_quartile)},
          {"worst", numberOrNull(loop.worst)},
          {"worst_case", loop.worst_case},
          {"median_move", numberOrNull(loop.median_move)},
          {"largest_move", numberOrNull(loop.largest_move)},
          {"least", numberOrNull(loop.least)},
          {"failures", failuresJson(loop)},
          {"failing_cases", loop.failing_cases},
          {"trouble", loop.trouble}};
}

Json pairJson(const PairStatistics& pair) {
  return {{"name", pair.name},
          {"against", pair.against},
          {"pairs", pair.pairs},
          {"wins", pair.wins},
          {"share", numberOrNull(pair.share)},
          {"share_interval", {numberOrNull(pair.lower), numberOrNull(pair.upper)}},
          {"median_ratio", numberOrNull(pair.median_ratio)},
          {"ratio_interval", {numberOrNull(pair.ratio_lower), numberOrNull(pair.ratio_upper)}}};
}

Json runJson(const StudyPlan& plan, std::size_t index, const RunJudgement& run) {
  return {{"loop", plan.study().loops[plan.loopOf(index)].name},
          {"case", plan.cases()[plan.caseOf(index)].name},
          {"cost", numberOrNull(run.cost)},
          {"move", numberOrNull(run.move)},
          {"least", numberOrNull(run.least)},
          {"largest_move", numberOrNull(run.largest_move)},
          {"failures", run.failures}};
}

std::string interval(double lower, double upper) {
  return shortText(lower) + ".." + shortText(upper);
}

/// "none (n < 6)" where too few pairs are there.
std::string medianText(const PairStatistics& pair, double confidence) {
  if (!std::isnan(pair.ratio_lower)) return interval(pair.ratio_lower, pair.ratio_upper);
  return "none (n < " + std::to_string(casesForMedianInterval(confidence)) + ")";
}

std::string percentText(double share) { return shortText(100.0 * share) + " %"; }

Rows loopRows(const StudyStatistics& statistics) {
  Rows rows{{"loop", "runs", "median cost", "quartiles", "worst", "worst case", "move",
             "largest move", "least", "diverged", "locked", "violated", "held", "out of model"}};
  for (const auto& loop : statistics.loops) {
    std::vector<std::string> row{loop.name,
                                 std::to_string(loop.runs),
                                 shortText(loop.median),
                                 interval(loop.lower_quartile, loop.upper_quartile),
                                 shortText(loop.worst),
                                 loop.worst_case,
                                 shortText(loop.median_move),
                                 shortText(loop.largest_move),
                                 shortText(loop.least)};
    for (const std::size_t count : loop.failures) row.push_back(std::to_string(count));
    rows.push_back(std::move(row));
  }
  return rows;
}

Rows pairRows(const StudyPlan& plan, const StudyStatistics& statistics) {
  const std::string sure = std::to_string(plan.study().confidence_percent) + " %";
  Rows rows{
      {"pairs", "against", "n", "won", "share", "its " + sure, "median ratio", "its " + sure}};
  for (const auto& pair : statistics.pairs)
    rows.push_back(
        {pair.name, pair.against, std::to_string(pair.pairs), shortText(pair.wins),
         percentText(pair.share), percentText(pair.lower) + ".." + percentText(pair.upper),
         shortText(pair.median_ratio), medianText(pair, 0.01 * plan.study().confidence_percent)});
  return rows;
}

}  // namespace

Json toJson(const StudyPlan& plan, const StudyResult& result, const StudyStatistics& statistics) {
  Json json{{"study", std::filesystem::path(plan.study().file).stem().string()},
            {"title", plan.study().title},
            {"complete", result.complete},
            {"resumed", result.resumed},
            {"cases", plan.cases().size()},
            {"loops", Json::array()},
            {"pairs", Json::array()},
            {"runs", Json::array()}};
  for (const auto& loop : statistics.loops) json["loops"].push_back(loopJson(loop));
  for (const auto& pair : statistics.pairs) json["pairs"].push_back(pairJson(pair));
  for (std::size_t i = 0; i < result.runs.size(); ++i)
    if (result.runs[i]) json["runs"].push_back(runJson(plan, i, *result.runs[i]));
  return json;
}

std::string toTable(const StudyPlan& plan, const StudyResult& result,
                    const StudyStatistics& statistics) {
  std::string text = plan.study().title.empty() ? "" : plan.study().title + "\n\n";
  text += alignedTable(loopRows(statistics));
  text += kLoopLegend;
  if (!statistics.pairs.empty())
    text += "\n" + alignedTable(pairRows(plan, statistics)) + kPairLegend;
  for (const auto& loop : statistics.loops) {
    if (loop.failing_cases.empty()) continue;
    std::vector<std::string> named = loop.failing_cases;
    const std::size_t more = named.size() > kNamedCases ? named.size() - kNamedCases : 0;
    named.resize(named.size() - more);
    text += "\n" + loop.name + " failed in: " + join(named) +
            (more > 0 ? " and " + std::to_string(more) + " more" : "") + "\n";
    if (!loop.trouble.empty()) text += loop.name + ": " + loop.trouble + "\n";
  }
  if (!result.complete) text += "\nnot complete\n";
  return text;
}

void writeRuns(const StudyPlan& plan, const StudyResult& result, const std::string& file) {
  std::ofstream stream(file);
  stream << "loop,case,cost,move,least,largest_move";
  for (int f = 0; f < kRunFailures; ++f) stream << "," << wordOf(static_cast<RunFailure>(f));
  for (const auto& variation : plan.study().vary) stream << "," << variation.key;
  stream << "\n";
  for (std::size_t i = 0; i < result.runs.size(); ++i) {
    if (!result.runs[i]) continue;
    const RunJudgement& run = *result.runs[i];
    const StudyCase& one = plan.cases()[plan.caseOf(i)];
    stream << "\"" << plan.study().loops[plan.loopOf(i)].name << "\",\"" << one.name << "\"";
    for (const double value : {run.cost, run.move, run.least, run.largest_move})
      stream << "," << exactText(value);
    for (const auto count : run.failures) stream << "," << count;
    for (const double value : one.drawn) stream << "," << exactText(value);
    stream << "\n";
  }
  stream.close();
  require(!stream.fail(), file, "a writable file");
}

}  // namespace fpc::tool
