#include "config/read_known.hpp"

#include <algorithm>
#include <limits>

#include "config/structure_file.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/signals.hpp"

namespace fpc {
namespace {

using Eigen::Index;

std::vector<int> readSigns(YamlSection section, const std::vector<std::string>& causes) {
  std::vector<int> signs(causes.size(), 0);
  for (std::size_t j = 0; j < causes.size(); ++j)
    readOption(section, causes[j], signs[j], {{"positive", 1}, {"negative", -1}});
  section.finish();
  const bool any = std::any_of(signs.begin(), signs.end(), [](int sign) { return sign != 0; });
  return any ? signs : std::vector<int>{};
}

KnownRest readSteady(YamlSection& section, const std::vector<std::string>& signals,
                     std::size_t output) {
  KnownRest state;
  state.values = Vector::Constant(static_cast<Index>(signals.size()),
                                  std::numeric_limits<double>::quiet_NaN());
  for (std::size_t j = 0; j < signals.size(); ++j)
    section.number(signals[j], state.values[static_cast<Index>(j)]);
  if (!section.has(signals[output]))
    section.fail(signals[output], "its value (the key is missing)");
  if (!section.has("within")) section.fail("within", "a number > 0 (the key is missing)");
  section.number("within", state.within, Range::positive());
  section.finish();
  return state;
}

}  // namespace

PriorKnowledge readKnown(YamlSection section, const TsModel& names, std::size_t output) {
  auto causes = namesOf(names.inputs);
  for (const auto& name : namesOf(names.disturbances)) causes.push_back(name);
  auto signals = namesOf(names.outputs);
  signals.insert(signals.end(), causes.begin(), causes.end());
  PriorKnowledge known;
  known.gain = readSigns(section.section("gain"), causes);
  known.monotone = readSigns(section.section("monotone"), causes);
  section.number("max_pole", known.max_pole, {0.0, 1.0, true});
  for (auto& state : section.list("steady"))
    known.steady.push_back(readSteady(state, signals, output));
  section.finish();
  return known;
}

std::vector<PriorKnowledge> readKnown(const std::string& text, const Structure& structure) {
  YamlSection top = text.find(':') != std::string::npos ? YamlSection::parse(text, "--known")
                                                        : YamlSection::load(text);
  const TsModel names = structure.emptyModel();
  std::vector<PriorKnowledge> known;
  for (std::size_t i = 0; i < names.outputs.size(); ++i)
    known.push_back(readKnown(top.section(names.outputs[i].name), names, i));
  top.finish();
  return known;
}

}  // namespace fpc
