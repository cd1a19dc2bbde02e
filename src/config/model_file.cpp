// Reads and writes model files. Every key is checked, so that a misspelt regressor cannot pass for
// a zero coefficient.
#include "config/model_file.hpp"

#include <algorithm>
#include <cmath>

#include "config/model_file_parts.hpp"
#include "config/range.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/model/model_match.hpp"
#include "model/regressor_text.hpp"

namespace fpc {
namespace {

std::vector<SignalInfo> readSignals(YamlSection& top, const std::string& key, bool required) {
  std::vector<SignalInfo> signals;
  if (!required && (!top.has(key) || top.raw(key).IsNull())) return signals;
  YamlSection section = requiredMapping(top, key, "a mapping of names to units");
  for (const auto& signal : section.keys()) {
    std::string unit;
    section.text(signal, unit);
    signals.push_back({signal, unit, -kInfinity, kInfinity});
  }
  return signals;
}

void readRanges(YamlSection& top, TsModel& model) {
  YamlSection ranges = top.section("ranges");
  for (auto* signals : {&model.outputs, &model.inputs, &model.disturbances})
    for (auto& signal : *signals) readRange(ranges, signal.name, signal.lower, signal.upper);
  ranges.finish();
}

std::vector<Regressor> readRegressors(YamlSection& section, const std::string& key,
                                      const TsModel& model) {
  const std::string form =
      "a list of variables NAME(k) or NAME(k-LAG) of this model's signals, each once";
  requireKey(section, key, form);
  std::vector<std::string> texts;
  section.names(key, texts);
  std::vector<Regressor> regressors;
  for (const auto& text : texts) {
    const auto regressor = parseRegressor(model, text);
    if (!regressor ||
        std::find(regressors.begin(), regressors.end(), *regressor) != regressors.end())
      section.fail(key, form + ", got '" + text + "'");
    regressors.push_back(*regressor);
  }
  return regressors;
}

Rule readRule(YamlSection& section, const TsModel& model, const OutputModel& output) {
  Rule rule;
  readWhen(section, model, output, rule);
  YamlSection then =
      requiredMapping(section, "then", "a mapping of regressors and offset to numbers");
  rule.coefficients.resize(static_cast<Eigen::Index>(output.regressors.size()));
  for (std::size_t i = 0; i < output.regressors.size(); ++i)
    rule.coefficients[static_cast<Eigen::Index>(i)] =
        finiteNumber(then, model.text(output.regressors[i]));
  rule.offset = finiteNumber(then, "offset");
  then.finish();
  section.seed("data_count", rule.data_count);
  section.finish();
  return rule;
}

}  // namespace

std::vector<Regressor> readVariables(YamlSection& section, const std::string& key,
                                     const TsModel& model) {
  return readRegressors(section, key, model);
}

OutputModel readSubmodel(YamlSection& submodels, const TsModel& model, const std::string& output) {
  YamlSection section = requiredMapping(submodels, output, "the submodel of this output");
  OutputModel submodel;
  submodel.antecedents = readRegressors(section, "antecedents", model);
  submodel.regressors = readRegressors(section, "regressors", model);
  requireKey(section, "rules", "a list of rules");
  for (auto& rule : section.list("rules"))
    submodel.rules.push_back(readRule(rule, model, submodel));
  if (submodel.rules.empty()) section.fail("rules", "at least one rule");
  section.finish();
  return submodel;
}

TsModel readModelSections(YamlSection& top) {
  TsModel model;
  top.text("name", model.name);
  top.text("source", model.source);
  requireKey(top, "sample_time_s", "a number > 0");
  top.number("sample_time_s", model.sample_time_s, Range::positive());
  model.outputs = readSignals(top, "outputs", true);
  model.inputs = readSignals(top, "inputs", false);
  model.disturbances = readSignals(top, "disturbances", false);
  readRanges(top, model);
  readDomain(top, model);
  YamlSection submodels = requiredMapping(top, "submodels", "a mapping of outputs to submodels");
  for (const auto& output : model.outputs)
    model.submodels.push_back(readSubmodel(submodels, model, output.name));
  submodels.finish();
  top.markRead("identified");
  top.finish();
  try {
    model.validate();
  } catch (const InputError& e) {
    throw InputError(top.file() + ": " + e.what());
  }
  return model;
}

namespace {

void writeSignals(YAML::Emitter& out, const std::string& key,
                  const std::vector<SignalInfo>& signals) {
  out << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginMap;
  for (const auto& signal : signals) out << YAML::Key << signal.name << YAML::Value << signal.unit;
  out << YAML::EndMap;
}

void writeRanges(YAML::Emitter& out, const TsModel& model) {
  std::vector<SignalInfo> bounded;
  for (const auto* signals : {&model.outputs, &model.inputs, &model.disturbances})
    for (const auto& s : *signals)
      if (std::isfinite(s.lower) || std::isfinite(s.upper)) bounded.push_back(s);
  if (bounded.empty()) return;
  out << YAML::Key << "ranges" << YAML::Value << YAML::BeginMap;
  for (const auto& s : bounded) {
    out << YAML::Key << s.name << YAML::Value;
    writeNumbers(out, {s.lower, s.upper});
  }
  out << YAML::EndMap;
}

void writeRegressors(YAML::Emitter& out, const std::string& key, const TsModel& model,
                     const std::vector<Regressor>& regressors) {
  out << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const auto& regressor : regressors) out << model.text(regressor);
  out << YAML::EndSeq;
}

void writeRule(YAML::Emitter& out, const TsModel& model, const OutputModel& submodel,
               const Rule& rule) {
  out << YAML::BeginMap;
  writeWhen(out, model, submodel, rule);
  out << YAML::Key << "then" << YAML::Value << YAML::Flow << YAML::BeginMap;
  for (std::size_t i = 0; i < submodel.regressors.size(); ++i)
    out << YAML::Key << model.text(submodel.regressors[i]) << YAML::Value
        << yamlNumber(rule.coefficients[static_cast<Eigen::Index>(i)]);
  out << YAML::Key << "offset" << YAML::Value << yamlNumber(rule.offset) << YAML::EndMap;
  if (rule.data_count != 0) out << YAML::Key << "data_count" << YAML::Value << rule.data_count;
  out << YAML::EndMap;
}

}  // namespace

