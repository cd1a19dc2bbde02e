#include "config/signal_names.hpp"

#include <algorithm>
#include <functional>
#include <map>

#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Names = std::vector<std::string>;

/// Where the i-th signal of a group got its name.
std::string placeOf(const YamlSection& plant, const LoopFile& loop, const char* group,
                    std::size_t i) {
  const std::string item = std::string(group) + "[" + std::to_string(i) + "].name";
  if (loop.external_plant) return plant.where(item);
  return plant.where(plant.has("matrix") ? "matrix." + item : "type");
}

bool fitsAHeader(const std::string& name) {
  const auto bad = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  return !name.empty() && name.find_first_of(",\"[]") == std::string::npos && name.front() != ' ' &&
         name.back() != ' ' && std::none_of(name.begin(), name.end(), bad);
}

void requireWords(const Names& names, const Names& keys,
                  const std::function<std::string(std::size_t)>& place) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    require(fitsAHeader(names[i]), place(i),
            "a name without comma, quotes, brackets or blanks at its ends, got '" + names[i] + "'");
    require(std::count(keys.begin(), keys.end(), names[i]) == 0, place(i),
            "another name than the keys " + join(keys) + ", got '" + names[i] + "'");
  }
}

/// The columns of trajectory.csv that these names make, and what each one is.
class Columns {
 public:
  explicit Columns(std::string place) : place_(std::move(place)) { add("time", "the time"); }
  void add(const std::string& column, const std::string& what) {
    const auto [before, is_new] = columns_.emplace(column, what);
    require(is_new, place_,
            "names that make every column of a run's table once; '" + column + "' is " +
                before->second + " and " + what);
  }

 private:
  std::string place_;
  std::map<std::string, std::string> columns_;
};

void addSignals(Columns& columns, const LoopNames& names) {
  for (const auto& y : names.outputs) columns.add(y, "output " + y);
  for (const auto& u : names.inputs) columns.add(u, "input " + u);
  for (const auto& d : names.disturbances) columns.add(d, "disturbance " + d);
  for (const auto& y : names.outputs)
    for (const char* what : {"setpoint", "reference", "true"})
      columns.add(y + "_" + what, "the column " + std::string(what) + " of output " + y);
  for (const auto& u : names.inputs)
    for (const char* what : {"commanded", "base", "perturbation"})
      columns.add(u + "_" + what, "the column " + std::string(what) + " of input " + u);
}

}  // namespace

void requireSignalNames(const YamlSection& plant, const LoopFile& loop, const LoopNames& names) {
  const auto place = [&](const char* group) {
    return [&plant, &loop, group](std::size_t i) { return placeOf(plant, loop, group, i); };
  };
  requireWords(names.outputs, {"time_h", "ramp_h", "ramp_s", "hold_s", "seed", "step_s"},
               place("outputs"));
  requireWords(names.inputs, {}, place("inputs"));
  requireWords(names.disturbances, {"seed", "step_s"}, place("disturbances"));
  Columns columns(plant.where(plant.has("matrix") ? "matrix" : "type"));
  addSignals(columns, names);
  for (const auto& state : names.plant.states)
    if (std::count(names.outputs.begin(), names.outputs.end(), state.name) == 0)
      columns.add(state.name, "state " + state.name);
}

}  // namespace fpc
