// Readers of the sections of a loop file, one function per section. Private to the room.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "base/yaml_section.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/config/loop_file.hpp"

namespace fpc {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kLargest = std::numeric_limits<double>::max();
constexpr Range kFinite{-kLargest, kLargest};
constexpr Range kFinitePositive{0.0, kLargest, true};
constexpr Range kFiniteNotNegative{0.0, kLargest};

/// Names of a loop's signals in the order of PlantInfo, and what the plant says of itself.
struct LoopNames {
  PlantDescription plant;  ///< empty for an external plant
  std::vector<std::string> outputs, inputs;
  std::vector<std::string> disturbances;       ///< those that act on the plant
  std::vector<std::string> seen_disturbances;  ///< those that are measured
};

/// The whole text. @throws InputError with the origin of the key.
LoopFile readSections(YamlSection& root, const std::string& name);

void readPlant(YamlSection& root, LoopFile& loop, LoopNames& names);
/// Key plant.matrix: the elements of a plant that is a transfer matrix, over its own.
void readMatrix(YamlSection& plant, SimulationParams& simulation);
void readSampling(YamlSection& root, LoopFile& loop);
void readActuator(YamlSection& root, LoopFile& loop, const LoopNames& names);
void readNoise(YamlSection& root, LoopFile& loop, const LoopNames& names);
void readDisturbance(YamlSection& root, LoopFile& loop, const LoopNames& names);
void readTf(YamlSection& root, LoopFile& loop, const LoopNames& names);
void readSetpoint(YamlSection& root, LoopFile& loop, const LoopNames& names);
void readClp(YamlSection& root, LoopFile& loop, const LoopNames& names);
void readController(YamlSection& root, LoopFile& loop, const LoopNames& names);
/// Keys of `controller` with type excitation.
void readExcitation(YamlSection& section, LoopFile& loop, const LoopNames& names);
/// Keys of `controller` with type fuzzy_optimal.
void readFuzzyOptimal(YamlSection& section, LoopFile& loop, const LoopNames& names);
/// Nominal values of the measured disturbances.
Vector nominalDisturbances(const LoopFile& loop, const LoopNames& names);
/// Key prediction_steps, which an optimizer fixes.
void readPredictionSteps(YamlSection& section, const LoopFile& loop, int& steps);
void readHybridMpc(YamlSection& section, LoopFile& loop, const LoopNames& names);
/// Keys of `controller` with type nmpc or swarm_mpc.
void readHorizonMpc(YamlSection& section, LoopFile& loop, const LoopNames& names);
/// `recipe`: what a batch plant does one after the other, as entries of a schedule.
std::vector<SetpointStep> readRecipe(YamlSection& setpoint,
                                     const std::vector<std::string>& outputs);
/// A time under the key `stem`_s, `stem`_min or `stem`_h, in hours; unchanged if there is none.
void readHours(YamlSection& section, const std::string& stem, double& hours);
/// Keys of `controller` with type adaptive_pi.
void readAdaptivePi(YamlSection& section, LoopFile& loop, const LoopNames& names);
/// Keys separator, decimal, missing_values.
void readCsvFormat(YamlSection& section, CsvFormat& format);
/// Key `disturbance.csv`.
void readCsvSection(YamlSection& section, CsvDisturbanceParams& params,
                    const std::vector<std::string>& names);
void readModelSection(YamlSection& root, LoopFile& loop);
void readRing(YamlSection& root, LoopFile& loop);
void readReport(YamlSection& root, LoopFile& loop, const LoopNames& names);

/// A required key: fails unless it is there.
void need(const YamlSection& section, const std::string& key, const std::string& expected);
/// Index of the name that stands at `key`. @throws InputError listing the names.
int indexByName(YamlSection& section, const std::string& key,
                const std::vector<std::string>& names);
/// `time_h`, `name`, `value`, `mode` of one scheduled command.
ScheduledCommand readCommand(YamlSection& item, const std::vector<std::string>& names);
/// Throws `message` ("field: expected ...") again with the place of the field in the file.
[[noreturn]] void failAt(const YamlSection& section, const std::string& message);

/// Runs a check whose InputError knows the field but not the file.
template <typename Check>
void checked(const YamlSection& section, Check check) {
  try {
    check();
  } catch (const InputError& e) {
    failAt(section, e.what());
  }
}

}  // namespace fpc
