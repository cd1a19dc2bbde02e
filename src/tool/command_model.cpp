// fmbpc model FILE: what a model file holds and where it should not be trusted.
#include <filesystem>
#include <iostream>

#include "base/near_names.hpp"
#include "base/ordered_json.hpp"
#include "config/loop_file.hpp"
#include "config/model_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "tool/commands.hpp"
#include "tool/model_plots.hpp"
#include "tool/model_points.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;
using Json = OrderedJson;

void print(const TsModel& model, const std::vector<RuleRemark>& remarks) {
  std::cout << model.name << ": " << model.source << "\nsample time " << model.sample_time_s
            << " s\n";
  for (std::size_t i = 0; i < model.outputs.size(); ++i)
    std::cout << "  " << model.outputs[i].name << ": " << model.submodels[i].rules.size()
              << " rules, " << model.submodels[i].antecedents.size() << " antecedents, "
              << model.submodels[i].regressors.size() << " regressors\n";
  for (const auto& remark : remarks)
    std::cout << "  " << remark.output << " rule " << remark.rule << ": " << remark.text << "\n";
  const std::string points = pointsTable(model);
  if (!points.empty()) std::cout << "\n" << points;
}

}  // namespace

std::string findModel(const std::string& name) {
  if (fs::is_regular_file(name)) return name;
  for (const auto& folder : configFolders())
    for (const auto& ending : {"", ".yaml"}) {
      const fs::path file = fs::path(folder) / "model" / (name + ending);
      if (fs::is_regular_file(file)) return file.string();
    }
  return name;  // readModel() says that it is not there
}

std::string requireModel(const std::string& name) {
  const std::string file = findModel(name);
  if (fs::exists(file)) return file;
  const auto known = modelNames();
  throw InputError("model '" + name + "': expected a path or a name from config/model" +
                   nearNames(name, known, "there are " + join(known)));
}

int model(const std::string& file, bool json, const std::string& plots) {
  const TsModel model = readModel(requireModel(file));
  const auto remarks = reportModel(model);
  if (!plots.empty()) plotModel(model, plots);
  if (!json) {
    print(model, remarks);
    if (!plots.empty()) std::cout << "written: " << plots << "\n";
    return 0;
  }
  Json report{
      {"name", model.name}, {"source", model.source}, {"sample_time_s", model.sample_time_s}};
  report["remarks"] = Json::array();
  for (const auto& remark : remarks)
    report["remarks"].push_back(
        {{"output", remark.output}, {"rule", remark.rule}, {"text", remark.text}});
  report["points"] = pointsJson(model);
  std::cout << report.dump(2) << "\n";
  return 0;
}

}  // namespace fpc::tool
