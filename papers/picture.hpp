// The figures of the papers as ours: panels of curves, written as JSON for
// fmbpc.plots.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/ordered_json.hpp"
#include "fmbpc/model/ts_model.hpp"
#include "papers/experiment.hpp"
#include "runtime/record.hpp"

namespace fpc::papers {

struct Curve {
  std::string label;
  std::vector<double> x, y;
  std::string style{"line"};  ///< line, step, setpoint, reference
};
/// A printed number beside a curve: a dot, or a line across the panel (x not finite).
struct Mark {
  std::string label;
  double y{}, x{std::numeric_limits<double>::quiet_NaN()};
};
/// From where to where a panel shows its curves, in units of x; unlimited: all there is.
struct Span {
  double from{-std::numeric_limits<double>::infinity()};
  double to{std::numeric_limits<double>::infinity()};
};
struct Panel {
  std::string label;  ///< of the vertical axis, with its unit
  std::vector<Curve> curves;
  std::vector<Mark> marks{};
  Span span{};
};
struct Picture {
  std::string x_label;
  std::vector<Panel> panels;
};

struct LabelledRun {
  const RunRecord* run;
  std::string label;
};

/// Signals of runs over time, one panel a signal, one curve a run; outputs with setpoint and
/// reference of the first run. @throws InputError naming a signal that the loop does not have.
Picture pictureOfRuns(const std::vector<LabelledRun>& runs,
                      const std::vector<std::string>& signals);
/// Only what lies within: in the unit of the picture's x.
Panel closeUp(Panel panel, Span span);
using OfSample = std::function<double(const SampleRecord&)>;
/// Over time in the unit of pictureOfRuns(); where `value` is not finite the curve has no point.
Curve curveOf(const RunRecord& run, const std::string& label, const char* style,
              const OfSample& value);
/// Fuzzy sets of one variable of an output, over lower..upper.
Picture pictureOfSets(const OutputModel& model, std::size_t variable, const std::string& x_label,
                      double lower, double upper);
/// The picture that stands for an experiment: a registered one, or the runs that it names; false if
/// it has none.
bool hasPicture(const Experiment& experiment);
Picture pictureOf(const Experiment& experiment);
/// For pictures that do not come from runs alone. @return true
bool registerPicture(const std::string& experiment, std::function<Picture()> picture);
OrderedJson toJson(const Picture& picture);

}  // namespace fpc::papers
