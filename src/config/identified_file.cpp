#include "config/identified_file.hpp"

#include <algorithm>

#include "base/list_of.hpp"
#include "config/model_file.hpp"
#include "config/model_file_parts.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

void write(YAML::Emitter& out, const std::string& key, const std::vector<double>& values) {
  out << YAML::Key << key << YAML::Value;
  writeNumbers(out, values);
}

void writeMember(YAML::Emitter& out, const TsModel& names, const StateMember& m) {
  const RecurrentShape& s = m.shape;
  const auto indices = [&](const std::string& key, const std::vector<Index>& list) {
    write(out, key, std::vector<double>(list.begin(), list.end()));
  };
  out << YAML::BeginMap << YAML::Key << "states" << YAML::Value << s.states;
  out << YAML::Key << "hidden" << YAML::Value << !s.companion;
  out << YAML::Key << "absolute" << YAML::Value << s.absolute;
  out << YAML::Key << "rules" << YAML::Value << s.rules;
  out << YAML::Key << "inputs" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const auto& r : m.exogenous) out << names.text(r);
  out << YAML::EndSeq;
  indices("regressors", s.regressors);
  indices("antecedents", s.antecedents);
  if (s.lower < s.upper) write(out, "limits", {s.lower, s.upper});
  write(out, "parameters", listOf(m.parameters));
  if (!s.companion) {
    const Matrix covariance = m.prior.covariance;
    write(out, "start_mean", listOf(m.prior.mean));
    write(out, "start_covariance", {covariance.data(), covariance.data() + covariance.size()});
    write(out, "start_noise", {m.prior.noise});
    write(out, "lower", listOf(m.prior.lower));
    write(out, "upper", listOf(m.prior.upper));
  }
  out << YAML::EndMap;
}

void writeState(YAML::Emitter& out, const TsModel& names, const StateModel& state) {
  out << YAML::Key << "state" << YAML::Value << YAML::BeginMap;
  for (std::size_t i = 0; i < state.outputs.size(); ++i) {
    const StateOutput& o = state.outputs[i];
    out << YAML::Key << names.outputs[i].name << YAML::Value << YAML::BeginMap;
    write(out, "scaling", {o.shift, o.scale});
    write(out, "inputs_shift", listOf(o.exogenous_shift));
    write(out, "inputs_scale", listOf(o.exogenous_scale));
    write(out, "correction", listOf(o.correction));
    write(out, "interval", {o.free_run_width, o.one_step_width});
    out << YAML::Key << "members" << YAML::Value << YAML::BeginSeq;
    for (const auto& member : o.members) writeMember(out, names, member);
    out << YAML::EndSeq << YAML::EndMap;
  }
  out << YAML::EndMap;
}

const std::string& causeName(const TsModel& model, std::size_t j) {
  return j < model.inputs.size() ? model.inputs[j].name
                                 : model.disturbances[j - model.inputs.size()].name;
}

