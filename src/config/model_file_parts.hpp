// What the parts of the model file's reader and writer share.
#pragma once

#include <string>
#include <vector>

#include "base/yaml_node.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc {

void requireKey(const YamlSection& section, const std::string& key, const std::string& expected);
/// Like section(), but the key must be there and hold a mapping; the error names the line.
YamlSection requiredMapping(YamlSection& section, const std::string& key,
                            const std::string& expected);
double finiteNumber(YamlSection& section, const std::string& key);

std::string yamlNumber(double value);
void writeNumbers(YAML::Emitter& out, const std::vector<double>& values);

/// The memberships of a rule, its key `when`: one set per variable, or `center` and
/// `inverse_covariance`.
void readWhen(YamlSection& rule_section, const TsModel& model, const OutputModel& output,
              Rule& rule);
void writeWhen(YAML::Emitter& out, const TsModel& model, const OutputModel& output,
               const Rule& rule);

/// The submodel of one output; and all of them as a mapping of outputs.
OutputModel readSubmodel(YamlSection& submodels, const TsModel& model, const std::string& output);
void writeSubmodels(YAML::Emitter& out, const TsModel& names,
                    const std::vector<OutputModel>& submodels);
/// A list of variables NAME(k) or NAME(k-LAG).
std::vector<Regressor> readVariables(YamlSection& section, const std::string& key,
                                     const TsModel& model);
/// Key `domain`: where the identification data were; nothing is written for an empty one.
void readDomain(YamlSection& top, TsModel& model);
void writeDomain(YAML::Emitter& out, const ModelDomain& domain);
/// The whole file but its section `identified`, which is left to readIdentified().
TsModel readModelSections(YamlSection& top);

}  // namespace fpc
