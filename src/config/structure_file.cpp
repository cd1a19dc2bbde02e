// Reads structure files. Every key is checked, so that a misspelt signal cannot pass for an absent
// one.
#include <algorithm>
#include <optional>

#include "base/time_unit.hpp"
#include "base/yaml_node.hpp"
#include "config/range.hpp"
#include "config/read.hpp"
#include "config/read_known.hpp"
#include "config/structure_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "model/regressor_text.hpp"

namespace fpc {

// The words of a structure file's options, for readOption().
static std::vector<std::string> wordsOf(PartitionMethod) {
  return {"gustafson_kessel", "fuzzy_c_means", "grid"};
}
static std::vector<std::string> wordsOf(Scaling) { return {"deviation", "range", "none"}; }
static std::vector<std::string> wordsOf(ConsequentMethod) {
  return {"local", "global", "recursive"};
}
static std::vector<std::string> wordsOf(ScarceRule) {
  return {"borrow", "drop", "error", "neighbour"};
}
static std::vector<std::string> wordsOf(MissingCells) {
  return {"error", "drop", "interpolate", "hold"};
}
static std::vector<std::string> wordsOf(Implausible) {
  return {"error", "clip", "hold", "interpolate", "drop"};
}

namespace {

constexpr int kLongestOrder = 1000;
const std::string kMultivariate = "multivariate";

std::vector<StructureSignal> readSignals(YamlSection& top, const std::string& key) {
  YamlSection section = top.section(key);
  std::vector<StructureSignal> signals;
  for (const auto& name : section.keys()) {
    StructureSignal signal{{name, "", -kInfinity, kInfinity}, name};
    YamlSection body = section.section(name);
    body.text("column", signal.column);
    body.text("unit", signal.info.unit);
    const bool known = readRange(body, "plausible", signal.info.lower, signal.info.upper);
    if (!known && body.has("implausible")) body.fail("implausible", "the key plausible with it");
    readOption(body, "implausible", signal.implausible);
    body.finish();
    signals.push_back(signal);
  }
  section.finish();
  return signals;
}

std::vector<int> readOrders(YamlSection& section, const std::string& key,
                            const std::vector<std::string>& names, int initial, int lowest) {
  Vector values = Vector::Constant(static_cast<Eigen::Index>(names.size()), initial);
  section.byName(key, values, names, {static_cast<double>(lowest), kLongestOrder, false});
  std::vector<int> orders;
  for (const double value : values) {
    if (value != static_cast<double>(static_cast<int>(value))) section.fail(key, "whole numbers");
    orders.push_back(static_cast<int>(value));
  }
  return orders;
}

std::vector<Regressor> readStructureRegressors(YamlSection& section, const std::string& key,
                                               const TsModel& model) {
  std::vector<std::string> texts;
  section.names(key, texts);
  std::vector<Regressor> regressors;
  for (const auto& text : texts) {
    const auto regressor = parseRegressor(model, text);
    if (!regressor)
      section.fail(key,
                   "variables NAME(k) or NAME(k-LAG) of this file's signals, got '" + text + "'");
    regressors.push_back(*regressor);
  }
  return regressors;
}

std::vector<Regressor> readDependence(YamlSection& section, const TsModel& model) {
  const bool orders = section.has("N_y") || section.has("N_u") || section.has("N_d");
  if (section.has("regressors")) {
    if (orders) section.fail("regressors", "either regressors or N_y, N_u, N_d");
    return readStructureRegressors(section, "regressors", model);
  }
  auto channels = namesOf(model.inputs);
  for (const auto& name : namesOf(model.disturbances)) channels.push_back(name);
  const auto N_y = readOrders(section, "N_y", namesOf(model.outputs), 0, 0);
  const auto N_u = readOrders(section, "N_u", channels, 0, 0);
  const auto N_d = readOrders(section, "N_d", channels, 1, 1);
  return regressorsOf(N_y, N_u, N_d, static_cast<int>(model.inputs.size()));
}

void readClusters(YamlSection& section, OutputStructure& structure) {
  if (!section.has("clusters")) return;
  const YAML::Node node = section.raw("clusters");
  std::vector<double> range;
  if (node.IsScalar() && node.Scalar() == "auto") {
    range = {2.0, 8.0};
  } else if (node.IsSequence()) {
    section.numbers("clusters", range);
    if (range.size() != 2) section.fail("clusters", "a number, auto or [fewest, most]");
  } else {
    int number = 1;
    section.integer("clusters", number, 1);
    range.assign(2, static_cast<double>(number));
  }
  structure.clusters_min = static_cast<int>(range[0]);
  structure.clusters_max = static_cast<int>(range[1]);
}

Membership readMembership(YamlSection section) {
  const auto shapes = section.keys();
  if (shapes.size() != 1)
    section.fail("set", "one shape with its parameters, like {gaussian: [0, 1]}");
  Membership set;
  set.shape = membershipShape(shapes.front());
  section.numbers(shapes.front(), set.parameters);
  set.validate(section.where(shapes.front()));
  return set;
}

void readSets(YamlSection& section, const TsModel& model, OutputStructure& structure) {
  if (!section.has("sets")) return;
  YamlSection sets = section.section("sets");
  for (const auto& variable : structure.antecedents) {
    structure.sets.emplace_back();
    for (auto& set : sets.list(model.text(variable)))
      structure.sets.back().push_back(readMembership(set));
  }
  sets.finish();
}

void readSubmodelKnown(YamlSection& section, const TsModel& model, const std::string& output,
                       std::vector<PriorKnowledge>* known) {
  std::size_t own = 0;
  while (model.outputs[own].name != output) ++own;
  const PriorKnowledge stated = readKnown(section.section("known"), model, own);
  if (known != nullptr)
    known->push_back(stated);
  else if (!stated.empty())
    section.fail("known", "nothing here; only `fmbpc identify` keeps such statements");
}

OutputStructure readSubmodel(YamlSection& submodels, const TsModel& model,
                             const std::string& output, std::vector<PriorKnowledge>* known) {
  if (!submodels.has(output))
    submodels.fail(output, "what this output depends on (the key is missing)");
  YamlSection section = submodels.section(output);
  OutputStructure structure;
  structure.regressors = readDependence(section, model);
  structure.antecedents = structure.regressors;
  if (section.has("antecedents"))
    structure.antecedents = readStructureRegressors(section, "antecedents", model);
  readClusters(section, structure);
  readSets(section, model, structure);
  readSubmodelKnown(section, model, output, known);
  section.finish();
  return structure;
}

void readPartition(YamlSection section, PartitionParams& p) {
  readOption(section, "method", p.method);
  std::string shape = name(p.membership);
  section.oneOf("membership", shape, {"gaussian", "exponential", kMultivariate});
  p.multivariate = shape == kMultivariate;
  if (!p.multivariate) p.membership = membershipShape(shape);
  readOption(section, "scaling", p.scaling);
  section.boolean("with_output", p.with_output);
  section.number("fuzziness", p.fuzziness);
  section.number("regularisation", p.regularisation);
  section.number("width", p.width);
  section.integer("max_iterations", p.max_iterations, 1);
  section.number("tolerance", p.tolerance, Range::positive());
  section.integer("restarts", p.restarts, 1);
  section.seed("seed", p.seed);
  section.number("held_out", p.held_out);
  section.finish();
}

void readConsequents(YamlSection section, ConsequentParams& c) {
  readOption(section, "method", c.method);
  section.number("ridge", c.ridge);
  section.number("weight_power", c.weight_power, Range::positive());
  section.number("weight_threshold", c.weight_threshold, {0.0, 1.0});
  section.number("samples_per_coefficient", c.samples_per_coefficient);
  section.number("max_condition", c.max_condition);
  readOption(section, "scarce", c.scarce);
  section.number("forgetting", c.forgetting);
  section.integer("free_run_iterations", c.free_run_iterations, 0);
  section.number("one_step_weight", c.one_step_weight, Range::notNegative());
  section.finish();
}

void readRepair(YamlSection section, RepairParams& r) {
  readOption(section, "missing", r.missing);
  section.boolean("sort_time", r.sort_time);
  section.boolean("drop_constant", r.drop_constant);
  section.finish();
}

void readTime(YamlSection section, Structure& structure) {
  section.text("column", structure.time_column);
  section.oneOf("unit", structure.time_unit, timeUnits());
  section.finish();
}

/// A model that takes the clock for a signal explains everything by it.
void requireNoTimes(const YamlSection& top, const Structure& structure) {
  const std::pair<const char*, const std::vector<StructureSignal>*> groups[] = {
      {"outputs", &structure.outputs},
      {"inputs", &structure.inputs},
      {"disturbances", &structure.disturbances}};
  for (const auto& [key, signals] : groups)
    for (const StructureSignal& signal : *signals)
      if (!structure.time_column.empty() && signal.column == structure.time_column)
        throw InputError(top.where(key) + "." + signal.info.name +
                         ": expected another column than time.column, '" + signal.column + "'");
}

void readValidation(YamlSection section, ValidationParams& v) {
  section.integer("correlation_lags", v.correlation_lags, 1);
  section.number("confidence", v.confidence);
  section.finish();
}

Structure readSections(YamlSection& top, std::vector<PriorKnowledge>* known) {
  Structure structure;
  top.text("name", structure.name);
  if (!top.has("sample_time_s")) top.fail("sample_time_s", "a number > 0 (the key is missing)");
  top.number("sample_time_s", structure.sample_time_s, Range::positive());
  readTime(top.section("time"), structure);
  YamlSection csv = top.section("csv");
  readCsvFormat(csv, structure.csv);
  csv.finish();
  structure.outputs = readSignals(top, "outputs");
  structure.inputs = readSignals(top, "inputs");
  structure.disturbances = readSignals(top, "disturbances");
  requireNoTimes(top, structure);
  readPartition(top.section("partition"), structure.partition);
  readConsequents(top.section("consequents"), structure.consequents);
  readRepair(top.section("repair"), structure.repair);
  readValidation(top.section("validation"), structure.validation);
  const TsModel model = structure.emptyModel();
  YamlSection submodels = top.section("submodels");
  for (const auto& output : structure.outputs)
    structure.submodels.push_back(readSubmodel(submodels, model, output.info.name, known));
  submodels.finish();
  top.finish();
  try {
    structure.validate();
  } catch (const InputError& e) {
    throw InputError(top.file() + ": " + e.what());
  }
  return structure;
}

}  // namespace

Structure readStructure(const std::string& file, std::vector<PriorKnowledge>* known) {
  YamlSection top = YamlSection::load(file);
  return readSections(top, known);
}

Structure parseStructure(const std::string& text, const std::string& name,
                         std::vector<PriorKnowledge>* known) {
  YamlSection top = YamlSection::parse(text, name);
  return readSections(top, known);
}

}  // namespace fpc
