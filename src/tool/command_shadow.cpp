// fmbpc shadow, handover: a law that is watched beside the one in charge of a loop over topics.
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "base/finite_json.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/operator_line.hpp"
#include "tool/topic_options.hpp"

namespace fpc::tool {
namespace {

struct ShadowWords {
  std::string loop;
  bool back{false}, json{false};
};

std::string shadowFigure(const OrderedJson& json) {
  if (!json.is_number()) return "?";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", json.get<double>());
  return text;
}

/// [value, lower, upper]
std::string bounded(const OrderedJson& json) {
  return shadowFigure(json[0]) + " (" + shadowFigure(json[1]) + " .. " + shadowFigure(json[2]) +
         ")";
}

std::string shareOf(const OrderedJson& json) {
  return json.is_number() ? shortText(std::round(1000.0 * json.get<double>()) / 10.0) + " %" : "?";
}

void printCandidate(const OrderedJson& report) {
  std::cout << "candidate " << report["candidate"].get<std::string>() << ": "
            << report["state"].get<std::string>() << ", " << report["samples"] << " samples, "
            << shareOf(report["authority"]) << " of the allowed moves\n";
  if (!report.contains("figures")) return;
  const OrderedJson& f = report["figures"];
  std::cout << "model: " << f["result"].get<std::string>();
  if (!f["why"].get<std::string>().empty()) std::cout << ", " << f["why"].get<std::string>();
  std::cout << " (each interval at " << shareOf(f["confidence"]) << ")\n";
  std::vector<std::vector<std::string>> rows{{"figure", "value"}};
  rows.push_back({"share of the inputs' effect explained", bounded(f["explained"])});
  for (std::size_t i = 0; i < f["gain"].size(); ++i) {
    rows.push_back(
        {"plant's gain over the model's, input " + std::to_string(i + 1), bounded(f["gain"][i])});
    for (const auto& shift : f["shift_loss"][i].items())
      rows.push_back(
          {"loss if input " + std::to_string(i + 1) + " acted " + shift.key() + " samples later",
           bounded(shift.value())});
  }
  for (const OrderedJson& h : f["horizons"])
    rows.push_back({"error " + std::to_string(h["samples"].get<int>()) + " ahead over 'it stays'",
                    shadowFigure(h["error_over_stays"]) + "; law in charge " +
                        shadowFigure(h["law_in_charge_over_stays"])});
  rows.push_back({"input differs, rms of the range", shareOf(f["input_difference"])});
  rows.push_back({"samples in which it would have met a limit", shareOf(f["at_limit"])});
  rows.push_back({"samples outside the data of its model", shareOf(f["outside_data"])});
  std::cout << leftTable(rows);
}

int askCandidate(OperatorVerb verb, const ShadowWords& words) {
  OperatorCommand command;
  command.verb = verb;
  command.loop = words.loop;
  const std::string answer = askLoop(command);
  if (words.json)
    std::cout << answer;
  else
    printCandidate(OrderedJson::parse(answer));
  return 0;
}

}  // namespace

void addShadow(CLI::App& app, std::function<int()>& chosen) {
  const auto words = std::make_shared<ShadowWords>();
  CLI::App* shadow = app.add_subcommand(
      "shadow",
      "Watches another law beside the one in charge of a running loop, or says how it is");
  shadow->add_option("LOOP", words->loop,
                     "the candidate's loop file, by name or path (default: reports)");
  shadow->footer("Example: fmbpc shadow tank_candidate\n");
  CLI::App* handover =
      app.add_subcommand("handover", "Hands a running loop over to the candidate that has passed");
  handover->add_flag("--back", words->back, "the former law is in charge again");
  handover->footer("Example: fmbpc handover --back\n");
  for (CLI::App* command : {shadow, handover})
    command->add_flag("--json", words->json, "one JSON object on stdout");
  shadow->callback([words, &chosen] {
    chosen = [words] { return askCandidate(OperatorVerb::kShadow, *words); };
  });
  handover->callback([words, &chosen] {
    chosen = [words] {
      return askCandidate(words->back ? OperatorVerb::kBack : OperatorVerb::kHandOver, *words);
    };
  });
}

}  // namespace fpc::tool
