// Key `domain` of model files: where the identification data were.
#include <cmath>

#include "config/model_file_parts.hpp"

namespace fpc {

void readDomain(YamlSection& top, TsModel& model) {
  if (!top.has("domain")) return;
  YamlSection section = requiredMapping(top, "domain", "a mapping of radius, scale and centres");
  ModelDomain& domain = model.domain;
  std::vector<double> scale;
  for (const char* key : {"radius", "scale", "centres"}) requireKey(section, key, "a value");
  section.number("radius", domain.radius, Range::positive());
  section.numbers("scale", scale);
  domain.scale = Eigen::Map<const Vector>(scale.data(), static_cast<Eigen::Index>(scale.size()));
  const YAML::Node rows = section.raw("centres");
  const auto n = static_cast<Eigen::Index>(scale.size());
  if (!rows.IsSequence()) section.fail("centres", "a list of points");
  domain.centres.resize(n, static_cast<Eigen::Index>(rows.size()));
  for (std::size_t c = 0; c < rows.size(); ++c) {
    if (!rows[c].IsSequence() || rows[c].size() != scale.size())
      section.fail("centres", "points of " + std::to_string(n) + " numbers");
    for (std::size_t j = 0; j < scale.size(); ++j)
      domain.centres(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(c)) =
          rows[c][j].as<double>(std::nan(""));
  }
  section.finish();
}

void writeDomain(YAML::Emitter& out, const ModelDomain& domain) {
  if (domain.empty()) return;
  const auto numbers = [](const Vector& v) {
    return std::vector<double>(v.data(), v.data() + v.size());
  };
  out << YAML::Key << "domain" << YAML::Value << YAML::BeginMap;
  out << YAML::Key << "radius" << YAML::Value << yamlNumber(domain.radius);
  out << YAML::Key << "scale" << YAML::Value;
  writeNumbers(out, numbers(domain.scale));
  out << YAML::Key << "centres" << YAML::Value << YAML::BeginSeq;
  for (Eigen::Index c = 0; c < domain.centres.cols(); ++c)
    writeNumbers(out, numbers(domain.centres.col(c)));
  out << YAML::EndSeq << YAML::EndMap;
}

}  // namespace fpc
