#include "papers/picture.hpp"

#include <cmath>
#include <map>

#include "base/finite_json.hpp"
#include "base/ordered_json.hpp"
#include "fmbpc/base/input_error.hpp"
#include "papers/runs.hpp"

namespace fpc::papers {
namespace {

using Json = OrderedJson;
constexpr int kPoints = 400;

std::map<std::string, std::function<Picture()>>& registry() {
  static std::map<std::string, std::function<Picture()>> all;
  return all;
}

struct Scale {
  double per_second;
  const char* label;
};

/// Days, hours or seconds, by the length of the run.
Scale scaleOf(const RunRecord& run) {
  const double length = run.info.sample_time_s * static_cast<double>(run.samples.size());
  if (length > 10.0 * 86400.0) return {1.0 / 86400.0, "time [d]"};
  if (length > 6.0 * 3600.0) return {1.0 / 3600.0, "time [h]"};
  if (length > 600.0) return {1.0 / 60.0, "time [min]"};
  return {1.0, "time [s]"};
}

struct Found {
  const SignalInfo* info;
  char kind;  // y, u, d
  Eigen::Index index;
};

Found find(const RunRecord& run, const std::string& signal) {
  for (const auto& [kind, known] :
       {std::pair<char, const std::vector<SignalInfo>*>{'y', &run.info.outputs},
        {'u', &run.info.inputs},
        {'d', &run.info.disturbances}})
    for (std::size_t i = 0; i < known->size(); ++i)
      if ((*known)[i].name == signal) return {&(*known)[i], kind, static_cast<Eigen::Index>(i)};
  throw InputError(run.loop + ": expected a signal " + signal);
}

/// NaN where a sample has no such value: the input at the end, a missing setpoint.
double at(const Vector& values, Eigen::Index i) {
  return i < values.size() ? values[i] : std::nan("");
}

OfSample reader(const Found& found) {
  const Eigen::Index i = found.index;
  if (found.kind == 'y') return [i](const SampleRecord& k) { return at(k.measurement.outputs, i); };
  if (found.kind == 'u') return [i](const SampleRecord& k) { return at(k.action.input, i); };
  return [i](const SampleRecord& k) { return at(k.state.disturbances, i); };
}

Panel panelOf(const std::vector<LabelledRun>& runs, const std::string& signal) {
  const RunRecord& first = *runs.front().run;
  const Found found = find(first, signal);
  Panel panel{signal + " [" + found.info->unit + "]", {}};
  if (found.kind == 'y') {
    const Eigen::Index i = found.index;
    panel.curves.push_back(curveOf(first, "setpoint", "setpoint", [i](const SampleRecord& k) {
      return at(k.tracking.setpoint, i);
    }));
    panel.curves.push_back(curveOf(first, "reference", "reference", [i](const SampleRecord& k) {
      return at(k.tracking.reference, i);
    }));
  }
  for (const auto& [run, label] : runs)
    panel.curves.push_back(
        curveOf(*run, label, found.kind == 'y' ? "line" : "step", reader(find(*run, signal))));
  return panel;
}

}  // namespace

Curve curveOf(const RunRecord& run, const std::string& label, const char* style,
              const OfSample& value) {
  const double step = run.info.sample_time_s * scaleOf(run).per_second;
  Curve curve{label, {}, {}, style};
  for (std::size_t k = 0; k < run.samples.size(); ++k) {
    const double y = value(run.samples[k]);
    if (!std::isfinite(y)) continue;
    curve.x.push_back(step * static_cast<double>(k));
    curve.y.push_back(y);
  }
  return curve;
}

Panel closeUp(Panel panel, Span span) {
  for (Curve& curve : panel.curves) {
    Curve within{curve.label, {}, {}, curve.style};
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (curve.x[i] < span.from || curve.x[i] > span.to) continue;
      within.x.push_back(curve.x[i]);
      within.y.push_back(curve.y[i]);
    }
    curve = std::move(within);
  }
  panel.span = span;
  return panel;
}

Picture pictureOfRuns(const std::vector<LabelledRun>& runs,
                      const std::vector<std::string>& signals) {
  require(!runs.empty(), "picture", "at least one run");
  Picture picture{scaleOf(*runs.front().run).label, {}};
  for (const auto& signal : signals) picture.panels.push_back(panelOf(runs, signal));
  return picture;
}

Picture pictureOfSets(const OutputModel& model, std::size_t variable, const std::string& x_label,
                      double lower, double upper) {
  Panel panel{"degree", {}};
  for (std::size_t rule = 0; rule < model.rules.size(); ++rule) {
    Curve curve{"rule " + std::to_string(rule + 1), {}, {}};
    for (int i = 0; i <= kPoints; ++i) {
      curve.x.push_back(lower + (upper - lower) * i / kPoints);
      curve.y.push_back(
          std::exp(model.rules[rule].antecedents.at(variable).logDegree(curve.x.back())));
    }
    panel.curves.push_back(std::move(curve));
  }
  return {x_label, {panel}};
}

bool registerPicture(const std::string& experiment, std::function<Picture()> picture) {
  registry()[experiment] = std::move(picture);
  return true;
}

bool hasPicture(const Experiment& experiment) {
  return experiment.picture || registry().count(experiment.name) > 0;
}

Picture pictureOf(const Experiment& experiment) {
  require(hasPicture(experiment), experiment.name, "an experiment with a picture");
  if (!experiment.picture) return registry()[experiment.name]();
  std::vector<LabelledRun> runs;
  for (const std::string& run : experiment.picture->runs)
    runs.push_back({&recordOf(run), run.substr(0, run.find('+'))});
  return pictureOfRuns(runs, experiment.picture->signals);
}

Json toJson(const Picture& picture) {
  Json json{{"x_label", picture.x_label}, {"panels", Json::array()}};
  for (const auto& panel : picture.panels) {
    Json curves = Json::array();
    for (const auto& curve : panel.curves)
      if (!curve.x.empty())
        curves.push_back(
            {{"label", curve.label}, {"style", curve.style}, {"x", curve.x}, {"y", curve.y}});
    Json marks = Json::array();
    for (const auto& mark : panel.marks)
      marks.push_back({{"label", mark.label}, {"x", numberOrNull(mark.x)}, {"y", mark.y}});
    json["panels"].push_back({{"label", panel.label},
                              {"curves", curves},
                              {"marks", marks},
                              {"from", numberOrNull(panel.span.from)},
                              {"to", numberOrNull(panel.span.to)}});
  }
  return json;
}

}  // namespace fpc::papers
