#include "runtime/commissioning/commissioning.hpp"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>

#include "base/files.hpp"
#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/model/local_model.hpp"
#include "paths.hpp"
#include "runtime/commissioning/design.hpp"
#include "runtime/drawn_record.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace commissioning_test {

namespace fs = std::filesystem;
using Stage = CommissioningStage;

const char kTankBrief[] =
    "loop: tank.yaml\n"
    "limits: {T: [30, 55]}\n"
    "moves: {heat: 1}\n"
    "hold: {T: 42}\n"
    "plant_time_h: 12\n"
    "seed: 1\n";
const char kTank[] =
    "extends: heated_tank\n"
    "noise: {std: {T: 0.05}}\n"
    "controller:\n"
    "  loops: [{input: heat, output: T, kp: 0.3, ki_per_h: 1, start: bumpless}]\n"
    "disturbance: {commands: []}\n";
const char kColumnBrief[] =
    "loop: column.yaml\n"
    "limits: {T_17: [-3, 3], T_4: [-3, 3]}\n"
    "moves: {R: 0.1, S: 0.1}\n"
    "hold: {T_17: 0, T_4: 0}\n"
    "plant_time_h: 12\n";
const char kColumn[] =
    "extends: methanol_clip\n"
    "noise: {std: {T_17: 0.03, T_4: 0.03}}\n"
    "setpoint: {initial: {T_17: 0, T_4: 0}}\n"
    "controller:\n"
    "  type: pi\n"
    "  loops:\n"
    "    - {input: R, output: T_17, kp: -0.2, ki_per_h: -2, start: bumpless}\n"
    "    - {input: S, output: T_4, kp: 0.2, ki_per_h: 2, start: bumpless}\n";

