// The program fmbpc_design: the commands of `fmbpc` that identify, design and judge
// (design_words.hpp). It is a program of its own so that a first loop runs before this one is
// built.
#include <CLI/CLI.hpp>

#include <functional>
#include <string>

#include "tool/commands.hpp"
#include "tool/design_words.hpp"
#include "tool/program.hpp"
#include "tool/study_options.hpp"

namespace {

std::function<int()> asked_for;

void addCommission(CLI::App& app, fpc::tool::CommissionArguments& a) {
  CLI::App* commission = app.add_subcommand("commission", fpc::tool::designText("commission"));
  commission->add_option("BRIEF", a.brief, "what the operator says, docs/commissioning.md")
      ->required();
  commission->add_option("--folder", a.folder, "of its files (default: ./NAME_commissioned)");
  commission->add_option("--until", a.until, "last stage")
      ->capture_default_str()
      ->check(CLI::IsMember({"brief", "watch", "test", "model", "design"}));
  commission->add_option("--again", a.again, "goes through this stage and those after it once more")
      ->check(CLI::IsMember({"brief", "watch", "test", "model", "design"}));
  commission->add_flag("--topics", a.topics,
                       "of the loop that runs over topics: its plant, not a simulated one");
  commission->add_flag("--undo", a.undo,
                       "only takes back what --again names, and what is after it");
  commission->add_option("--evaluations", a.evaluations, "of each search of stage design")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  commission->add_option("--members", a.members, "of the ensemble of models")
      ->capture_default_str()
      ->check(CLI::Range(8, 200));
  commission->add_option("--threads", a.threads, "0: all cores")->capture_default_str();
  commission->add_flag("--json", a.json, "print one JSON object and nothing else");
  commission->add_flag("--no-plot", a.no_plot, "no test.png, no model.png");
  commission->footer("Example: fmbpc commission examples/commission/reactor.yaml --until watch\n");
  commission->callback([&a] { asked_for = [&a] { return fpc::tool::commission(a); }; });
}

void addFormat(CLI::App& command, fpc::tool::RecordFormat& f) {
  command.add_option("--separator", f.separator, "comma, semicolon, tab or bar")
      ->capture_default_str();
  command.add_option("--decimal", f.decimal, "point or comma")->capture_default_str();
  command.add_option("--missing", f.missing, "cells that mean missing beside empty ones and nan")
      ->delimiter(',');
  command.add_flag("--no-header", f.no_header, "the first line holds values; columns are 1, 2, ..");
}

void addEvaluate(CLI::App& app, fpc::tool::EvaluateArguments& a) {
  CLI::App* evaluate = app.add_subcommand("evaluate", fpc::tool::designText("evaluate"));
  evaluate->add_option("RUN", a.runs, "folders of `run --out`, or loops that are run first")
      ->required();
  evaluate->add_option("--set", a.set, "KEY.PATH=VALUE over the loop files, may be repeated")
      ->allow_extra_args(false);
  evaluate->add_option("--from-h", a.from_h, "start of the judged part [h], default the last 168");
  evaluate->add_option("--to-h", a.to_h, "its end [h], default the end of the run");
  evaluate->add_flag("--weights-2002", a.weights_2002, "formulas of the benchmark's 2002 book");
  evaluate->add_flag("--json", a.json, "print one JSON object and nothing else");
  evaluate->footer("Example: fmbpc evaluate bsm1_default bsm1_supervisor\n");
  evaluate->callback([&a] { asked_for = [&a] { return fpc::tool::evaluate(a); }; });
}

void addIdentify(CLI::App& app, fpc::tool::IdentifyArguments& a) {
  CLI::App* identify = app.add_subcommand("identify", fpc::tool::designText("identify"));
  identify
      ->add_option(
          "DATA", a.data,
          "CSV, or bag recorded by loop.launch; then STRUCTURE, a name of config/structure "
          "or a path. With --auto: one or more records, no structure")
      ->required();
  identify->add_option("--out", a.out, "model file to write");
  identify->add_option("--rows", a.rows,
                       "FIRST:LAST data rows to identify from, from 1 (default: all)");
  identify->add_option("--validate", a.validate, "another record to validate on");
  identify->add_option("--validate-rows", a.validate_rows,
                       "FIRST:LAST rows to validate on (default: none held out)");
  identify->add_option("--plots", a.plots, "folder for pictures of sets, predictions, residuals");
  identify->add_flag("--json", a.json, "print one JSON object and nothing else");
  identify->add_flag("--auto", a.automatic, "search the structure; needs --inputs and --outputs");
  identify->add_option("--inputs", a.inputs, "columns that a controller will move")->delimiter(',');
  identify->add_option("--outputs", a.outputs, "columns to predict")->delimiter(',');
  identify->add_option("--disturbances", a.disturbances, "columns that are only measured")
      ->delimiter(',');
  identify->add_option("--time", a.time, "column of times; found by its name if left out");
  identify->add_option("--sample-time", a.sample_time_s, "[s], instead of a time column");
  identify->add_option("--kind", a.kind, "best, linear, regressors or state")
      ->capture_default_str()
      ->check(CLI::IsMember({"best", "linear", "regressors", "state"}));
  identify
      ->add_option("--work", a.work,
                   "of the search, counted alike on every machine; 1 is about a second of one core")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  identify
      ->add_option("--budget", a.budget_s,
                   "[s] that end the search earlier; the model then depends on the machine")
      ->check(CLI::PositiveNumber);
  identify->add_option("--blocks", a.blocks, "held out in turn")
      ->capture_default_str()
      ->check(CLI::Range(2, 20));
  identify->add_option("--window", a.window, "measured samples that start a free run")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  identify
      ->add_option("--reach", a.reach,
                   "[samples] after which runs start anew from measured ones, 0 for free runs "
                   "(default: free, 10 to 30 where the process integrates or is unstable)")
      ->check(CLI::Range(0, 100000));
  identify
      ->add_option("--longest-delay", a.longest_delay,
                   "[samples] (default: a tenth of the rows, at most 100)")
      ->check(CLI::PositiveNumber);
  identify
      ->add_option("--input-row", a.input_row,
                   "what the inputs of a row do: next (act from then on), same (were in force when "
                   "its outputs were measured) or auto")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "next", "same"}));
  identify->add_flag("--keep-inputs", a.keep_inputs, "inputs that hardly moved too");
  identify->add_option("--known", a.known,
                       "what is known of the outputs: a file, or text like "
                       "'y: {gain: {u: positive}, max_pole: 0.99}'");
  addFormat(*identify, a.format);
  identify->add_option("--seed", a.seed, "of the starts of all fits")->capture_default_str();
  identify->footer(
      "Example: fmbpc identify examples/reactor_record.csv --auto --inputs q_c --outputs CA\n"
      "         fmbpc identify results/trajectory.csv asp_d --out my_model.yaml\n");
  identify->callback([&a] { asked_for = [&a] { return fpc::tool::identify(a); }; });
}

