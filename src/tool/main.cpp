// The command-line tool `fmbpc`: what runs loops and reads their records. Its other commands are
// programs beside it.
#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <functional>
#include <string>

#include "tool/commands.hpp"
#include "tool/program.hpp"
#include "tool/ranks.hpp"
#include "tool/topic_options.hpp"

namespace {

std::function<int()> asked_for;

void addRun(CLI::App& app, fpc::tool::RunArguments& a) {
  CLI::App* run =
      app.add_subcommand("run", "Closes loops in this process and prints their indices");
  CLI::Option* loops = run->add_option("LOOP", a.loops, "names of config/loop, or paths");
  CLI::Option* plant =
      run->add_option("--plant", a.plant,
                      "plant file: all its loops with their links (docs/plant_loops.md)")
          ->excludes(loops);
  run->add_option("--set", a.set, "KEY.PATH=VALUE over the loop file, may be repeated")
      ->allow_extra_args(false);
  run->add_option("--out", a.out,
                  "folder for trajectory.csv, summary.json, plot.png; of several loops one below "
                  "it each, with comparison.png (default: nothing is written)");
  run->add_option("--commands", a.commands,
                  "file of what an operator does at which time (docs/operators.md)")
      ->excludes(plant);
  run->add_flag("--on-model", a.on_model,
                "the loop's model, with its noise, in the place of its plant: a rehearsal")
      ->excludes(plant);
  run->add_flag("--json", a.json, "print one JSON object and nothing else");
  run->add_flag("--no-plot", a.no_plot, "no plot.png");
  run->footer("Example: fmbpc run asp_best asp_case1_pi_x_best --out results\n");
  run->callback([&a] {
    if (a.loops.empty() && a.plant.empty()) throw CLI::RequiredError("LOOP");
    asked_for = [&a] { return fpc::tool::run(a); };
  });
}

void addResolve(CLI::App& app, fpc::tool::RunArguments& a) {
  CLI::App* resolve = app.add_subcommand(
      "resolve", "Merges and checks a loop file and prints what nodes would read");
  CLI::Option* loop = resolve->add_option("LOOP", a.loops, "name or path")->expected(1);
  resolve->add_option("--plant", a.plant, "plant file: lists its loops and their links")
      ->excludes(loop);
  resolve->add_option("--set", a.set, "KEY.PATH=VALUE, may be repeated")->allow_extra_args(false);
  resolve->add_flag("--on-model", a.on_model, "with the loop's model in the place of its plant");
  resolve->add_option("--sets", a.sets, "several of them in one text, separated by spaces");
  resolve->footer("Example: fmbpc resolve asp_case1 --set controller.coincidence_steps=3\n");
  resolve->callback([&a] {
    if (a.loops.empty() && a.plant.empty()) throw CLI::RequiredError("LOOP");
    asked_for = [&a] {
      if (!a.plant.empty()) return fpc::tool::resolvePlant(a.plant, a.set, a.sets);
      return fpc::tool::resolve(a.loops.front(), a.set, a.sets, a.on_model);
    };
  });
}

void addLoops(CLI::App& app, fpc::tool::LoopsArguments& a) {
  CLI::App* loops =
      app.add_subcommand("loops", "Lists the loop files with title, plant and controller");
  loops->add_option("WORDS", a.words, "only loops that contain all of them (default: all loops)");
  loops->add_flag("--names", a.names_only, "names only, one a line");
  loops->add_flag("--json", a.json, "print one JSON object and nothing else");
  loops->footer("Example: fmbpc loops column clp\n");
  loops->callback(
      [&a] { asked_for = [&a] { return fpc::tool::loops(a.words, a.names_only, a.json); }; });
}

void addLists(CLI::App& app, fpc::tool::RunArguments& a) {
  CLI::App* plants =
      app.add_subcommand("plants", "Lists the plants with their signals, units and ranges");
  plants->add_flag("--json", a.json, "print one JSON object and nothing else");
  plants->footer("Example: fmbpc plants\n");
  plants->callback([&a] { asked_for = [&a] { return fpc::tool::plants(a.json); }; });
  CLI::App* controllers = app.add_subcommand(
      "controllers", "Lists the types of controller: what they are, need and let change in a run");
  controllers->add_flag("--json", a.json, "print one JSON object and nothing else");
  controllers->footer("Example: fmbpc controllers\n");
  controllers->callback([&a] { asked_for = [&a] { return fpc::tool::controllers(a.json); }; });
  CLI::App* events = app.add_subcommand(
      "events", "Lists what a loop may say of itself: causes, consequences, remedies");
  events->add_option("CODES", a.loops, "only these (default: docs/events.md)");
  events->footer("Example: fmbpc events signal_frozen\n");
  events->callback([&a] { asked_for = [&a] { return fpc::tool::events(a.loops); }; });
  CLI::App* table =
      app.add_subcommand("table", "Prints one table of runs that were written before");
  table->add_option("DIR", a.loops, "folders with a summary.json")->required();
  table->footer("Example: fmbpc table results/asp_case1 results/asp_case1_pi_s\n");
  table->add_flag("--short", a.brief, "a line per run: errors of what all control, movement");
  table->callback([&a] { asked_for = [&a] { return fpc::tool::table(a.loops, a.brief); }; });
}

}  // namespace

int main(int argc, char** argv) {
  if (!fpc::tool::becomeMpi(argv)) return 1;
  try {
    if (const int code = fpc::tool::runOther(argc, argv); code >= 0) return code;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "fmbpc: %s\n", e.what());
    return 1;
  }
  CLI::App app{"Process control with fuzzy model-based predictive control", "fmbpc"};
  app.set_version_flag("--version", "fmbpc " FMBPC_VERSION);
  fpc::tool::RunArguments arguments;
  addRun(app, arguments);
  addResolve(app, arguments);
  fpc::tool::LoopsArguments loops_arguments;
  addLoops(app, loops_arguments);
  addLists(app, arguments);
  fpc::tool::addDesign(app);
  fpc::tool::addReproduce(app);
  fpc::tool::RecoverArguments recover;
  fpc::tool::addRecover(app, recover, asked_for);
  fpc::tool::addOperate(app, asked_for);
  fpc::tool::addShadow(app, asked_for);
  fpc::tool::addWatch(app);
  fpc::tool::addPage(app);
  return fpc::tool::runProgram(app, asked_for, argc, argv);
}
