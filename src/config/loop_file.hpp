// A loop file read into structs: the one reader of nodes, tool and tests.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/gateway_params.hpp"
#include "control/clp/closed_loop_paradigm.hpp"
#include "control/targets/params.hpp"
#include "estimation/estimator_params.hpp"
#include "fmbpc/control/registry.hpp"
#include "fmbpc/control/setpoint_source.hpp"
#include "fmbpc/model/ts_model.hpp"
#include "identification/online_learner.hpp"
#include "identification/structure.hpp"
#include "plant/simulation.hpp"
#include "supervision/candidate_params.hpp"
#include "supervision/guard_params.hpp"
#include "supervision/plausibility_params.hpp"
#include "supervision/standstill_params.hpp"

namespace fpc {

enum class Pace { kLockstep, kPaced, kRealtime };
inline std::vector<std::string> wordsOf(Pace) { return {"lockstep", "paced", "realtime"}; }

/// Section `loop`: how the exchange over topics runs; ignored in one process.
struct ExchangeParams {
  Pace pace{Pace::kLockstep};
  double speedup{3600.0};  ///< simulated seconds per second of wall time (paced, realtime)
  std::vector<std::string>
      wait_for;  ///< nodes that must be ready before sample 0; filled from controller, clp, model
  std::vector<std::string> members;  ///< all nodes of ours but the plant that the loop needs
  double ready_timeout_s{60.0};      ///< wall time after which missing nodes are named
  bool publish_clock{true};
  double action_timeout_s{5.0};  ///< wall time without an action after which a paced plant goes on
  double optimizer_timeout_s{1.0};  ///< wall time after which the controller answers for it
  double commands_per_s{20.0};      ///< of people that a node takes, on the average
  std::map<std::string, std::vector<std::string>> publishers;  ///< by topic; nobody named: anyone
};

/// A sample line from the process to an analyser; its transport delay is length / velocity.
struct SampleLine {
  std::string output;
  std::string from, to;  ///< frames
  double velocity_m_s{};
};

/// Section `tf`.
struct TfParams {
  bool broadcast{true};
  std::vector<EquipmentFrame> frames;  ///< the plant's, with positions of the loop file over them
  std::vector<SampleLine> sample_lines;
};

enum class DisturbanceSource { kConstant, kPattern, kCsv };
inline std::vector<std::string> wordsOf(DisturbanceSource) {
  return {"constant", "pattern", "csv"};
}

/// Section `disturbance`: what acts on the plant besides the inputs. Read when the plant is made,
/// not before: only the plant's machine needs the record.
struct DisturbanceParams {
  DisturbanceSource source{DisturbanceSource::kConstant};
  PatternParams pattern;
  CsvDisturbanceParams csv;
};

/// A stretch of the run that is judged by itself, both ends included.
struct ReportWindow {
  std::string name;
  std::string output;  ///< empty: all
  double from_h{}, to_h{};
};

/// What the inputs use up: the integral of rate . u over the run.
struct Consumption {
  std::string name;  ///< its key in summary.json, with its unit: water_kg
  Vector rate;       ///< n_u, per second and unit of the input
};

/// Section `report`.
struct ReportParams {
  std::string title;
  std::vector<double> output_lower,
      output_upper;  ///< n_y limits for violations.output; infinite if absent
  std::vector<ReportWindow> windows;
  std::vector<Consumption> consumption;
  double record_from_h{};                      ///< rows of trajectory.csv begin here
  std::vector<Eigen::Index> without_setpoint;  ///< outputs that nobody asks anything of
};

/// Section `model.identify`: how fuzzy_identifier finds models while the plant runs.
struct IdentifyParams {
  static constexpr std::size_t kWindow = 100000;   ///< samples kept, the newest
  static constexpr double kValidationShare = 0.3;  ///< of the rows, at the end, held out
  std::string structure_file;  ///< absolute; empty: only goals that bring a structure
  Structure structure;         ///< of that file
  int after{0};  ///< samples after which the node identifies unasked, once; 0: on request only
  OnlineParams online;
};

struct LoopFile;

/// Section `candidate`: a law that is watched beside the one in charge.
struct CandidateFile {
  std::string file;  ///< of its loop, absolute; empty: there is none
  CandidateParams params;
  std::shared_ptr<const LoopFile> loop;  ///< null if there is none
};

struct LoopFile {
  std::string name;  ///< the file's stem
  std::string file;
  bool external_plant{false};   ///< plant.type external: a node of the user's speaks the exchange
  PlantInfo plant_info;         ///< header of sample 0 with run_id 0
  SimulationParams simulation;  ///< without the disturbance record; for an external plant only
                                ///< sampling, limits, names
  DisturbanceParams disturbance;
  SetpointParams setpoint;
  bool has_model{false};
  std::string model_file;  ///< absolute
  TsModel model;           ///< matched to the plant
  double max_pole{1.0};    ///< a model that replaces another in a run is refused beyond
  bool has_identify{false};
  IdentifyParams identify;
  std::shared_ptr<const ControllerConfig> controller;  ///< never null in a loop that was read
  Vector disturbance_nominal;                          ///< n_d, of the measured disturbances
  GuardParams guard;                                   ///< around a law with a model
  std::shared_ptr<const ControllerConfig> fallback;    ///< of the guard; null: none
  PlausibilityParams plausibility;                     ///< what a measurement may be
  StuckParams stuck;            ///< section plausibility: inputs that do not follow
  EstimatorParams estimator;    ///< around a law with a model; without outputs: none
  StandstillParams standstill;  ///< around any law; without signals: none
  std::shared_ptr<const ControllerConfig> standstill_fallback;  ///< null: none
  GatewayParams gateway;                                        ///< of an external plant
  CandidateFile candidate;                                      ///< beside the law
  bool has_clp{false};
  ClpParams clp;
  TargetParams targets;
  ExchangeParams exchange;
  TfParams tf;
  ReportParams report;
  std::string
      resolved;  ///< the merged text all this was read from; self-contained but for data files

