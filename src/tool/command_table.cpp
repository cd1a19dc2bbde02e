// fmbpc table DIR...: one table of runs that were written before, over topics or in process.
#include <filesystem>
#include <iostream>

#include "fmbpc/loop/report.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {

int table(const std::vector<std::string>& folders) {
  std::vector<Summary> summaries;
  for (const auto& folder : folders)
    summaries.push_back(readSummary((std::filesystem::path(folder) / "summary.json").string()));
  std::cout << toTable(summaries);
  return 0;
}

}  // namespace fpc::tool
