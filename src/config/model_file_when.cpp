// Memberships of rules in model files, by the names of their variables.
#include <cmath>

#include "config/model_file_parts.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Eigen::Index;

const char* const kCenter = "center";
const char* const kInverse = "inverse_covariance";

Membership readMembership(YamlSection& when, const std::string& key) {
  YamlSection set = requiredMapping(when, key, "a membership like {exponential: [1, 2, 3, 4]}");
  const auto shapes = set.keys();
  if (shapes.size() != 1) when.fail(key, "one membership");
  Membership membership;
  try {
    membership.shape = membershipShape(shapes.front());
  } catch (const InputError& e) {
    throw InputError(set.where(shapes.front()) + ": " + e.what());
  }
  set.numbers(shapes.front(), membership.parameters);
  membership.validate(set.where(shapes.front()));
  return membership;
}

MultivariateMembership readMultivariate(YamlSection& when, const std::string& where,
                                        const TsModel& model, const OutputModel& output) {
  const auto n = static_cast<Index>(output.antecedents.size());
  MultivariateMembership set{Vector(n), Matrix(n, n)};
  YamlSection center = requiredMapping(when, kCenter, "a mapping of antecedents to numbers");
  YamlSection rows = requiredMapping(when, kInverse, "a mapping of antecedents to rows of numbers");
  for (Index i = 0; i < n; ++i) {
    const std::string variable = model.text(output.antecedents[static_cast<std::size_t>(i)]);
    set.center[i] = finiteNumber(center, variable);
    std::vector<double> row;
    rows.numbers(variable, row);
    if (row.size() != static_cast<std::size_t>(n))
      rows.fail(variable, std::to_string(n) + " numbers, in the order of the antecedents");
    set.inverse_covariance.row(i) = Eigen::Map<const Vector>(row.data(), n).transpose();
  }
  center.finish();
  rows.finish();
  set.validate(where, n);
  return set;
}

void writeMultivariate(YAML::Emitter& out, const std::vector<std::string>& variables,
                       const MultivariateMembership& set) {
  out << YAML::Key << kCenter << YAML::Value << YAML::Flow << YAML::BeginMap;
  for (std::size_t i = 0; i < variables.size(); ++i)
    out << YAML::Key << variables[i] << YAML::Value
        << yamlNumber(set.center[static_cast<Index>(i)]);
  out << YAML::EndMap << YAML::Key << kInverse << YAML::Value << YAML::BeginMap;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const Vector row = set.inverse_covariance.row(static_cast<Index>(i)).transpose();
    out << YAML::Key << variables[i] << YAML::Value;
    writeNumbers(out, {row.data(), row.data() + row.size()});
  }
  out << YAML::EndMap;
}

void writeSets(YAML::Emitter& out, const std::vector<std::string>& variables, const Rule& rule) {
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const Membership& set = rule.antecedents[i];
    out << YAML::Key << variables[i] << YAML::Value << YAML::Flow << YAML::BeginMap;
    out << YAML::Key << name(set.shape) << YAML::Value;
    writeNumbers(out, set.parameters);
    out << YAML::EndMap;
  }
}

}  // namespace

void requireKey(const YamlSection& section, const std::string& key, const std::string& expected) {
  if (!section.has(key)) section.fail(key, expected + " (the key is missing)");
}

/// Like section(), but the key must be there and hold a mapping; the error names the line.
YamlSection requiredMapping(YamlSection& section, const std::string& key,
                            const std::string& expected) {
  requireKey(section, key, expected);
  if (!section.raw(key).IsMap()) section.fail(key, expected);
  return section.section(key);
}

double finiteNumber(YamlSection& section, const std::string& key) {
  requireKey(section, key, "a finite number");
  double value = 0.0;
  section.number(key, value);
  if (!std::isfinite(value)) section.fail(key, "a finite number");
  return value;
}

std::string yamlNumber(double value) {
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  return exactText(value);
}

void writeNumbers(YAML::Emitter& out, const std::vector<double>& values) {
  out << YAML::Flow << YAML::BeginSeq;
  for (const double value : values) out << yamlNumber(value);
  out << YAML::EndSeq;
}

void readWhen(YamlSection& rule_section, const TsModel& model, const OutputModel& output,
              Rule& rule) {
  if (output.antecedents.empty() && !rule_section.has("when")) return;
  YamlSection when =
      requiredMapping(rule_section, "when", "a mapping of antecedent variables to memberships");
  if (when.has(kCenter) || when.has(kInverse))
    rule.multivariate = readMultivariate(when, rule_section.where("when"), model, output);
  else
    for (const auto& variable : output.antecedents)
      rule.antecedents.push_back(readMembership(when, model.text(variable)));
  when.finish();
}

void writeWhen(YAML::Emitter& out, const TsModel& model, const OutputModel& output,
               const Rule& rule) {
  if (rule.antecedents.empty() && !rule.multivariate) return;
  std::vector<std::string> variables;
  for (const auto& variable : output.antecedents) variables.push_back(model.text(variable));
  out << YAML::Key << "when" << YAML::Value << YAML::BeginMap;
  if (rule.multivariate)
    writeMultivariate(out, variables, *rule.multivariate);
  else
    writeSets(out, variables, rule);
  out << YAML::EndMap;
}

}  // namespace fpc
