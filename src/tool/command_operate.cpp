// fmbpc set, disturb, manual, auto, release: what an operator asks of a loop that runs over topics.
#include <iostream>
#include <memory>
#include <optional>

#include "base/number.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/operator_line.hpp"
#include "tool/topic_options.hpp"

namespace fpc::tool {
namespace {

double operatorNumber(const std::string& name, const std::string& text) {
  const std::optional<double> value = parseNumber(text[0] == '+' ? text.substr(1) : text);
  require(value.has_value(), name, "a number, got '" + text + "'");
  return *value;
}

/// "x 2000 s 55" or "x=2000 s=55".
std::vector<std::pair<std::string, double>> pairsOf(const std::vector<std::string>& words) {
  std::vector<std::pair<std::string, double>> pairs;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::size_t equals = words[i].find('=');
    if (equals != std::string::npos) {
      const std::string name = words[i].substr(0, equals);
      pairs.emplace_back(name, operatorNumber(name, words[i].substr(equals + 1)));
      continue;
    }
    require(i + 1 < words.size(), words[i], "NAME VALUE: a value behind it");
    pairs.emplace_back(words[i], operatorNumber(words[i], words[i + 1]));
    ++i;
  }
  return pairs;
}

struct Verb {
  OperatorVerb verb;
  const char *name, *about, *example;
};

constexpr Verb kVerbs[] = {
    {OperatorVerb::kSet, "set", "Puts setpoints over the schedule of a running loop",
     "fmbpc set x 2000"},
    {OperatorVerb::kDisturb, "disturb",
     "Disturbs a running simulated plant; input/NAME is a stuck valve, output/NAME a sensor fault",
     "fmbpc disturb q_i 1500"},
    {OperatorVerb::kManual, "manual",
     "Takes a running loop into manual; inputs stay, or go to the values given",
     "fmbpc manual q_r 900"},
    {OperatorVerb::kAuto, "auto", "Gives a running loop back to its controller, without a bump",
     "fmbpc auto"},
    {OperatorVerb::kRelease, "release",
     "Takes setpoints and disturbances back: those named, or all of them", "fmbpc release q_i"}};

struct Words {
  std::vector<std::string> given;
  bool offset{false};
};

int operate(OperatorVerb verb, const Words& words) {
  OperatorCommand command;
  command.verb = verb;
  command.offset = words.offset;
  if (verb == OperatorVerb::kRelease)
    command.names = words.given;
  else
    command.values = pairsOf(words.given);
  std::cout << askLoop(command);
  return 0;
}

}  // namespace

void addOperate(CLI::App& app, std::function<int()>& chosen) {
  for (const Verb& v : kVerbs) {
    CLI::App* command = app.add_subcommand(v.name, v.about);
    const auto words = std::make_shared<Words>();
    const bool values = v.verb == OperatorVerb::kSet || v.verb == OperatorVerb::kDisturb;
    if (values)
      command
          ->add_option("NAME", words->given,
                       "NAME VALUE or NAME=VALUE, in the unit of the signal; may be repeated")
          ->required();
    if (v.verb == OperatorVerb::kManual)
      command->add_option("NAME", words->given, "NAME VALUE of inputs (default: they stay)");
    if (v.verb == OperatorVerb::kRelease)
      command->add_option("NAME", words->given, "of outputs and disturbances (default: all)");
    if (values) command->add_flag("--offset", words->offset, "VALUE is added to what is scheduled");
    command->footer(std::string("Example: ") + v.example + "\n");
    command->callback(
        [words, verb = v.verb, &chosen] { chosen = [=] { return operate(verb, *words); }; });
  }
}

}  // namespace fpc::tool
