// `fmbpc recover FOLDER`: the files of runs whose recorder was killed.
#include <cstdio>
#include <filesystem>

#include "fmbpc/base/input_error.hpp"
#include "runtime/plot.hpp"
#include "runtime/recover.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {

int recover(const RecoverArguments& arguments) {
  const std::string& folder = arguments.folder;
  require(std::filesystem::is_directory(folder), folder, "an existing folder of a loop's runs");
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