void writeSubmodels(YAML::Emitter& out, const TsModel& names,
                    const std::vector<OutputModel>& submodels) {
  out << YAML::BeginMap;
  for (std::size_t i = 0; i < submodels.size(); ++i) {
    const OutputModel& submodel = submodels[i];
    out << YAML::Key << names.outputs[i].name << YAML::Value << YAML::BeginMap;
    writeRegressors(out, "antecedents", names, submodel.antecedents);
    writeRegressors(out, "regressors", names, submodel.regressors);
    out << YAML::Key << "rules" << YAML::Value << YAML::BeginSeq;
    for (const auto& rule : submodel.rules) writeRule(out, names, submodel, rule);
    out << YAML::EndSeq << YAML::EndMap;
  }
  out << YAML::EndMap;
}

TsModel readModel(const std::string& file) {
  YamlSection top = YamlSection::load(file);
  return readModelSections(top);
}

TsModel parseModel(const std::string& text, const std::string& name) {
  YamlSection top = YamlSection::parse(text, name);
  return readModelSections(top);
}

std::string writeModel(const TsModel& matched) {
  const TsModel model = asIdentified(matched);
  YAML::Emitter out;
  out << YAML::BeginMap;
  out << YAML::Key << "name" << YAML::Value << model.name;
  out << YAML::Key << "source" << YAML::Value << model.source;
  out << YAML::Key << "sample_time_s" << YAML::Value << yamlNumber(model.sample_time_s);
  writeSignals(out, "outputs", model.outputs);
  writeSignals(out, "inputs", model.inputs);
  writeSignals(out, "disturbances", model.disturbances);
  writeRanges(out, model);
  writeDomain(out, model.domain);
  out << YAML::Key << "submodels" << YAML::Value;
  writeSubmodels(out, model, model.submodels);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace fpc
