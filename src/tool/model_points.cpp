#include "tool/model_points.hpp"

#include <algorithm>
#include <cmath>

#include "base/list_of.hpp"
#include "fmbpc/base/text.hpp"
#include "model/operating_points.hpp"
#include "tool/figures_json.hpp"

namespace fpc::tool {
namespace {

using Eigen::Index;
using Json = OrderedJson;
using Row = std::vector<std::string>;

constexpr std::size_t kMostShown = 3;  // poles, time constants

std::string valuesText(const std::vector<SignalInfo>& signals, const Vector& values) {
  Row words;
  for (std::size_t i = 0; i < signals.size(); ++i)
    words.push_back(signals[i].name + " " + shortText(values[static_cast<Index>(i)]));
  return join(words);
}

std::string polesText(const OperatingPoint& point) {
  Row words;
  for (const auto& pole : point.poles) {
    if (pole.imag() < 0.0 || words.size() >= kMostShown) continue;
    words.push_back(shortText(pole.real()) +
                    (pole.imag() > 0.0 ? "+-" + shortText(pole.imag()) + "i" : ""));
  }
  return words.empty() ? "-" : join(words, " ");
}

std::string timesText(const OperatingPoint& point) {
  Row words;
  for (std::size_t i = 0; i < std::min(kMostShown, point.time_constants_s.size()); ++i)
    words.push_back(shortText(point.time_constants_s[i]));
  return words.empty() ? "-" : join(words, " ");
}

}  // namespace

std::string pointsTable(const TsModel& model) {
  const auto points = operatingPoints(model);
  if (points.empty()) return "";
  const Eigen::MatrixXi dead = deadTimes(model);
  std::vector<Row> rows{{"point", "output", "rests at", "gains", "time constants [s]", "poles"}};
  for (const auto& p : points)
    for (std::size_t i = 0; i < model.outputs.size(); ++i) {
      const auto y = static_cast<Index>(i);
      Row gains;
      for (std::size_t j = 0; j < model.inputs.size(); ++j)
        if (dead(y, static_cast<Index>(j)) >= 0)
          gains.push_back(model.inputs[j].name + " " +
                          shortText(p.gains(y, static_cast<Index>(j))));
      rows.push_back({i == 0 ? p.name : "", model.outputs[i].name,
                      p.rests ? shortText(p.outputs[y]) : "no rest", join(gains),
                      i == 0 ? timesText(p) : "", i == 0 ? polesText(p) : ""});
    }
  std::vector<Row> times{{"dead time [s]"}};
  for (const auto& u : model.inputs) times.front().push_back(u.name);
  for (std::size_t i = 0; i < model.outputs.size(); ++i) {
    Row& row = times.emplace_back(Row{model.outputs[i].name});
    for (Index j = 0; j < dead.cols(); ++j) {
      const int samples = dead(static_cast<Index>(i), j);
      row.push_back(samples < 0 ? "-" : shortText((samples - 1) * model.sample_time_s));
    }
  }
  std::string text = alignedTable(rows) + "(linearised at rest; middle: " +
                     valuesText(model.inputs, points.front().inputs) + ")\n";
  if (model.inputs.empty()) return text;
  return text + "\n" + alignedTable(times) + "(beyond the sample in which an input is held)\n";
}

Json pointsJson(const TsModel& model) {
  Json all = Json::array();
  const Eigen::MatrixXi dead = deadTimes(model);
  for (const auto& p : operatingPoints(model)) {
    Json point{{"name", p.name}, {"rests", p.rests}};
    for (std::size_t j = 0; j < model.inputs.size(); ++j)
      point["inputs"][model.inputs[j].name] = p.inputs[static_cast<Index>(j)];
    point["poles"] = Json::array();
    for (const auto& pole : p.poles) point["poles"].push_back({pole.real(), pole.imag()});
    point["time_constants_s"] = p.time_constants_s;
    for (std::size_t i = 0; i < model.outputs.size(); ++i) {
      const auto y = static_cast<Index>(i);
      const std::string& output = model.outputs[i].name;
      point["outputs"][output] = p.outputs[y];
      for (std::size_t j = 0; j < model.inputs.size(); ++j) {
        const auto u = static_cast<Index>(j);
        if (dead(y, u) < 0) continue;
        const std::string& input = model.inputs[j].name;
        point["gains"][output][input] = numberOrNull(p.gains(y, u));
        point["dead_time_s"][output][input] = (dead(y, u) - 1) * model.sample_time_s;
        point["steps"][output][input] = listOf(p.steps[j].col(y));
      }
    }
    all.push_back(point);
  }
  return all;
}

}  // namespace fpc::tool
