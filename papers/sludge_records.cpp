#include "papers/sludge_records.hpp"

#include <map>

#include "base/parallel.hpp"
#include "config/structure_file.hpp"
#include "identification/identify.hpp"
#include "papers/run_data.hpp"
#include "papers/runs.hpp"
#include "runtime/run.hpp"

namespace fpc::papers {

DataSet excited(const std::string& loop, const Structure& structure, int seed,
                const Overrides& overrides) {
  const std::string n = std::to_string(seed);
  Overrides set{{"seed", n}};
  set.insert(set.end(), overrides.begin(), overrides.end());
  return dataOf(runLoop(loopOf(loop, set)), structure);
}

const std::vector<TsModel>& modelsOver(const std::string& structure) {
  static std::map<std::string, std::vector<TsModel>> all;
  const auto known = all.find(structure);
  if (known != all.end()) return known->second;
  const Structure read = readStructure(findStructure(structure));
  std::vector<TsModel> models(seeds());
  parallelFor(models.size(), 0, [&](std::size_t i) {
    models[i] = identify(excited("asp_excite", read, static_cast<int>(i) + 1), read).model;
  });
  return all.emplace(structure, std::move(models)).first->second;
}

}  // namespace fpc::papers