void addValidate(CLI::App& app, fpc::tool::ValidateArguments& a) {
  CLI::App* validate = app.add_subcommand("validate", fpc::tool::designText("validate"));
  validate->add_option("MODEL", a.model, "name of config/model, or path")->required();
  validate->add_option("DATA", a.data, "CSV, or bag recorded by loop.launch")->required();
  validate->add_option("--rows", a.rows, "FIRST:LAST data rows, from 1 (default: all)");
  validate->add_option("--columns", a.columns, "SIGNAL=COLUMN where names differ")->delimiter(',');
  validate->add_flag("--no-time", a.no_time, "rows are samples, whatever the times say");
  validate->add_option("--steps", a.steps, "samples ahead of the n-step prediction")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  addFormat(*validate, a.format);
  validate->add_option("--plots", a.plots, "folder for pictures");
  validate->add_flag("--json", a.json, "print one JSON object and nothing else");
  validate->footer("Example: fmbpc validate tanks.yaml other_day.csv --rows 1:500\n");
  validate->callback([&a] { asked_for = [&a] { return fpc::tool::validate(a); }; });
}

void addHealth(CLI::App& app, fpc::tool::HealthArguments& a) {
  CLI::App* health = app.add_subcommand("health", fpc::tool::designText("health"));
  health
      ->add_option("RECORD", a.records,
                   "folders of `run --out` or of a recorder, folders of these, CSVs or bags")
      ->required();
  health->add_option("--outputs", a.outputs, "of a CSV: columns of measured values, one a loop")
      ->delimiter(',');
  health->add_option("--setpoints", a.setpoints, "their setpoints (default: the mean is held)")
      ->delimiter(',');
  health->add_option("--inputs", a.inputs, "what their controllers asked for")->delimiter(',');
  health->add_option("--positions", a.positions, "where their valves stood")->delimiter(',');
  health->add_option("--mode", a.mode, "column that says who moves the inputs");
  health->add_option("--automatic", a.automatic, "its values in automatic")
      ->capture_default_str()
      ->delimiter(',');
  health->add_option("--manual", a.manual, "... by hand")->delimiter(',');
  health->add_option("--fallback", a.fallback, "... on the fallback; other values: held")
      ->delimiter(',');
  health->add_option("--time", a.time, "column of times; found by its name if left out");
  health->add_option("--sample-time", a.sample_time_s, "[s], instead of a time column");
  health
      ->add_option("--dead-time", a.dead_times_s,
                   "[s], of each loop or one for all (default: from the record)")
      ->delimiter(',')
      ->check(CLI::NonNegativeNumber);
  health->add_option("--limits", a.limits, "LOWER:UPPER of the inputs (of runs: their own)");
  health->add_option("--model", a.model, "name of config/model, or path: is it out of date?");
  health->add_option("--rows", a.rows, "FIRST:LAST rows to judge, from 1 (default: all)");
  addFormat(*health, a.format);
  health->add_option("--out", a.out, "folder for a page for each loop and index.html");
  health->add_flag("--json", a.json, "print one JSON object and nothing else");
  health->footer(
      "Example: fmbpc health results/asp_best --out results/health\n"
      "         fmbpc health historian.csv --outputs PV --setpoints SP --inputs OP --dead-time "
      "30\n");
  health->callback([&a] { asked_for = [&a] { return fpc::tool::health(a); }; });
}

