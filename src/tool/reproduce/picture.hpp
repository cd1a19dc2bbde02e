// The figures of the papers as ours: panels of curves, written as JSON for
// scripts/plot_reproduce.py.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fmbpc/fuzzy/ts_model.hpp"
#include "fmbpc/loop/record.hpp"

namespace fpc::tool {

struct Curve {
  std::string label;
  std::vector<double> x, y;
  std::string style{"line"};  ///< line, step, setpoint, reference
};
struct Panel {
  std::string label;  ///< of the vertical axis, with its unit
  std::vector<Curve> curves;
  std::vector<double> limits{};
};
struct Picture {
  std::string x_label;
  std::vector<Panel> panels;
};

/// Signals of runs over time, one panel a signal, one curve a loop; outputs with setpoint and
/// reference of the first loop. @throws InputError naming a signal that the loop does not have.
Picture pictureOfRuns(const std::vector<const RunRecord*>& runs,
                      const std::vector<std::string>& signals);
/// Fuzzy sets of one variable of an output, over lower..upper.
Picture pictureOfSets(const OutputModel& model, std::size_t variable, const std::string& x_label,
                      double lower, double upper);
/// The picture that stands for an experiment; false if it has none.
bool hasPicture(const std::string& experiment);
Picture pictureOf(const std::string& experiment);
/// For pictures that do not come from runs alone. @return true
bool registerPicture(const std::string& experiment, std::function<Picture()> picture);
nlohmann::ordered_json toJson(const Picture& picture);

}  // namespace fpc::tool
