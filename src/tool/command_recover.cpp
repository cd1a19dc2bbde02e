// `fmbpc recover FOLDER`: the files of runs whose recorder was killed.
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/journal_rows.hpp"
#include "runtime/plot.hpp"
#include "runtime/recover.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {
namespace {

/// A line with the run and the names of the columns; then for each line with the number of a sample
/// a line with the first sample and the number of rows, and the rows as native doubles. Ends with
/// the input.
int followJournal(const std::string& folder) {
  constexpr std::size_t kMostRows = 20000;
  const JournalRows journal((std::filesystem::path(folder) / "journal.bin").string());
  std::printf("%llu %s\n", static_cast<unsigned long long>(journal.runId()),
              join(journal.names(), ",").c_str());
  std::fflush(stdout);
  for (std::uint32_t from = 0; std::cin >> from;) {
    const JournalRows::Rows rows = journal.read(from, kMostRows);
    std::printf("%u %zu\n", rows.first, rows.cells.size() / journal.names().size());
    std::fwrite(rows.cells.data(), sizeof(double), rows.cells.size(), stdout);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace

int recover(const RecoverArguments& arguments) {
  const std::string& folder = arguments.folder;
  require(std::filesystem::is_directory(folder), folder, "an existing folder of a loop's runs");
  if (arguments.rows) return followJournal(folder);
  const std::vector<Recovered> all = recoverFolder(folder);
  require(!all.empty(), folder, "a journal.bin that a recorder left behind, in it or history/");
  bool every = true;
  for (const Recovered& one : all) {
    every = every && one.problem.empty();
    if (!one.problem.empty()) {
      std::fprintf(stderr, "fmbpc: %s stays as it is: %s\n", one.journal.c_str(),
                   one.problem.c_str());
      continue;
    }
    const Summary& summary = one.record.summary;
    std::printf("%s: %s, %u samples%s: %s\n", one.journal.c_str(), summary.loop.c_str(),
                summary.steps, summary.complete ? "" : ", not complete", one.record.folder.c_str());
    const PlotResult plot = arguments.no_plot ? PlotResult{} : drawPlot(one.record.folder);
    if (!plot.warning.empty()) std::fprintf(stderr, "fmbpc: %s\n", plot.warning.c_str());
  }
  return every ? 0 : 1;
}

}  // namespace fpc::tool