void addModel(CLI::App& app, fpc::tool::RunArguments& a) {
  CLI::App* model = app.add_subcommand("model", fpc::tool::designText("model"));
  model->add_option("FILE", a.loops, "name of config/model, or path")->required()->expected(1);
  model->add_flag("--json", a.json, "print one JSON object and nothing else");
  model->add_option("--plots", a.out, "folder for pictures of its sets and step responses");
  model->footer("Example: fmbpc model fm_1 --plots results/fm_1\n");
  model->callback(
      [&a] { asked_for = [&a] { return fpc::tool::model(a.loops.front(), a.json, a.out); }; });
}

void addStability(CLI::App& app, fpc::tool::StabilityArguments& a) {
  CLI::App* stability = app.add_subcommand("stability", fpc::tool::designText("stability"));
  stability->add_option("MODEL|LOOP", a.name, "model or loop, by name or path")->required();
  stability->add_option("--set", a.set, "KEY.PATH=VALUE over the loop file, may be repeated")
      ->allow_extra_args(false);
  stability->add_option("--at", a.at,
                        "operating point, NAME=VALUE,...: inputs, disturbances, outputs");
  stability->add_option("--horizon", a.horizon, "coincidence horizons, FIRST..LAST")
      ->capture_default_str();
  stability->add_option("--noise-gain", a.noise_gain,
                        "advise a horizon: largest std of the input per std of measurement noise");
  stability->add_option("--settling", a.settling, "advise a horizon: largest settling [samples]");
  stability
      ->add_option("--points", a.points,
                   "of a loop: so many places of its run, each the farthest from the others, at "
                   "which it is linearised; 0: none")
      ->capture_default_str()
      ->check(CLI::Range(0, 100));
  stability->add_flag(
      "--on-model", a.on_model,
      "of a loop: its model in the place of its plant (of an external plant anyway)");
  stability->add_option("--out", a.out, "folder for stability.json and plots");
  stability->add_flag("--json", a.json, "print one JSON object and nothing else");
  stability->add_flag("--no-plot", a.no_plot, "no plots");
  stability->footer(
      "Example: fmbpc stability cstr_tracking_pi --out results/stability\n"
      "         fmbpc stability fm_1 --at q_r=570,q_i=1300,s_i=366.67\n");
  stability->callback([&a] { asked_for = [&a] { return fpc::tool::stability(a); }; });
}