std::string textOf(const std::string& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// A folder of its own, with brief and loop file.
std::string folderOf(const std::string& name, const std::string& brief,
                     const std::string& loop_name, const std::string& loop) {
  const std::string folder = inFolder(resultsDir(), "commissioning_" + name);
  fs::remove_all(folder);
  makeFolder(folder);
  writeText(brief, inFolder(folder, "brief_in.yaml"));
  writeText(loop, inFolder(folder, loop_name));
  return folder;
}

Commissioning made(const std::string& folder) {
  CommissioningOptions options;
  options.evaluations = 16;
  options.members = 9;
  options.threads = 1;
  return {inFolder(folder, "brief_in.yaml"), folder, options};
}

std::string errorOfBrief(const std::string& without) {
  std::string brief = kTankBrief;
  const std::size_t at = brief.find(without + ":");
  brief.erase(at, brief.find('\n', at) - at + 1);
  const std::string folder = folderOf("brief", brief, "tank.yaml", kTank);
  try {
    readBrief(inFolder(folder, "brief_in.yaml"));
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(CommissioningBrief, AsksByNameForWhatIsMissing) {
  for (const char* key : {"loop", "plant_time_h"})
    EXPECT_NE(errorOfBrief(key).find(key), std::string::npos) << key;
  EXPECT_EQ(errorOfBrief("moves"), "");  // the loop file says them
  EXPECT_EQ(errorOfBrief("seed"), "");
}

TEST(CommissioningBrief, RefusesUnknownSignalsAndSetpointsBeyondTheLimits) {
  for (const char* bad : {"hold: {T: 60}\n", "hold: {X: 42}\n",
                          "hold: {T: 42}\nzone: {T: [50, 40]}\n", "zone: {T: [40, 50]}\n"}) {
    std::string brief = kTankBrief;
    brief.replace(brief.find("hold: {T: 42}\n"), 14, bad);
    const std::string folder = folderOf("brief", brief, "tank.yaml", kTank);
    EXPECT_THROW(readBrief(inFolder(folder, "brief_in.yaml")), InputError) << bad;
  }
}

/// What stage model says of one element.
OrderedJson elementOf(const Commissioning& c, std::size_t output, std::size_t input) {
  return c.figures(Stage::kModel)["outputs"][output]["elements"][input];
}

void expectWithin(const OrderedJson& element, const char* key, const char* bound, double truth) {
  // Two of five bounds of 95 % may miss a little; three times as far none does.
  EXPECT_NEAR(element[key].get<double>(), truth, 1.5 * element[bound].get<double>()) << key;
}

TEST(Commissioning, OfOneInputGoesTheWholeWayInsideItsLimits) {
  const std::string folder = folderOf("tank", kTankBrief, "tank.yaml", kTank);
  Commissioning c = made(folder);
  c.run(Stage::kDesign);
  const OrderedJson test = c.figures(Stage::kTest);
  EXPECT_EQ(test["ended"], "enough") << test["reason"];
  EXPECT_EQ(test["limits_left"], 0);
  const OrderedJson element = elementOf(c, 0, 0);
  expectWithin(element, "gain", "gain_bound", 2.5);
  EXPECT_LT(element["gain_bound"].get<double>(), 0.5);
  const OrderedJson design = c.figures(Stage::kDesign);
  EXPECT_TRUE(fs::is_regular_file(design["offered"].get<std::string>()));
  for (const std::string& file : {c.lawFile(), c.piFile()}) {
    LoopFile loop = readLoop(file);
    const RunRecord record = runLoop(loop);
    EXPECT_TRUE(record.complete) << file;
    EXPECT_NEAR(record.samples.back().state.outputs[0], 50.0, 0.5)
        << file;  // its own setpoint at the end
  }
}

TEST(Commissioning, WaitsForAMeasuredDisturbanceAndFeedsItForward) {
  for (const bool moves : {false, true}) {
    std::string loop = kTank;
    if (moves) loop.replace(loop.find("[]}"), 3, "[{time_h: 7, name: T_in, value: 10}]}");
    const std::string folder = folderOf("waits", kTankBrief, "tank.yaml", loop);
    Commissioning c = made(folder);
    c.run(Stage::kModel);
    const OrderedJson test = c.figures(Stage::kTest);
    EXPECT_EQ(test["ended"], "enough") << test["reason"];
    EXPECT_GT(test["listened"], 0) << "nothing had moved it";
    const OrderedJson element = elementOf(c, 0, 1);
    EXPECT_EQ(element["from"], "T_in");
    EXPECT_EQ(element["seen"], moves);
    if (moves) expectWithin(element, "gain", "gain_bound", 0.8);
  }
}

/// Under its tight PI the tank is taken for an integrator, with a measured disturbance that
/// integrates as well: the loads that the design tries must be of the size of its steps.
TEST(Commissioning, ThePiOfAPlantTakenForAnIntegratorHoldsThePlant) {
  const std::string folder = folderOf("integrator", kTankBrief, "tank.yaml",
                                      "extends: heated_tank\nnoise: {std: {T: 0.05}}\n");
  Commissioning c = made(folder);
  c.run(Stage::kDesign);
  ASSERT_EQ(c.figures(Stage::kModel)["outputs"][0]["kind"], "integrating");
  const RunRecord record = runLoop(readLoop(c.piFile()));
  EXPECT_NEAR(record.samples.back().state.outputs[0], 50.0, 1.5);
}

/// An integrator under levels of 4 and 6 kW; 5 kW keeps it.
TEST(Commissioning, AKindThatThePresentControlRefutesGivesWayToAnother) {
  const std::string folder = folderOf("kinds", kTankBrief, "tank.yaml", kTank);
  const CommissioningBrief brief = readBrief(inFolder(folder, "brief_in.yaml"));
  std::ostringstream csv;
  csv << "time[h],T[degC],heat[kW],T_in[degC],heat_applied[kW]\n";
  std::mt19937 engine(1);
  double T = 42.0, heat = 5.0;
  for (int k = 0; k < 400; ++k) {
    const double before = heat;
    if (k % 5 == 0 && k > 0) heat = engine() % 2 == 0 ? 4.0 : 6.0;
    const double noise = 0.05 * (static_cast<double>(engine()) / 4294967296.0 - 0.5);
    csv << k / 120.0 << "," << T + noise << "," << heat << ",15," << before << "\n";
    T += 0.1 * (heat - 5.0);
  }
  writeText(csv.str(), inFolder(folder, "record.csv"));
  const PlantRecord record =
      PlantRecord::read(inFolder(folder, "record.csv"), brief.loop.plant_info);
  const auto kindIf = [&](const std::function<bool(ProcessKind)>& holds) {
    const auto held = [&](const ProcessModels& m) { return holds(m.fits[0].kind); };
    return findModels(brief, record, 2, held).fits[0].kind;
  };
  EXPECT_EQ(kindIf([](ProcessKind) { return true; }), ProcessKind::kIntegrating);
  EXPECT_EQ(kindIf([](ProcessKind kind) { return kind == ProcessKind::kStable; }),
            ProcessKind::kStable);
  EXPECT_EQ(kindIf([](ProcessKind) { return false; }), ProcessKind::kIntegrating);
}

/// One element from heat to T, and likely models with these parts of its gain.
ProcessModels lagsOf(const CommissioningBrief& brief, ProcessKind kind,
                     const ProcessElement& element, const std::vector<double>& parts,
                     const ProcessElement& of_inlet = {}) {
  ProcessFit fit;
  fit.kind = kind;
  ElementEstimate heat, inlet;
  heat.element = element;
  heat.seen = true;
  inlet.element = of_inlet;
  inlet.seen = of_inlet.gain != 0.0;
  fit.elements = {heat, inlet};
  fit.one_step = fit.free_run = 0.05;
  fit.output = 42.0;
  fit.input = Vector::Constant(2, 10.0);
  TsModel names;
  names.name = "lag";
  names.sample_time_s = brief.loop.plant_info.sample_time_s;
  names.outputs = brief.loop.plant_info.outputs;
  names.inputs = brief.loop.plant_info.inputs;
  names.disturbances = brief.loop.plant_info.disturbances;
  for (const double part : parts) {
    fit.ensemble.push_back({heat.element, inlet.element});
    fit.ensemble.back().front().gain *= part;
  }
  return fpc::modelsOf(names, {fit}, static_cast<int>(parts.size()), {true});
}

Design designed(const CommissioningBrief& brief, const std::string& folder,
                const ProcessModels& models, double peak, int evaluations = 4) {
  writeModels(models, folder);
  DesignParams params;
  params.evaluations = evaluations;
  params.tuned_members = 2;
  params.threads = 1;
  params.peak = peak;
  return designLaws(brief, Vector::Constant(1, 0.05), inFolder(folder, "model.yaml"), models,
                    params);
}

/// The present PI, u = -4 e, holds the lag -1 / (600 s - 1) and not one of a twentieth of its gain.
TEST(Design, LeavesOutModelsThatThePresentControlWouldNotHold) {
  const std::string folder =
      folderOf("unstable", kTankBrief, "tank.yaml",
               "extends: heated_tank\ncontroller:\n  loops: [{input: heat, output: T, kp: 4, "
               "ki_per_h: 8, reverse: true, start: bumpless}]\n");
  const CommissioningBrief brief = readBrief(inFolder(folder, "brief_in.yaml"));
  const auto on = [&](const std::vector<double>& parts) {
    return designed(
        brief, folder,
        lagsOf(brief, ProcessKind::kUnstable, {1.0, -600.0, 0.0, 0.0, 30.0, false}, parts), 2.0);
  };
  const Design some = on({1.1, 0.05, 0.9, 1.05, 0.95});
  EXPECT_EQ(some.refuted, 1U);
  EXPECT_TRUE(some.offers_law || some.offers_pi);
  EXPECT_NE(some.pi.find("kp: -"), std::string::npos) << "its sign holds an unstable lag";
  EXPECT_NE(some.pi.find("setpoint_pole"), std::string::npos) << "its zero would overshoot";
  const std::vector<double>& offered =
      some.offers_law ? some.law_figures.costs : some.pi_figures.costs;
  ASSERT_EQ(offered.size(), some.present_costs.size());
  for (std::size_t m = 0; m < offered.size(); ++m) EXPECT_LT(offered[m], some.present_costs[m]);
  const Design none = on({0.05, -1.0, 0.02, 0.04, 0.9});
  EXPECT_EQ(none.refuted, 4U);
  EXPECT_FALSE(none.offers_law || none.offers_pi);
  EXPECT_FALSE(std::isfinite(none.law_figures.tuned) || std::isfinite(none.ratio));
  EXPECT_NE(none.pi.find("kp:"), std::string::npos);
}

/// A law that feeds the inlet forward is worth more beside the PI, which sees its effect only.
TEST(Design, TriesTheDisturbancesThatAreMeasured) {
  const std::string folder = folderOf("inlet", kTankBrief, "tank.yaml", "extends: heated_tank\n");
  const CommissioningBrief brief = readBrief(inFolder(folder, "brief_in.yaml"));
  const auto ratioAt = [&](double move) {
    ProcessModels models = lagsOf(brief, ProcessKind::kStable, {2.5, 240.0, 0.0, 0.0, 60.0, false},
                                  {1.1, 0.9, 1.05, 0.95}, {1.0, 240.0, 0.0, 0.0, 60.0, false});
    models.disturbance_moves = Vector::Constant(1, move);
    return designed(brief, folder, models, 2.0).ratio;
  };
  const double still = ratioAt(0.0);
  EXPECT_LT(ratioAt(6.0), 0.95 * still);
}

TEST(ProcessModels, TakeTheirNoiseFromTheWatch) {
  const std::string folder = folderOf("watched", kTankBrief, "tank.yaml", "extends: heated_tank\n");
  const CommissioningBrief brief = readBrief(inFolder(folder, "brief_in.yaml"));
  const PlantInfo& plant = brief.loop.plant_info;
  PlantRecord watched(plant);
  auto engine = seededEngine(3, {});
  Measurement now;
  now.input_applied = Vector::Constant(countOf(plant.inputs), 10.0);
  now.disturbances = Vector::Constant(countOf(plant.disturbances), 10.0);
  for (std::uint32_t k = 0; k < 250; ++k) {
    now.header.step = k;
    now.outputs = Vector::Constant(1, k < 50 ? 1.0 * k : 42.0 + 0.02 * standardNormal(engine));
    watched.add(now, now.input_applied);
  }
  const auto oneStep = [&](Eigen::Index first, double least) {
    ProcessModels models =
        lagsOf(brief, ProcessKind::kStable, {2.5, 240.0, 0.0, 0.0, 60.0, false}, {1.1, 0.9});
    takeNoiseInOperation(watched, first, Vector::Constant(1, least), models);
    return models.fits[0].one_step;
  };
  EXPECT_NEAR(oneStep(50, 0.0), 0.02, 0.004) << "what had not settled is left out";
  EXPECT_EQ(oneStep(50, 0.04), 0.04);
  for (const Eigen::Index first : {240, 250, 1000}) EXPECT_EQ(oneStep(first, 0.0), 0.05) << first;
}

TEST(Design, AsksThePresentControlOfALoopWithoutAnEnd) {
  const std::string folder =
      folderOf("endless", kTankBrief, "tank.yaml",
               "extends: heated_tank\nsampling: {duration_h: 0}\nsetpoint: {schedule: []}\n");
  const CommissioningBrief brief = readBrief(inFolder(folder, "brief_in.yaml"));
  const ProcessElement lag{2.5, 240.0, 0.0, 0.0, 60.0, false};
  EXPECT_TRUE(presentHolds(brief, lagsOf(brief, ProcessKind::kStable, lag, {1.1, 0.9})));
  EXPECT_FALSE(presentHolds(brief, lagsOf(brief, ProcessKind::kStable, lag, {-1.0, -2.0})));
}

/// Gains (1, 1) and (1, 1.1) of two inputs, and likely models with these gains in the last place.
ProcessModels pairOf(const std::vector<double>& last) {
  ProcessModels models;
  for (const double gain : {1.0, 1.1}) {
    ProcessFit fit;
    for (const double g : {1.0, gain}) fit.elements.push_back({{g, 60.0}, true});
    for (const double other : last)
      fit.ensemble.push_back({{1.0, 60.0}, {gain > 1.0 ? other : 1.0, 60.0}});
    models.fits.push_back(fit);
  }
  return models;
}

/// Six inputs with two lags of some 50 samples each: twelve poles have no common denominator that
/// double precision holds; the model keeps the gains all the same.
TEST(ProcessModels, OfManySlowLagsKeepTheirGains) {
  ProcessFit fit;
  TsModel names;
  names.name = "many";
  names.sample_time_s = 1.0;
  names.outputs = {{"y", "", -100.0, 100.0}};
  for (int j = 0; j < 6; ++j) {
    names.inputs.push_back({"u" + std::to_string(j), "", -1.0, 1.0});
    fit.elements.push_back({{1.0 + j, 40.0 + 4.0 * j, 30.0 + j, 0.0, 3.0}, true});
  }
  fit.output = 1.0;
  fit.input = Vector::Zero(6);
  const ProcessModels models = fpc::modelsOf(names, {fit}, 0, {false});
  const OutputModel& made = models.model.submodels.front();
  const Vector& c = made.rules.front().coefficients;
  double own = 1.0;
  Vector effect = Vector::Zero(6);
  for (std::size_t k = 0; k < made.regressors.size(); ++k) {
    const Regressor& r = made.regressors[k];
    if (r.kind == SignalKind::kOutput)
      own -= c[static_cast<Eigen::Index>(k)];
    else
      effect[r.index] += c[static_cast<Eigen::Index>(k)];
  }
  for (int j = 0; j < 6; ++j) EXPECT_NEAR(effect[j] / own, 1.0 + j, 0.01 * (1.0 + j)) << j;
}

/// A lag whose gain grows with its output by e^(2 bend), under a PI.
test::Data bentRecord(double bend) {
  ProcessElement e;
  e.gain = 2.0;
  e.time_constant = 6.0;
  e.dead_time = 2.0;
  test::Noise noise;
  noise.measurement = 0.03;
  noise.load = 0.01;
  return test::record(e, 0.3, 0.04, 1.0, noise, 500, 4, bend);
}

TEST(GainCurve, OfAProcessWhoseGainGrowsMakesAFuzzyModel) {
  const test::DrawnModels found = test::drawnModels(test::plantRecord(bentRecord(0.8)), 8, 1);
  ASSERT_TRUE(found.hasCurve());
  const GainCurve& curve = *found.curved.fits.front().curve;
  EXPECT_GT(curve.change, curve.bound);
  ASSERT_EQ(found.curved.ensemble.size(), 8U);
  LinearPoint rest = modelRest(found.curved.fits, 1);
  const auto restsAt = [&](const TsModel& model, double input, double load) {
    LocalModel local(model);
    Vector state(local.stateSize()), next(local.stateSize());
    const Vector u = rest.inputs.array() + input, d = Vector::Constant(1, load);
    local.restState(rest.outputs, u, d, state);
    for (int k = 0; k < 300; ++k) {
      local.advance(state, u, d, next);
      state = next;
    }
    return state[local.outputState(0)] - rest.outputs[0];
  };
  for (const TsModel* model :
       {&found.curved.model, &found.curved.ensemble.front(), &found.curved.ensemble.back()}) {
    ASSERT_EQ(model->submodels.front().rules.size(), 2U);
    EXPECT_NEAR(restsAt(*model, 0.0, 0.0), 0.0, 1e-9);  // as the elements
    EXPECT_NEAR(restsAt(*model, 0.0, 0.5), 0.5, 1e-9);
  }
  EXPECT_NE(restsAt(found.curved.ensemble.front(), 0.8, 0.0),
            restsAt(found.curved.ensemble.back(), 0.8, 0.0));
  // The process rests at 2.5 (exp(0.8 u) - 1): upwards it goes 1.9 times as far.
  const double ratio =
      restsAt(found.curved.model, 0.8, 0.0) / -restsAt(found.curved.model, -0.8, 0.0);
  EXPECT_GT(ratio, 1.4);
  EXPECT_LT(ratio, 2.6);
}

TEST(GainCurve, OfALinearProcessIsNone) {
  const test::DrawnModels found = test::drawnModels(test::plantRecord(bentRecord(0.0)), 8, 1);
  EXPECT_FALSE(found.hasCurve());
  EXPECT_EQ(found.curved.model.submodels.front().rules.size(), 1U);
}

/// Of a process that does not rest by itself the record says where it was, in the output's unit.
TEST(GainCurve, LeavesAnUnstableProcessWhereItWas) {
  const Eigen::Index rows = 800;
  test::Data d{Matrix::Zero(rows, 1), Vector::Zero(rows)};
  auto engine = seededEngine(4, {3});
  double y = 0.0, level = 1.0;
  for (Eigen::Index k = 0; k < rows; ++k) {
    if (k % 7 == 0 && standardNormal(engine) > 0.0) level = -level;
    d.y[k] = 3.0 + 0.01 * (y + 0.003 * standardNormal(engine));
    d.u(k, 0) = level - 4.0 * y;
    y = 1.01 * y + 0.05 * std::exp(1.5 * y) * d.u(k, 0);
  }
  const test::DrawnModels found = test::drawnModels(test::plantRecord(d), 2, 1);
  ASSERT_TRUE(found.hasCurve());
  EXPECT_EQ(found.curved.fits.front().kind, ProcessKind::kUnstable);
  const double rest = modelRest(found.straight.fits, 1).outputs[0];
  EXPECT_NEAR(rest, 3.0, 0.01);
  EXPECT_NEAR(modelRest(found.curved.fits, 1).outputs[0], rest, 1e-9);
}

TEST(GainCurve, DoesNotDependOnUnits) {
  test::Data d = bentRecord(0.8);
  const GainCurve one = *test::drawnModels(test::plantRecord(d), 2, 1).curved.fits.front().curve;
  d.y = 1000.0 * d.y.array() + 300.0;
  d.u *= 1e-3;
  const GainCurve other = *test::drawnModels(test::plantRecord(d), 2, 1).curved.fits.front().curve;
  EXPECT_EQ(one.signal, other.signal);
  EXPECT_NEAR(other.change, one.change, 1e-3);
  const double unit = one.signal < 0 ? 1000.0 : 1e-3, shift = one.signal < 0 ? 300.0 : 0.0;
  EXPECT_NEAR(other.lower, shift + unit * one.lower, 1e-3 * unit);
  EXPECT_NEAR(other.upper, shift + unit * one.upper, 1e-3 * unit);
}

TEST(WeakDirections, AreCertainWhereTheWholeEnsembleHasTheSameSign) {
  const Vector one = Vector::Ones(2);
  const auto certain = [&](const std::vector<double>& last) {
    const std::vector<WeakDirection> weak = weakDirections(pairOf(last), one, one);
    EXPECT_EQ(weak.size(), 1U);
    return weak.at(0).certain;
  };
  EXPECT_TRUE(certain({1.005, 1.2, 1.15}));
  EXPECT_FALSE(certain({1.05, 0.9, 1.15})) << "its determinant has the other sign";
}

/// A tank that nothing holds, and likely models of it.
class DesignOf : public ::testing::Test {
 protected:
  DesignOf()
      : folder_(folderOf("open", kTankBrief, "tank.yaml",
                         "extends: heated_tank\ncontroller: {type: excitation, signals: [{input: "
                         "heat, signal: none}]}\n")),
        brief_(readBrief(inFolder(folder_, "brief_in.yaml"))),
        models_(lagsOf(brief_, ProcessKind::kStable, {2.5, 240.0, 0.0, 0.0, 60.0, false},
                       {1.1, 0.9, 1.05, 0.95})) {}
  Design design(double peak, int evaluations = 4) const {
    return designed(brief_, folder_, models_, peak, evaluations);
  }
  std::string folder_;
  CommissioningBrief brief_;
  ProcessModels models_;
};

/// A lag with dead time allows any peak above 1, and with integral action none of 1 or less
/// (Bode's integral).
TEST_F(DesignOf, AnOpenTankKeepsThePeakThatIsAskedForOrOffersNothing) {
  const double asked = 1.3;
  const Design free = design(100.0), stable = design(asked, 16), never = design(1.0);
  for (const auto figures : {&Design::law_figures, &Design::pi_figures}) {
    EXPECT_GT((free.*figures).worst_peak, asked) << "the peak costs nothing";
    EXPECT_LE((stable.*figures).worst_peak, asked);
    EXPECT_GT((stable.*figures).worst_peak, 1.0);
    EXPECT_GT((never.*figures).worst_peak, 1.0);
    EXPECT_GE((stable.*figures).tuned, (free.*figures).tuned) << "stability is free";
  }
  EXPECT_TRUE(stable.offers_law || stable.offers_pi);
  EXPECT_FALSE(never.offers_law || never.offers_pi);
  EXPECT_NE(stable.law.find("fallback"), std::string::npos);
  EXPECT_EQ(never.law.find("fallback"), std::string::npos) << "a PI that is not fit is none";
}

/// The larger effect of u is on a, which v moves as well; b has no other input than u.
TEST(Design, AnOutputTakesTheInputThatAnotherCanDoWithout) {
  const std::string signal = ", unit: '', nominal: 0, lower: -100, upper: 100}";
  const std::string folder =
      folderOf("pairs",
               "loop: pairs.yaml\nlimits: {a: [-10, 10], b: [-10, 10]}\nmoves: {u: 5, v: 5, w: 5}\n"
               "plant_time_h: 12\n",
               "pairs.yaml",
               "plant:\n  type: transfer_matrix\n  matrix:\n    outputs: [{name: a" + signal +
                   ", {name: b" + signal + "]\n    inputs: [{name: u" + signal + ", {name: v" +
                   signal + ", {name: w" + signal +
                   "]\n    elements:\n"
                   "      - {output: a, from: u, gain: 1, time_constant_min: 2}\n"
                   "      - {output: a, from: v, gain: 0.3, time_constant_min: 2}\n"
                   "      - {output: b, from: u, gain: 0.5, time_constant_min: 2}\n"
                   "sampling: {sample_time_s: 30, duration_h: 4}\n"
                   "controller: {type: excitation, signals: [{input: u, signal: none}]}\n");
  const CommissioningBrief brief = readBrief(inFolder(folder, "brief_in.yaml"));
  const double gains[2][3] = {{1.0, 0.3, 0.0}, {0.5, 0.0, 0.0}};
  std::vector<ProcessFit> fits(2);
  TsModel names;
  names.name = "pairs";
  names.sample_time_s = 30.0;
  names.outputs = brief.loop.plant_info.outputs;
  names.inputs = brief.loop.plant_info.inputs;
  for (std::size_t i = 0; i < 2; ++i) {
    fits[i].one_step = fits[i].free_run = 0.01;
    fits[i].input = Vector::Zero(3);
    fits[i].ensemble.resize(4);
    for (const double gain : gains[i]) {
      const ProcessElement e{gain, 120.0, 0.0, 0.0, 30.0, false};
      fits[i].elements.push_back({e, gain != 0.0});
      for (auto& member : fits[i].ensemble) member.push_back(e);
    }
  }
  const ProcessModels models = fpc::modelsOf(names, fits, 4, {true, true});
  writeModels(models, folder);
  DesignParams params;
  params.evaluations = 2;
  params.tuned_members = 2;
  params.threads = 1;
  const Design d =
      designLaws(brief, Vector::Constant(2, 0.01), inFolder(folder, "model.yaml"), models, params);
  const YAML::Node loops = YAML::Load(d.pi)["controller"]["loops"];
  ASSERT_EQ(loops.size(), 2U);
  for (const auto& loop : loops)
    EXPECT_EQ(loop["input"].as<std::string>(), loop["output"].as<std::string>() == "a" ? "v" : "u");
}

/// The noise of the fit acts in the runs that are judged.
TEST_F(DesignOf, AnOpenTankCostsMoreWithNoise) {
  const double quiet = design(2.0).pi_figures.tuned;
  models_.fits.front().one_step *= 20.0;
  models_.fits.front().noise = Vector::Constant(1, 0.5);
  EXPECT_GT(design(2.0).pi_figures.tuned, 1.05 * quiet);
}

/// The control in charge is what a longer search found: a short one does not beat it.
TEST_F(DesignOf, ATankThatIsHeldWellOffersNothing) {
  const std::string folder = folderOf("held_well", kTankBrief, "tank.yaml", design(2.0, 40).pi);
  const CommissioningBrief brief = readBrief(inFolder(folder, "brief_in.yaml"));
  const Design d = designed(brief, folder, models_, 2.0);
  EXPECT_LE(std::max(d.pi_figures.worst_peak, d.law_figures.worst_peak),
            std::max(2.0, d.present_peak));
  EXPECT_FALSE(d.offers_law || d.offers_pi);
}

/// Integral time of the PI [h] found for a lag of 240 s with a dead time, sampled every Ts s.
double integralTimeOf(const std::string& name, double Ts) {
  const std::string part = shortText(Ts / 30.0);
  std::string brief_text = kTankBrief;
  brief_text.replace(brief_text.find("heat: 1"), 7, "heat: " + part);
  const std::string folder =
      folderOf(name, brief_text, "tank.yaml",
               "extends: heated_tank\nsampling: {sample_time_s: " + shortText(Ts) + "}\n" +
                   "controller: {type: excitation, signals: [{input: heat, signal: none}]}\n");
  const CommissioningBrief brief = readBrief(inFolder(folder, "brief_in.yaml"));
  ProcessModels models = lagsOf(brief, ProcessKind::kStable, {2.5, 240.0, 0.0, 0.0, 60.0, false},
                                {1.1, 0.9, 1.05, 0.95});
  models.fits.front().one_step = 1e-3;
  const YAML::Node law =
      YAML::Load(designed(brief, folder, models, 2.0, 12).pi)["controller"]["loops"][0];
  return law["kp"].as<double>() / law["ki_per_h"].as<double>();
}

/// Stretches of the scenario last until the loop has settled, however short the samples.
TEST(Design, FindsTheSameIntegralActionWhereSamplesAreShort) {
  const double usual = integralTimeOf("usual", 30.0), often = integralTimeOf("often", 2.0);
  EXPECT_GT(often, usual / 1.5);
  EXPECT_LT(often, usual * 1.5);
}

/// What the brief does not name under `hold` floats, with a zone or without; a brief without `hold`
/// holds all that has no zone.
TEST(CommissioningBrief, HoldsWhatItNames) {
  const auto held = [](const std::string& hold) {
    std::string brief = kColumnBrief;
    brief.replace(brief.find("hold: {T_17: 0, T_4: 0}\n"), 24, hold);
    const std::string folder = folderOf("held", brief, "column.yaml", kColumn);
    return readBrief(inFolder(folder, "brief_in.yaml")).held;
  };
  EXPECT_EQ(held(""), (std::vector<bool>{true, true}));
  EXPECT_EQ(held("zone: {T_4: [-1, 1]}\n"), (std::vector<bool>{true, false}));
  EXPECT_EQ(held("hold: {T_4: 0}\n"), (std::vector<bool>{false, true}));
}

TEST(Commissioning, OfTwoInputsFindsTheCouplingInsideItsLimits) {
  const std::string folder = folderOf("column", kColumnBrief, "column.yaml", kColumn);
  Commissioning c = made(folder);
  c.run(Stage::kModel);
  const OrderedJson test = c.figures(Stage::kTest);
  EXPECT_EQ(test["limits_left"], 0);
  EXPECT_EQ(test["ended"], "enough") << test["reason"];
  const double gains[2][2] = {{-2.2, 1.3}, {-2.8, 4.3}};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      expectWithin(elementOf(c, i, j), "gain", "gain_bound", gains[i][j]);
}

TEST(Commissioning, AStageIsResumedRepeatedAndUndone) {
  const std::string folder = folderOf("again", kTankBrief, "tank.yaml", kTank);
  Commissioning c = made(folder);
  c.run(Stage::kTest);
  EXPECT_TRUE(c.done(Stage::kTest));
  EXPECT_FALSE(c.done(Stage::kModel));
  const std::string test = textOf(inFolder(folder, "test.json")),
                    rows = textOf(inFolder(folder, "test.csv"));
  // Killed after its record was written and before it said so: the same bits again.
  fs::remove(inFolder(folder, "test.json"));
  Commissioning next = made(folder);
  EXPECT_TRUE(next.done(Stage::kWatch));
  EXPECT_FALSE(next.done(Stage::kTest));
  next.run(Stage::kTest);
  EXPECT_EQ(textOf(inFolder(folder, "test.json")), test);
  EXPECT_EQ(textOf(inFolder(folder, "test.csv")), rows);
  next.undo(Stage::kWatch);
  EXPECT_TRUE(next.done(Stage::kBrief));
  EXPECT_FALSE(next.done(Stage::kWatch));
  next.run(Stage::kWatch);
  // Another brief makes all of it new.
  std::string other = kTankBrief;
  other.replace(other.find("seed: 1"), 7, "seed: 2");
  writeText(other, inFolder(folder, "brief_in.yaml"));
  EXPECT_FALSE(made(folder).done(Stage::kWatch));
}

}  // namespace commissioning_test
}  // namespace fpc
