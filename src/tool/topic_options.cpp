#include "tool/topic_options.hpp"

namespace fpc::tool {
namespace {

constexpr char kWatch[] = "watch", kPage[] = "page", kReproduce[] = "reproduce";

}  // namespace

void addReplay(CLI::App& app, ReplayArguments& a, std::function<int()>& chosen) {
  CLI::App* command = app.add_subcommand(
      "replay", "Plays a recorded run through controller and optimizer and compares their actions");
  command->add_option("BAG", a.bag, "bag of loop.launch record:=true")->required();
  command->add_option("LOOP", a.loop, "name or path, instead of the loop in the bag");
  command->add_option("--set", a.set, "KEY.PATH=VALUE over LOOP, may be repeated")
      ->allow_extra_args(false);
  command->add_option("--run", a.run, "which, from 1, of a bag with several (after a reset)")
      ->check(CLI::PositiveNumber);
  command->add_flag("--json", a.json, "print one JSON object and nothing else");
  command->footer("Example: fmbpc replay ~/.ros/fmbpc/asp_case1_clp/loop.bag\n");
  command->callback([&a, &chosen] { chosen = [&a] { return fpc::tool::replay(a); }; });
}

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

int runOther(int argc, char** argv) {
  if (argc < 2) return -1;
  const std::string command = argv[1];
  const std::vector<std::string> words(argv + 2, argv + argc);
  if (command == kWatch) return watch(words);
  if (command == kPage) return page(words);
  return command == kReproduce ? reproduce(words) : -1;
}

void refuseEmptyNames(CLI::App& app) {
  const CLI::Validator named(
      [](const std::string& text) { return text.empty() ? "expected a name, got none" : ""; }, "");
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
    for (const char* name : {"--out", "--plots", "--commands", "--validate"})
      if (CLI::Option* option = command->get_option_no_throw(name)) option->check(named);
}

}  // namespace fpc::tool