void addNew(CLI::App& app, fpc::tool::NewArguments& a) {
  CLI::App* create = app.add_subcommand("new", fpc::tool::designText("new"));
  create->require_subcommand(1);
  CLI::App* loop = create->add_subcommand(
      "loop",
      "A loop file that runs, with numbers from a model and its record, and a PI beside it");
  loop->add_option("NAME", a.name, "of the loop (default: the model's, with _loop)");
  loop->add_option("--model", a.model, "name of config/model, or path")->required();
  loop->add_option("--plant", a.plant, "what is controlled")
      ->capture_default_str()
      ->check(CLI::IsMember({"model", "external", "float64", "modbus"}));
  loop->add_option("--out", a.out, "folder")->capture_default_str();
  loop->footer("Example: fmbpc new loop tank --model tank_model.yaml --plant modbus\n");
  loop->callback([&a] { asked_for = [&a] { return fpc::tool::newLoop(a); }; });
  for (const char* kind : {"plant", "controller"}) {
    CLI::App* package = create->add_subcommand(
        kind, std::string("A package with a ") + kind + " of your own: it builds, its tests pass");
    package->add_option("NAME", a.name, "of package, library and type")->required();
    package->add_option("--out", a.out, "folder in which the package's is made")
        ->capture_default_str();
    package->footer(std::string("Example: fmbpc new ") + kind + " my_" + kind + "\n");
    package->callback(
        [&a, kind] { asked_for = [&a, kind] { return fpc::tool::newPackage(a, kind); }; });
  }
}

void addCheck(CLI::App& app, fpc::tool::NewArguments& a) {
  CLI::App* check = app.add_subcommand("check", fpc::tool::designText("check"));
  check->add_option("PACKAGE", a.name, "a plugin's name, or the path of its library")->required();
  check->footer("Example: fmbpc check two_tanks\n");
  check->callback([&a] { asked_for = [&a] { return fpc::tool::check(a.name); }; });
}

void addReplay(CLI::App& app, fpc::tool::ReplayArguments& a) {
  CLI::App* command = app.add_subcommand("replay", fpc::tool::designText("replay"));
  command->add_option("BAG", a.bag, "bag of loop.launch record:=true")->required();
  command->add_option("LOOP", a.loop, "name or path, instead of the loop in the bag");
  command->add_option("--set", a.set, "KEY.PATH=VALUE over LOOP, may be repeated")
      ->allow_extra_args(false);
  command->add_option("--run", a.run, "which, from 1, of a bag with several (after a reset)")
      ->check(CLI::PositiveNumber);
  command->add_flag("--json", a.json, "print one JSON object and nothing else");
  command->footer("Example: fmbpc replay ~/.ros/fmbpc/asp_case1_clp/loop.bag\n");
  command->callback([&a] { asked_for = [&a] { return fpc::tool::replay(a); }; });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Process control with fuzzy model-based predictive control", "fmbpc"};
  fpc::tool::RunArguments arguments;
  fpc::tool::EvaluateArguments evaluate_arguments;
  addEvaluate(app, evaluate_arguments);
  fpc::tool::IdentifyArguments identify_arguments;
  addIdentify(app, identify_arguments);
  fpc::tool::CommissionArguments commission_arguments;
  addCommission(app, commission_arguments);
  fpc::tool::ValidateArguments validate_arguments;
  addValidate(app, validate_arguments);
  fpc::tool::HealthArguments health_arguments;
  addHealth(app, health_arguments);
  addModel(app, arguments);
  fpc::tool::StabilityArguments stability;
  addStability(app, stability);
  fpc::tool::NewArguments creation;
  addNew(app, creation);
  addCheck(app, creation);
  fpc::tool::TuneArguments tune;
  fpc::tool::addTune(app, tune, asked_for);
  fpc::tool::StudyArguments study;
  fpc::tool::addStudy(app, study, asked_for);
  fpc::tool::ReplayArguments replay;
  addReplay(app, replay);
  fpc::tool::addExport(app, asked_for);
  return fpc::tool::runProgram(app, asked_for, argc, argv);
}
