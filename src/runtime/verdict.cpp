// Who won a comparison, by how much and at which movement, computed from the summaries.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "fmbpc/base/text.hpp"
#include "runtime/report.hpp"
#include "runtime/with_unit.hpp"

namespace fpc {
namespace {

constexpr double kDraw = 0.01;  // of the ISE

/// Index of the name, or as many as there are.
std::size_t indexOf(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

bool controls(const Summary& s, const std::string& output) {
  const std::size_t i = indexOf(s.output_names, output);
  return i < s.outputs.size() && i < s.controlled.size() && s.controlled[i];
}

double iseOf(const Summary& s, const std::string& output) {
  return s.outputs[indexOf(s.output_names, output)].ise;
}

bool went(const Summary& s) { return s.complete && troubleOf(s).empty() && !neverControlled(s); }

/// What all of them control and have an error of.
std::vector<std::string> sharedOutputs(const std::vector<Summary>& summaries) {
  std::vector<std::string> shared;
  for (const std::string& name : summaries.front().output_names)
    if (std::all_of(summaries.begin(), summaries.end(), [&](const Summary& s) {
          return controls(s, name) && std::isfinite(iseOf(s, name));
        }))
      shared.push_back(name);
  return shared;
}

/// Geometric mean of the errors, which no unit sways.
double scoreOf(const Summary& s, const std::vector<std::string>& outputs) {
  double sum = 0.0;
  for (const std::string& output : outputs) sum += std::log(std::max(iseOf(s, output), 1e-300));
  return std::exp(sum / static_cast<double>(outputs.size()));
}

/// How many letters of all titles are the same, up to the end of a part between commas.
std::size_t commonStart(const std::vector<Summary>& summaries) {
  const std::string& first = summaries.front().title;
  std::size_t same = first.size();
  for (const Summary& s : summaries) {
    const auto end = std::mismatch(first.begin(), first.end(), s.title.begin(), s.title.end());
    same = std::min(same, static_cast<std::size_t>(end.first - first.begin()));
  }
  const std::size_t comma = same == 0 ? std::string::npos : first.rfind(", ", same - 1);
  return comma == std::string::npos || comma + 2 > same ? 0 : comma + 2;
}

/// "PI on biomass (asp_case1_pi_x)".
std::string named(const Summary& s, std::size_t start) {
  return s.title.size() > start ? s.title.substr(start) + " (" + s.loop + ")" : s.loop;
}

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, share < 0.1 ? "%.1f %%" : "%.0f %%", 100.0 * share);
  return text;
}

std::string times(double ratio) {
  char text[32];
  std::snprintf(text, sizeof text, ratio < 10.0 ? "%.2g" : "%.0f", ratio);
  return text;
}

/// "ISE of x 2.5e+05, 12 % less than", of several outputs each.
std::string gain(const Summary& best, const Summary& second,
                 const std::vector<std::string>& outputs) {
  std::vector<std::string> parts;
  for (const std::string& output : outputs) {
    const double ratio = iseOf(best, output) / iseOf(second, output);
    parts.push_back("ISE of " + output + " " + shortText(iseOf(best, output)) + ", " +
                    percent(std::abs(1.0 - ratio)) + (ratio <= 1.0 ? " less" : " more"));
  }
  return join(parts, "; ") + " than ";
}

std::string movement(const Summary& best, const Summary& second) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < best.input_names.size(); ++i) {
    const std::size_t k = indexOf(second.input_names, best.input_names[i]);
    if (k >= second.inputs.size()) continue;
    const std::string unit = i < best.input_units.size() ? " " + best.input_units[i] : "";
    parts.push_back(best.input_names[i] + " " + shortText(best.inputs[i].mean_abs_move) +
                    " against " + shortText(second.inputs[k].mean_abs_move) + unit);
  }
  return parts.empty() ? "" : ", at a mean move a sample of " + join(parts);
}

}  // namespace

std::string shortTable(const std::vector<Summary>& summaries) {
  if (summaries.empty()) return "";
  const std::size_t start = commonStart(summaries);
  const Summary& first = summaries.front();
  std::vector<std::string> head{start == 0 ? "run" : first.title.substr(0, start - 2)};
  const std::vector<std::string> outputs = sharedOutputs(summaries);
  for (const std::string& output : outputs) {
    head.push_back("ISE of " + output);
    head.push_back("rmse of " + withUnit(first.output_names, first.output_units,
                                         indexOf(first.output_names, output)));
  }
  for (std::size_t i = 0; i < first.input_names.size(); ++i)
    head.push_back("mean move of " + withUnit(first.input_names, first.input_units, i));
  std::vector<std::vector<std::string>> rows{head};
  for (const Summary& s : summaries) {
    rows.push_back({named(s, start)});
    for (const std::string& output : outputs) {
      const OutputIndices& y = s.outputs[indexOf(s.output_names, output)];
      rows.back().push_back(shortText(y.ise));
      rows.back().push_back(shortText(y.rmse));
    }
    for (const std::string& input : first.input_names) {
      const std::size_t i = indexOf(s.input_names, input);
      rows.back().push_back(i < s.inputs.size() ? shortText(s.inputs[i].mean_abs_move) : "-");
    }
  }
  return alignedTable(rows);
}

std::string verdictOf(const std::vector<Summary>& summaries) {
  if (summaries.size() < 2) return "";
  const bool alike = std::all_of(summaries.begin(), summaries.end(), [&](const Summary& s) {
    return s.steps == summaries.front().steps;
  });
  const std::vector<std::string> outputs = sharedOutputs(summaries);
  if (!alike || outputs.empty() || !std::all_of(summaries.begin(), summaries.end(), went))
    return "Verdict: none: these runs differ in length or in what they control, or one did not go "
           "to its end.";
  std::vector<const Summary*> order;
  for (const Summary& s : summaries) order.push_back(&s);
  std::stable_sort(order.begin(), order.end(), [&](const Summary* a, const Summary* b) {
    return scoreOf(*a, outputs) < scoreOf(*b, outputs);
  });
  const std::size_t start = commonStart(summaries);
  const Summary &best = *order[0], &second = *order[1];
  const double ratio = scoreOf(best, outputs) / scoreOf(second, outputs);
  std::string text = "Verdict: " + named(best, start) +
                     (ratio > 1.0 - kDraw ? " draws: " : " wins: ") + gain(best, second, outputs) +
                     named(second, start) + movement(best, second);
  for (std::size_t i = 2; i < order.size(); ++i)
    text += (i == 2 ? "; " : ", ") + order[i]->loop + " has " +
            times(scoreOf(*order[i], outputs) / scoreOf(best, outputs)) + " times its ISE";
  if (best.output_violations > 0)
    text += "; the winner was beyond output limits in " + std::to_string(best.output_violations) +
            " samples";
  return text + ".";
}

}  // namespace fpc
