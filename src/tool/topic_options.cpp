#include "tool/topic_options.hpp"

#include <filesystem>

#include "fmbpc/base/input_error.hpp"
#include "tool/become.hpp"
#include "tool/design_words.hpp"

namespace fpc::tool {
namespace {

constexpr char kWatch[] = "watch", kPage[] = "page", kReproduce[] = "reproduce";

/// A program that is built apart, with these words behind its name.
[[noreturn]] void becomeNeighbour(const std::string& name, const std::string& command,
                                  const std::vector<std::string>& words) {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / name;
  require(std::filesystem::exists(program), command,
          "the program " + name + " beside this one: `scripts/build" +
              (name == "fmbpc_papers" ? " " + name : "") + "` makes it");
  std::vector<std::string> line{program.string()};
  line.insert(line.end(), words.begin(), words.end());
  become(line);
}

}  // namespace

void addRecover(CLI::App& app, RecoverArguments& a, std::function<int()>& chosen) {
  CLI::App* command = app.add_subcommand(
      "recover", "Makes the files of runs over topics whose recorder was killed (journal.bin)");
  command->add_option("FOLDER", a.folder, "folder `out` of the launch")->required();
  command->add_flag("--no-plot", a.no_plot, "no plot.png");
  command->add_flag("--rows", a.rows,
                    "leave the journal as it is and answer each sample number on the input with "
                    "the rows from there on (for programs, see docs/recording.md)");
  command->footer("Example: fmbpc recover ~/.ros/fmbpc/asp_case1_clp\n");
  command->callback([&a, &chosen] { chosen = [&a] { return fpc::tool::recover(a); }; });
}

void addWatch(CLI::App& app) {
  app.add_subcommand(kWatch, "Shows a running loop from its topics: in the terminal, or --window");
}

void addPage(CLI::App& app) {
  app.add_subcommand(kPage, "Writes a finished run, a folder or a bag, as one HTML file");
}

void addReproduce(CLI::App& app) {
  app.add_subcommand(kReproduce, "Tables and figures of the papers: paper | here | verdict");
}

void addDesign(CLI::App& app) {
  for (const DesignWord& w : kDesignWords) app.add_subcommand(w.word, w.text);
}

int runOther(int argc, char** argv) {
  if (argc < 2) return -1;
  const std::string command = argv[1];
  const std::vector<std::string> words(argv + 2, argv + argc);
  if (command == kWatch) return watch(words);
  if (command == kPage) return page(words);
  if (command == kReproduce) becomeNeighbour("fmbpc_papers", command, words);
  if (designText(command)) becomeNeighbour("fmbpc_design", command, {argv + 1, argv + argc});
  return -1;
}

}  // namespace fpc::tool
