// Readers of the sections of a loop file, one function per section. Private to the room.
#pragma once

#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/yaml_section.hpp"

namespace fpc {

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
void readSampling(YamlSection& root, LoopFile& loop);
void readActuator(YamlSection& root, LoopFile& loop, const LoopNames& names);
/// Key actuator.lag.
void readLag(YamlSection& actuator, ActuatorParams& params, const std::vector<std::string>& inputs);
void readSensors(YamlSection& root, LoopFile& loop, const LoopNames& names);
void readNoise(YamlSection& root, LoopFile& loop, const LoopNames& names);
void readDisturbance(YamlSection& root, LoopFile& loop, const LoopNames& names);
void readTf(YamlSection& root, LoopFile& loop, const LoopNames& names);
void readSetpoint(YamlSection& root, LoopFile& loop, const LoopNames& names);
void readClp(YamlSection& root, LoopFile& loop, const LoopNames& names);
void readController(YamlSection& root, LoopFile& loop);
/// Key `fallback`: a controller that acts in place of another; null: none.
std::shared_ptr<const ControllerConfig> readFallback(YamlSection& section, const LoopFile& loop);
void readTargets(YamlSection& root, LoopFile& loop);
/// Keys separator, decimal, missing_values.
void readCsvFormat(YamlSection& section, CsvFormat& format);
/// Key `disturbance.csv`.
void readCsvSection(YamlSection& section, CsvDisturbanceParams& params,
                    const std::vector<std::string>& names);
void readModelSection(YamlSection& root, LoopFile& loop);
/// The model of a process alone, matched to the plant, with the drives and the sensors' lags and
/// dead times of the loop file. @throws InputError for one that lasts too many samples.
TsModel withInstruments(TsModel model, const SimulationParams& plant);
void readGuard(YamlSection& root, LoopFile& loop, const LoopNames& names);
void readCandidate(YamlSection& root, LoopFile& loop);
void readExchange(YamlSection& root, LoopFile& loop);
void readReport(YamlSection& root, LoopFile& loop, const LoopNames& names);

/// A value that the plant can never take is a mistake of unit or digits; NaN is none. `what`: a
/// setpoint, ...; `whose` range. @throws InputError naming the key and the range.
void requireInRange(const YamlSection& section, const std::string& key, double value,
                    const SignalInfo& signal, const std::string& what,
                    const std::string& whose = "the range of the plant");
/// Key `mode` of a command.
void readMode(YamlSection& item, Command& command);
/// `time_h`, `name`, `value`, `mode` of one scheduled command.
ScheduledCommand readCommand(YamlSection& item, const std::vector<std::string>& names);

}  // namespace fpc
