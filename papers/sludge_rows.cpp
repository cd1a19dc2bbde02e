#include "papers/sludge_rows.hpp"

#include <cmath>

namespace fpc::tool {
namespace {

std::string of(const std::string& what, const std::string& loop, const std::string& baseline) {
  return what + ", " + loop + " / " + baseline;
}

ReproduceRow behind(ReproduceRow row, const std::string& loops) {
  row.behind = loops;
  return row;
}

}  // namespace

Values iseRatio(const std::string& loop, const std::string& baseline, const std::string& output) {
  return ratio(iseOver(loop, output), iseOver(baseline, output));
}

ReproduceRow ahead(const std::string& loop, const std::string& baseline, const std::string& output,
                   const std::string& note, Direction side) {
  return behind(check(of("ISE of " + output, loop, baseline), iseRatio(loop, baseline, output),
                      side, 1.0, "-", note),
                loop + ", " + baseline);
}

ReproduceRow alike(const std::string& loop, const std::string& baseline, const std::string& output,
                   const std::string& note) {
  return behind(check(of("ISE of " + output, loop, baseline), iseRatio(loop, baseline, output),
                      Direction::kEqual, 1.0, "-", note + "; within 15 %", 0.15),
                loop + ", " + baseline);
}

Values trackingOver(const std::string& loop, const std::string& output) {
  return overSeeds(loop, [&](const Summary& run) {
    return std::sqrt(indicesOf(run, output).ise_reference / (run.steps + 1.0));
  });
}

Values rmseOver(const std::string& loop, const std::string& output) {
  return overSeeds(loop, [&](const Summary& run) { return indicesOf(run, output).rmse; });
}

Values inputOver(const std::string& loop, OfInput what) {
  return overSeeds(loop, [&](const Summary& run) { return what(run.inputs.at(0)); });
}

double largestInput(const InputIndices& u) { return u.max; }
double smallestInput(const InputIndices& u) { return u.min; }
double inputRange(const InputIndices& u) { return u.max - u.min; }
double meanMove(const InputIndices& u) { return u.mean_abs_move; }

ReproduceRow followsReference(const std::string& loop, double setpoint) {
  return check("rms of x about its reference trajectory", trackingOver(loop, "x"),
               Direction::kLower, 0.05 * setpoint, "mg/l",
               "the paper: follows it faithfully; the 5 % of the setpoint are ours");
}

ReproduceRow substrateBeside(const std::string& loop) {
  return incomparable("rmse of s", notPrinted(), rmseOver(loop, "s"), "mg/l", kUnpublished);
}

ReproduceRow inputBeside(const std::string& loop) {
  return incomparable("largest q_r", notPrinted(), inputOver(loop, largestInput), "m3/h",
                      kUnpublished);
}

}  // namespace fpc::tool
