#include "tool/study_options.hpp"

#include "tool/design_words.hpp"

namespace fpc::tool {

void addTune(CLI::App& app, TuneArguments& a, std::function<int()>& chosen) {
  CLI::App* tune = app.add_subcommand("tune", designText("tune"));
  tune->add_option("LOOP", a.loop, "name of config/loop, or path")->required();
  tune->add_option("TUNING", a.tuning, "name of config/tuning, or path")->required();
  tune->add_option("--set", a.set, "KEY.PATH=VALUE over the loop file, may be repeated")
      ->allow_extra_args(false);
  tune->add_option("--out", a.out,
                   "folder for the tuned loop, tuning.json, history.csv, state, plot");
  tune->add_option("--method", a.method,
                   "apso, pso, random, de, cmaes (default: the tuning file's)");
  tune->add_option("--population", a.population,
                   "points per generation (default: the tuning file's)");
  tune->add_option("--evaluations", a.evaluations,
                   "points in all, each on every scenario (default: the tuning file's)");
  tune->add_option("--seed", a.seed, "of the search (default: the tuning file's)");
  tune->add_option("--threads", a.threads, "0: all cores; the answer does not depend on it")
      ->capture_default_str();
  tune->add_flag("--resume", a.resume, "go on with what --out holds");
  tune->add_flag("--compare", a.compare, "all methods at equal evaluations instead of one tuning");
  tune->add_option("--seeds", a.seeds, "seeds of the comparison")->capture_default_str();
  tune->add_option("--methods", a.methods, "methods of the comparison (default: all)")
      ->delimiter(',');
  tune->add_flag("--json", a.json, "print one JSON object and nothing else");
  tune->add_flag("--no-plot", a.no_plot, "no plot");
  tune->footer("Example: fmbpc tune cstr_tracking cstr_law --out results/tuned\n");
  tune->callback([&] { chosen = [&a] { return fpc::tool::tune(a); }; });
}

void addStudy(CLI::App& app, StudyArguments& a, std::function<int()>& chosen) {
  CLI::App* study = app.add_subcommand("study", designText("study"));
  study->add_option("STUDY|LOOP", a.names, "a study of config/study, or loops")->required();
  study->add_option("--seeds", a.seeds,
                    "FIRST:LAST or a list: of patterns, noise and --vary (default: the study's, "
                    "else the loops')");
  study->add_option("--vary", a.vary, "KEY=LOWER:UPPER as factors, or KEY=value:LOWER:UPPER")
      ->allow_extra_args(false);
  study->add_option("--noise", a.noise, "OUTPUT=STD, may be repeated")->allow_extra_args(false);
  study->add_option("--noise-percent", a.noise_percent, "std in percent of the span of setpoints");
  study->add_option("--set", a.set, "KEY.PATH=VALUE over all loops, may be repeated")
      ->allow_extra_args(false);
  study->add_option(
      "--against", a.against,
      "the loop that the others are paired with (default: the study's, else the last)");
  study->add_option("--index", a.index,
                    "what counts, without a study file: ise, iae, rmse, ... (default: ise)");
  study->add_option("--out", a.out, "folder for study.json, runs.csv, state, distributions.png");
  study->add_option("--threads", a.threads, "0: all cores; the answer does not depend on it");
  study->add_flag("--resume", a.resume, "go on with what --out holds");
  study->add_flag("--json", a.json, "print one JSON object and nothing else");
  study->add_flag("--no-plot", a.no_plot, "no plot");
  study->footer("Example: fmbpc study asp_case1 asp_case1_pi_x --seeds 1:8\n");
  study->callback([&] { chosen = [&a] { return fpc::tool::study(a); }; });
}

}  // namespace fpc::tool
