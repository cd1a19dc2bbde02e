#include "export/export.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "base/text_hash.hpp"
#include "export/block.hpp"
#include "export/evaluate.hpp"
#include "export/page.hpp"
#include "export/print.hpp"
#include "export/print_tests.hpp"
#include "export/vectors.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr std::size_t kEmbedded = 120;  // vectors inside the test of Structured Text

std::string today() {
  const char* fixed = std::getenv("SOURCE_DATE_EPOCH");
  const std::time_t now = fixed ? static_cast<std::time_t>(std::atoll(fixed)) : std::time(nullptr);
  char text[16];
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::strftime(text, sizeof text, "%Y-%m-%d", &utc);
  return text;
}

ExportIdentity identityOf(const LoopFile& loop, const ExportOptions& options) {
  return {loop.name,
          loop.controllerType().name,
          options.exporter,
          options.date.empty() ? today() : options.date,
          blockHash(loop),
          blockNumber(loop),
          loop.plant_info.sample_time_s};
}

/// Single precision is for laws that it does not change.
void requireSingleWillDo(const LoopFile& loop, const ExportOptions& options,
                         const ir::Program& program) {
  BlockVectors vectors(loop, program, options.seed, options.samples);
  ProgramRunner runner(program);
  const auto& limits = loop.simulation.actuator.limits;
  const std::size_t n_in = vectors.inputs().size();
  double worst = 0.0;
  for (int k = 0; k < options.samples; ++k) {
    const std::vector<double>& row = vectors.next();
    for (std::size_t i = 0; i < n_in; ++i) runner.give(vectors.inputs()[i], row[i]);
    runner.step();
    for (Eigen::Index i = 0; i < limits.lower.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double away = std::abs(runner.taken(vectors.outputs()[at]) - row[n_in + at]);
      const double span = std::max(limits.upper[i] - limits.lower[i], 1e-300);
      if (!(away / span <= worst)) worst = away / span;
    }
  }
  require(worst <= kSingleTolerance, loop.name + ": --real",
          "double precision: in single the output is off by up to " + shortText(worst) +
              " of its span, and " + shortText(kSingleTolerance) + " is allowed");
}

void writeFile(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  require(static_cast<bool>(file), path.string(), "a file that can be written");
}

}  // namespace

void makeProgram(const LoopFile& loop, const ExportOptions& options, ir::Program& program) {
  const bool plain =
      !options.name.empty() && std::isalpha(static_cast<unsigned char>(options.name[0])) != 0 &&
      std::all_of(options.name.begin(), options.name.end(),
                  [](unsigned char c) { return std::isalnum(c) != 0 && std::isupper(c) == 0; });
  require(plain, "--name", "small letters and digits, a letter first");
  require(!loop.has_clp || !options.structured_text, loop.name + ": clp",
          "--to c99: the constraint optimizer is exported to C99 only, since its solver is text of "
          "C; in Structured Text the law alone would be another loop");
  require(!loop.has_clp || !options.single, loop.name + ": --real",
          "double precision: the constraint optimizer is exported in double only");
  program.name = options.name;
  program.single = options.single;
  buildBlock(loop, program);
  program.tidy();
}

std::vector<std::string> exportLoop(const LoopFile& loop, const ExportOptions& options,
                                    const std::string& folder) {
  ir::Program program;
  makeProgram(loop, options, program);
  const ExportIdentity identity = identityOf(loop, options);
  if (options.single) requireSingleWillDo(loop, options, program);
  BlockVectors vectors(loop, program, options.seed, options.samples);
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  require(!failed, folder, "a folder that can be made");
  std::vector<std::string> written;
  const auto write = [&](const std::string& name, const std::string& text) {
    writeFile(std::filesystem::path(folder) / name, text);
    written.push_back(name);
  };
  const std::string& name = program.name;
  if (options.c99) {
    write(name + ".h", cHeader(program, identity));
    write(name + ".c", cSource(program, identity));
    write(name + "_test.c", cTest(loop, program, vectors.inputs(), vectors.outputs()));
  }
  std::vector<std::vector<double>> embedded;
  const std::string csv = vectors.csv(options.samples, kEmbedded, embedded);
  if (options.structured_text) {
    write(name + ".st", structuredText(program, identity));
    write(name + "_test.st",
          structuredTextTest(loop, program, vectors.inputs(), vectors.outputs(), embedded));
  }
  write(name + "_vectors.csv", csv);
  write(name + ".md", exportPage(loop, program, identity, options));
  return written;
}

}  // namespace fpc
