// Targets whose bytes are a text that a person could have written.
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "base/csv.hpp"
#include "config/model_file.hpp"
#include "config/structure_file.hpp"
#include "config/tuning_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fuzz/scratch_file.hpp"
#include "fuzz/targets.hpp"
#include "fuzz/tolerant.hpp"
#include "plant/disturbance.hpp"
#include "runtime/run.hpp"

namespace fpc::fuzz {
namespace {

constexpr std::uint32_t kSamples = 30;

[[noreturn]] void fail(const std::string& what) { throw std::logic_error(what); }

/// A file of this process with these bytes.
std::string fileWith(const std::string& bytes, const char* ending) {
  const std::string file = scratchFile(ending);
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

void runBriefly(const LoopFile& loop) {
  std::uint32_t last = 0;
  RunOptions options;
  options.progress = [&](std::uint32_t step, std::uint32_t) { last = step; };
  options.stop = [&] { return last >= kSamples; };
  const RunRecord record = runLoop(loop, options);
  const InputLimits& limits = loop.simulation.actuator.limits;
  const Vector slack = 1e-9 * (limits.upper - limits.lower);
  for (const auto& sample : record.samples) {
    if (!sample.has_action) continue;
    const Vector& u = sample.action.input;
    if (!u.allFinite()) fail("an action that is not finite");
    if (((u - limits.upper - slack).array() > 0.0).any() ||
        ((limits.lower - slack - u).array() > 0.0).any())
      fail("an action beyond its limits");
  }
}

}  // namespace

void loopFile(const std::string& bytes) {
  tolerant([&] {
    const LoopFile loop = parseLoop(bytes, "fuzz");
    const bool brief = loop.simulation.samples > 0 && loop.simulation.samples <= 100000;
    if (!loop.external_plant && brief) runBriefly(loop);
  });
}

void modelFile(const std::string& bytes) {
  tolerant([&] {
    const TsModel model = readModel(fileWith(bytes, ".yaml"));
    const std::string text = writeModel(model);
    if (writeModel(readModel(fileWith(text, ".yaml"))) != text)
      fail("a model that changes when it is written and read");
  });
}

void structureFile(const std::string& bytes) {
  tolerant([&] { parseStructure(bytes, "fuzz"); });
}

void tuningFile(const std::string& bytes) {
  tolerant([&] { parseTuning(bytes, "fuzz"); });
}

void csvTable(const std::string& bytes) {
  const std::string file = fileWith(bytes, ".csv");
  for (const CsvFormat& format :
       {CsvFormat{}, CsvFormat{';', ',', {"-999", "Bad"}}, CsvFormat{'\t', '.', {}}})
    tolerant([&] {
      const CsvTable table = readCsv(file, format);
      CsvDisturbanceParams params;
      params.file = file;
      params.format = format;
      params.time_column = table.names.front();
      params.missing = MissingCells::kInterpolate;
      params.end = RecordEnd::kRepeat;
      params.channels = {{"d", table.names.back()}};
      const auto record = readDisturbances(params, {"d"}, Vector::Ones(1), 60.0, 100);
      if (record.values.hasNaN()) fail("a record with holes");
    });
}

}  // namespace fpc::fuzz
