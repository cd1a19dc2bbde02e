// Pictures with more than runs over time: changed gains, close-ups, and printed numbers beside the
// curve that they belong to.
#include <cmath>

#include "fmbpc/base/text.hpp"
#include "papers/expression.hpp"
#include "papers/picture.hpp"
#include "papers/runs.hpp"

namespace fpc::papers {
namespace {

std::string scored(const std::string& loop, double printed) {
  const Values sum = evaluate("ise_reference(" + loop + ", CA)");
  return loop + ": sum " + shortText(sum.median()) + ", printed " + shortText(printed);
}

/// Figures 2 and 3 (blazic2007): the printed sums in the legend.
bool addReactor(const std::string& figure, const std::string& loop, double pi, double fmbpc) {
  return registerPicture(figure, [=] {
    std::vector<LabelledRun> runs;
    for (const auto& [name, printed] :
         {std::pair{loop + "_pi", pi}, {loop + "_literal", fmbpc}, {loop + "_literal_b", fmbpc}})
      runs.push_back({&recordOf(name), scored(name, printed)});
    return pictureOfRuns(runs, {"q_c", "CA"});
  });
}

/// Figures 6 to 8 (mekki): the loops of the rows, with the gains of table 1.
Picture columnPicture(const std::string& loop, const std::string& feed) {
  std::vector<LabelledRun> runs;
  for (const char* gains : {"nominal", "Max", "Min"})
    runs.push_back(
        {&recordOf(loop + "+gains_" + gains + feed + "+fitted"), std::string("gains ") + gains});
  Picture picture = pictureOfRuns(runs, {"y_D", "x_B"});
  if (feed.empty()) return picture;
  const Vector setpoint = runs.front().run->samples.front().tracking.setpoint;
  picture.panels[0].marks = {{"printed: less than 0.1 % off", 1.001 * setpoint[0]},
                             {"", 0.999 * setpoint[0]}};
  picture.panels[1].marks = {{"printed: 63.82 % off", 1.6382 * setpoint[1]}};
  return picture;
}

/// Figures 12 to 14 (karer2007): the steady part at one temperature, as the loop file names it.
Picture batchPicture(std::size_t window) {
  const char* const loops[] = {"batch_fuzzy_eq45", "batch_linear_eq45"};
  std::vector<LabelledRun> runs;
  for (const char* loop : loops) runs.push_back({&recordOf(loop), loop});
  Picture picture = pictureOfRuns(runs, {"T"});
  const auto& part = readLoop(loops[0]).report.windows.at(window);
  picture.panels.push_back(closeUp(picture.panels[0], {part.from_h, part.to_h}));
  return picture;
}

/// Figure 4 (taieb2017): all steps, and the first one with the printed numbers of table 3.
Picture tankPicture() {
  const std::pair<const char*, const char*> loops[] = {{"NMPC", "surge_tank_steps_nmpc"},
                                                       {"FMPC-APSO", "surge_tank_steps_swarm"},
                                                       {"FOMPC-APSO", "surge_tank_steps"}};
  std::vector<LabelledRun> runs;
  for (const auto& [name, loop] : loops) runs.push_back({&recordOf(loop), name});
  Picture picture = pictureOfRuns(runs, {"H", "I"});
  Panel first = closeUp(picture.panels[0], {0.0, 15.0});
  first.marks = {{"NMPC, printed Ts 5.64 s", 0.20, 5.6402},
                 {"FMPC-APSO, printed Ts 11.08 s", 0.20, 11.0788},
                 {"FOMPC-APSO, printed Ts 1.99 s", 0.20, 1.9936},
                 {"FMPC-APSO, printed peak", 0.2055},
                 {"FOMPC-APSO, printed peak", 0.2162}};
  picture.panels.insert(picture.panels.begin() + 1, first);
  return picture;
}

/// Figure 10 (taieb2017): what the reactor does and what the analyser says of it, around its steps.
Picture analyserPicture() {
  const RunRecord& run = recordOf("mimo_cstr_steps");
  const auto all = [&](const char* label) {
    Panel panel{label, {}};
    panel.curves = {
        curveOf(run, "setpoint", "setpoint",
                [](const SampleRecord& k) {
                  return k.has_tracking ? k.tracking.setpoint[0] : std::nan("");
                }),
        curveOf(run, "reactor", "line", [](const SampleRecord& k) { return k.state.outputs[0]; }),
        curveOf(run, "analyser", "line",
                [](const SampleRecord& k) { return k.measurement.outputs[0]; })};
    return panel;
  };
  Picture picture{"time [min]", {all("Ca [mol/l]")}};
  for (const double step : {82.0, 130.0})
    picture.panels.push_back(closeUp(all("Ca [mol/l]"), {step - 0.5, step + 2.0}));
  return picture;
}

const bool kRegistered =
    addReactor("cstr_figure_2", "cstr_tracking", 0.0165, 0.0061) &&
    addReactor("cstr_figure_3", "cstr_disturbance", 0.0076, 0.0036) &&
    registerPicture("column_figure_6", [] { return columnPicture("column_pso", ""); }) &&
    registerPicture("column_figure_7", [] { return columnPicture("column_pso_bottom", ""); }) &&
    registerPicture("column_figure_8", [] { return columnPicture("column_pso_feed", "_feed"); }) &&
    registerPicture("batch_figure_12", [] { return batchPicture(0); }) &&
    registerPicture("batch_figure_13", [] { return batchPicture(1); }) &&
    registerPicture("batch_figure_14", [] { return batchPicture(2); }) &&
    registerPicture("taieb_figure_4", tankPicture) &&
    registerPicture("taieb_figure_10", analyserPicture);

}  // namespace
}  // namespace fpc::papers