  /// @throws InputError without a controller.
  const ControllerType& controllerType() const;
  /// The parameters of the controller. @throws InputError naming its type if they are others.
  template <typename Params>
  const Params& controllerParams() const {
    const Params* params = controller ? findParams<Params>(*controller) : nullptr;
    require(params, name + ": controller.type", "another controller than " + controllerType().name);
    return *params;
  }
};

/// A loop as a candidate for the place of another one's law: its own section `candidate` is left
/// out. @throws InputError naming the file, or what differs from the loop in charge: signals,
/// sample time, an optimizer, or a missing model.
std::shared_ptr<const LoopFile> readCandidateLoop(const std::string& name_or_path,
                                                  const LoopFile& in_charge);
/// What the loop tells its controller.
ControllerContext controllerContext(const LoopFile& loop);
/// matchToPlant() with what the loop's controller estimates.
TsModel matchToLoop(const TsModel& model, const LoopFile& loop);

/// "--set plant.type=model" over another type puts the loop's model into the place of its plant.
/// "--set controller.coincidence_steps=3": dotted path (list items by number) -> YAML text.
using Overrides = std::vector<std::pair<std::string, std::string>>;
/// @throws InputError unless the text is "path=value".
std::pair<std::string, std::string> parseOverride(const std::string& text);
/// Several in one text, separated by spaces outside brackets and quotes; a word without "=" belongs
/// to the value before it. @throws InputError as parseOverride().
Overrides parseOverrides(const std::string& text);
/// One in each text, as --set takes them. @throws InputError as parseOverride().
Overrides parseOverrides(const std::vector<std::string>& texts);

/// Folders that hold loop/, model/, structure/ and data/: ${FMBPC_CONFIG_PATH} (colon separated),
/// then those of the build.
std::vector<std::string> configFolders();
/// A loop's file from its name ("asp_case1") or path. @throws InputError with the nearest
/// names.
std::string findLoop(const std::string& name_or_path);
std::vector<std::string> loopNames();
std::vector<std::string> loopFiles();   ///< paths, in the order of the names
std::vector<std::string> modelNames();  ///< of config/model
/// An identification structure's file from its name ("asp_c") or path, in the same way.
std::string findStructure(const std::string& name_or_path);

/// Merges `extends`, applies overrides, expands ${...} in `file:` keys and makes them absolute;
/// validates by reading. The result is YAML text which parseLoop() reads. @throws InputError naming
/// file, line, key and what was expected.
std::string resolveLoop(const std::string& name_or_path, const Overrides& overrides = {});
/// @throws InputError naming `name`, line, key and what was expected.
LoopFile parseLoop(const std::string& text, const std::string& name);
/// The same with overrides on the text; names of files in them must be absolute.
LoopFile parseLoop(const std::string& text, const std::string& name, const Overrides& overrides);
LoopFile readLoop(const std::string& name_or_path, const Overrides& overrides = {});

}  // namespace fpc
