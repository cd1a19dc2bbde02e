// fmbpc table DIR...: one table of runs that were written before, over topics or in process.
#include <filesystem>
#include <iostream>

#include "runtime/report.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {

int table(const std::vector<std::string>& folders, bool brief) {
  std::vector<Summary> summaries;
  for (const auto& folder : folders)
    summaries.push_back(readSummary((std::filesystem::path(folder) / "summary.json").string()));
  std::cout << (brief ? shortTable(summaries) : toTable(summaries));
  printVerdict(summaries);
  return 0;
}

void printVerdict(const std::vector<Summary>& summaries) {
  const std::string verdict = verdictOf(summaries);
  if (!verdict.empty()) std::cout << "\n" << verdict << "\n";
}

}  // namespace fpc::tool
