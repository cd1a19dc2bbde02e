// `fmbpc export`: a loop's law leaves the computer; --check becomes scripts/export_check.py.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "export/export.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/plot.hpp"
#include "tool/design_words.hpp"
#include "tool/study_options.hpp"

namespace fpc::tool {
namespace {

struct ExportArguments {
  std::string loop, to{"all"}, out, check;
  std::vector<std::string> set;
  ExportOptions options;
};

int checkExport(std::string folder) {
  std::string script = findScript("export_check.py"), python = kPython;
  require(!script.empty(), "export --check", "scripts/export_check.py beside the config folders");
  char* words[] = {python.data(), script.data(), folder.data(), nullptr};
  execv(kPython, words);
  throw InputError("export --check: " + std::string(kPython) + " cannot be run");
}

int exportLaw(const ExportArguments& a) {
  if (!a.check.empty()) return checkExport(a.check);
  require(!a.loop.empty() && !a.out.empty(), "export",
          "a LOOP and --out FOLDER, or --check FOLDER");
  const Overrides overrides = parseOverrides(a.set);
  ExportOptions options = a.options;
  options.exporter = "fmbpc " FMBPC_VERSION;
  options.c99 = a.to != "st";
  options.structured_text = a.to != "c99";
  for (const std::string& name : exportLoop(readLoop(a.loop, overrides), options, a.out))
    std::printf("%s/%s\n", a.out.c_str(), name.c_str());
  return 0;
}

}  // namespace

void addExport(CLI::App& app, std::function<int()>& chosen) {
  const auto a = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", designText("export"));
  command->add_option("LOOP", a->loop, "name of config/loop, or path");
  command->add_option("--to", a->to, "c99, st, all")
      ->capture_default_str()
      ->check(CLI::IsMember({"c99", "st", "all"}));
  command->add_option("--out", a->out, "folder, made if it is not there");
  command->add_flag("--real", a->options.single, "single precision: REAL, float");
  command->add_option("--name", a->options.name, "of files, types and functions")
      ->capture_default_str();
  command->add_option("--samples", a->options.samples, "vectors")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  command->add_option("--seed", a->options.seed, "of what happens in them")->capture_default_str();
  command->add_option("--set", a->set, "KEY.PATH=VALUE over the loop file, may be repeated")
      ->allow_extra_args(false);
  command->add_option("--check", a->check,
                      "folder of an export: builds and runs it with what this machine has");
  command->footer(
      "Example: fmbpc export cstr_tracking --out block\n         fmbpc export --check block\n");
  command->callback([a, &chosen] { chosen = [a] { return exportLaw(*a); }; });
}

}  // namespace fpc::tool