std::string writeSection(const IdentifiedModel& m) {
  YAML::Emitter out;
  out << YAML::BeginMap << YAML::Key << "identified" << YAML::Value << YAML::BeginMap;
  out << YAML::Key << "outputs" << YAML::Value << YAML::BeginMap;
  for (std::size_t i = 0; i < m.outputs.size(); ++i) {
    const IdentifiedOutput& o = m.outputs[i];
    out << YAML::Key << m.model.outputs[i].name << YAML::Value << YAML::BeginMap;
    out << YAML::Key << "best" << YAML::Value << name(o.best);
    if (o.sensor_lower < o.sensor_upper) write(out, "sensor", {o.sensor_lower, o.sensor_upper});
    write(out, "interval", {o.free_run_width, o.one_step_width});
    if (o.blend_free_run_width > 0.0)
      write(out, "blend_interval", {o.blend_free_run_width, o.blend_one_step_width});
    out << YAML::EndMap;
  }
  out << YAML::EndMap;
  if (m.reach > 0) out << YAML::Key << "reach" << YAML::Value << m.reach;
  if (std::find(m.same_row.begin(), m.same_row.end(), true) != m.same_row.end()) {
    out << YAML::Key << "same_row" << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (std::size_t j = 0; j < m.same_row.size(); ++j)
      if (m.same_row[j]) out << causeName(m.model, j);
    out << YAML::EndSeq;
  }
  if (!m.linear.empty()) {
    out << YAML::Key << "linear" << YAML::Value;
    writeSubmodels(out, m.model, m.linear);
  }
  if (!m.state.outputs.empty()) writeState(out, m.model, m.state);
  out << YAML::EndMap << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

Vector readVector(YamlSection& section, const std::string& key) {
  requireKey(section, key, "a list of numbers");
  std::vector<double> values;
  section.numbers(key, values);
  return Eigen::Map<const Vector>(values.data(), static_cast<Index>(values.size()));
}

std::vector<Index> readIndices(YamlSection& section, const std::string& key) {
  std::vector<Index> indices;
  for (const double v : readVector(section, key)) indices.push_back(static_cast<Index>(v));
  return indices;
}

void readPair(YamlSection& section, const std::string& key, double& first, double& second) {
  if (!section.has(key)) return;
  const Vector pair = readVector(section, key);
  if (pair.size() != 2) section.fail(key, "two numbers");
  first = pair[0];
  second = pair[1];
}

StateMember readMember(YamlSection& section, const TsModel& names) {
  StateMember m;
  RecurrentShape& s = m.shape;
  int states = 1, rules = 1;
  bool hidden = false;
  section.integer("states", states, 1, 20);
  section.integer("rules", rules, 1, 100);
  section.boolean("hidden", hidden);
  section.boolean("absolute", s.absolute);
  s.states = states;
  s.rules = rules;
  s.companion = !hidden;
  m.exogenous = readVariables(section, "inputs", names);
  s.exogenous = static_cast<Index>(m.exogenous.size());
  s.regressors = readIndices(section, "regressors");
  s.antecedents = readIndices(section, "antecedents");
  readPair(section, "limits", s.lower, s.upper);
  m.parameters = readVector(section, "parameters");
  if (hidden) {
    m.prior.mean = readVector(section, "start_mean");
    const Vector covariance = readVector(section, "start_covariance");
    if (covariance.size() != s.states * s.states)
      section.fail("start_covariance", "states x states numbers");
    m.prior.covariance = Eigen::Map<const Matrix>(covariance.data(), s.states, s.states);
    m.prior.noise = readVector(section, "start_noise").sum();
    m.prior.lower = readVector(section, "lower");
    m.prior.upper = readVector(section, "upper");
  }
  section.finish();
  return m;
}

StateOutput readStateOutput(YamlSection section, const TsModel& names) {
  StateOutput o;
  readPair(section, "scaling", o.shift, o.scale);
  o.exogenous_shift = readVector(section, "inputs_shift");
  o.exogenous_scale = readVector(section, "inputs_scale");
  o.correction = readVector(section, "correction");
  readPair(section, "interval", o.free_run_width, o.one_step_width);
  for (auto& member : section.list("members")) o.members.push_back(readMember(member, names));
  section.finish();
  return o;
}

IdentifiedOutput readOutput(YamlSection section) {
  IdentifiedOutput o;
  std::string best = name(o.best);
  section.oneOf("best", best, {"linear", "regressors", "state", "blend"});
  for (const auto kind :
       {ModelKind::kLinear, ModelKind::kRegressors, ModelKind::kState, ModelKind::kBlend})
    if (name(kind) == best) o.best = kind;
  readPair(section, "sensor", o.sensor_lower, o.sensor_upper);
  readPair(section, "interval", o.free_run_width, o.one_step_width);
  readPair(section, "blend_interval", o.blend_free_run_width, o.blend_one_step_width);
  section.finish();
  return o;
}

IdentifiedModel readSections(YamlSection& top) {
  IdentifiedModel m;
  const bool identified = top.has("identified");
  YamlSection section = top.section("identified");
  m.model = readModelSections(top);
  if (!identified) return m;
  YamlSection outputs = section.section("outputs");
  YamlSection linear = section.section("linear"), state = section.section("state");
  const bool has_linear = section.has("linear"), has_state = section.has("state");
  for (const auto& y : m.model.outputs) {
    m.outputs.push_back(readOutput(outputs.section(y.name)));
    const IdentifiedOutput& o = m.outputs.back();
    const bool blend = o.best == ModelKind::kBlend;
    if ((blend || o.blend_free_run_width > 0.0) && !(has_state && o.blend_free_run_width > 0.0))
      outputs.fail(y.name, "for a blend: blend_interval > 0 here, and a section state beside it");
    if (has_linear) m.linear.push_back(readSubmodel(linear, m.model, y.name));
    if (has_state) m.state.outputs.push_back(readStateOutput(state.section(y.name), m.model));
  }
  int reach = 0;
  section.integer("reach", reach, 0, 100000);
  m.reach = reach;
  std::vector<std::string> same;
  section.names("same_row", same);
  const std::size_t causes = m.model.inputs.size() + m.model.disturbances.size();
  for (std::size_t j = 0; !same.empty() && j < causes; ++j)
    m.same_row.push_back(std::find(same.begin(), same.end(), causeName(m.model, j)) != same.end());
  if (std::count(m.same_row.begin(), m.same_row.end(), true) !=
      static_cast<std::ptrdiff_t>(same.size()))
    section.fail("same_row", "inputs or disturbances of this model, each once");
  outputs.finish();
  linear.finish();
  state.finish();
  section.finish();
  try {
    if (has_linear) m.linearModel().validate();
    m.state.validate(m.model);
  } catch (const InputError& e) {
    throw InputError(top.file() + ": identified: " + e.what());
  }
  return m;
}

}  // namespace

IdentifiedModel readIdentified(const std::string& file) {
  YamlSection top = YamlSection::load(file);
  return readSections(top);
}

IdentifiedModel parseIdentified(const std::string& text, const std::string& name) {
  YamlSection top = YamlSection::parse(text, name);
  return readSections(top);
}

std::string writeIdentified(const IdentifiedModel& m) {
  return writeModel(m.model) + (m.outputs.empty() ? "" : writeSection(m));
}

}  // namespace fpc
