#include "export/print_tests.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number.hpp"
#include "export/block.hpp"
#include "export/export.hpp"
#include "export/print.hpp"
#include "export/vectors.hpp"

namespace fpc {
namespace {

using ir::Kind;
using ir::Variable;

const Variable& variableOf(const ir::Program& program, const std::string& name) {
  return *std::find_if(program.variables().begin(), program.variables().end(),
                       [&](const Variable& v) { return v.name == name; });
}

/// By how much an output may differ.
double allowed(const LoopFile& loop, const ir::Program& program, const std::string& output) {
  const double tolerance = program.single ? kSingleTolerance : kExportTolerance;
  const auto& limits = loop.simulation.actuator.limits;
  for (std::size_t i = 0; i < loop.plant_info.inputs.size(); ++i)
    if (output == "rOut_" + plainName(loop.plant_info.inputs[i].name)) {
      const auto k = static_cast<Eigen::Index>(i);
      return tolerance * (limits.upper[k] - limits.lower[k]);
    }
  for (const SignalInfo& y : loop.plant_info.outputs)
    if (output == "rActive_" + plainName(y.name) && std::isfinite(y.upper - y.lower))
      return tolerance * (y.upper - y.lower);
  return tolerance;
}

bool isReal(const std::string& name) { return name[0] == 'r'; }

}  // namespace

std::string cTest(const LoopFile& loop, const ir::Program& program,
                  const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
  const std::string& name = program.name;
  const std::size_t columns = inputs.size() + outputs.size();
  std::string text =
      R"(/* Plays @_vectors.csv, or the file that is named, through the block; exit code 0: it is the same law. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "@.h"

#define COLUMNS )" +
      std::to_string(columns) + R"(

static unsigned long long hash_of = 14695981039346656037ULL;

static void add(const void *bytes, size_t count) {
  const unsigned char *b = bytes;
  for (size_t i = 0; i < count; i++) hash_of = (hash_of ^ b[i]) * 1099511628211ULL;
}

static double apart(double a, double b) { return a > b ? a - b : b - a; }

int main(int argc, char **argv) {
  static char line[64 * COLUMNS];
  static @_state_t state;
  @_in_t in;
  @_out_t out;
  double v[COLUMNS], worst = 0.0;
  long samples = 0, flags = 0;
  FILE *file = fopen(argc > 1 ? argv[1] : "@_vectors.csv", "r");
  if (file == NULL || fgets(line, sizeof line, file) == NULL) {
    printf("@_test: no vectors\n");
    return 2;
  }
  @_defaults(&in);
  while (fgets(line, sizeof line, file) != NULL) {
    char *at = line;
    for (int i = 0; i < COLUMNS; i++) {
      v[i] = strtod(at, &at);
      at++;
    }
)";
  const std::string real = program.single ? "(float)" : "";
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const Kind kind = variableOf(program, inputs[i]).kind;
    const std::string cell = "v[" + std::to_string(i) + "]";
    text += "    in." + inputs[i] + " = " +
            (kind == Kind::kReal  ? real + cell
             : kind == Kind::kInt ? "(int32_t)" + cell
                                  : cell + " != 0.0") +
            ";\n";
  }
  text += "    @_step(&state, &in, &out);\n";
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const std::string cell = "v[" + std::to_string(inputs.size() + i) + "]",
                      out = "out." + outputs[i];
    text += "    add(&" + out + ", sizeof " + out + ");\n";
    if (isReal(outputs[i])) {
      const std::string scale = realLiteral(allowed(loop, program, outputs[i]), false, 'e');
      text += "    if (!(apart(" + out + ", " + cell + ") / " + scale +
              " <= worst)) worst = apart(" + out + ", " + cell + ") / " + scale + ";\n";
    } else {
      const std::string mask =
          outputs[i] == "iErrors" ? " & " + std::to_string(kComparedErrors) : "";
      text += "    flags += (" + out + mask + ") != (int32_t)" + cell + ";\n";
    }
  }
  text += R"(    samples++;
  }
  fclose(file);
  printf("{\"samples\": %ld, \"difference\": %.3g, \"flags\": %ld, \"hash\": \"%016llx\"}\n", samples, worst * )" +
          std::string(program.single ? "1e-4" : "1e-9") + R"(, flags, hash_of);
  return samples > 0 && worst <= 1.0 && flags == 0 ? 0 : 1;
}
)";
  for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@', at))
    text.replace(at, 1, name);
  return text;
}

std::string structuredTextTest(const LoopFile& loop, const ir::Program& program,
                               const std::vector<std::string>& inputs,
                               const std::vector<std::string>& outputs,
                               const std::vector<std::vector<double>>& rows) {
  const std::string upper = upperCase(program.name), real = program.single ? "REAL" : "LREAL";
  std::string text = "(* Call it " + std::to_string(rows.size()) +
                     " times: xDone, and xPassed if the block answers each vector. A number of "
                     "1E15 stands for none. *)\n"
                     "FUNCTION_BLOCK FB_" +
                     upper +
                     "_TEST\nVAR_OUTPUT\n  xDone : BOOL;\n  xPassed : BOOL := TRUE;\n"
                     "  iFailed : DINT := -1; (* the first sample that differs *)\nEND_VAR\nVAR\n  "
                     "fbTested : FB_" +
                     upper + ";\n  k : DINT;\n  r : " + real + ";\nEND_VAR\nVAR CONSTANT\n";
  const auto column = [&](const std::string& name, std::size_t at) {
    text +=
        "  c" + name + " : ARRAY[0.." + std::to_string(rows.size() - 1) + "] OF " + real + " := [";
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double value = std::isfinite(rows[k][at]) ? rows[k][at] : 1e15;
      text += (k == 0 ? "" : ",") + std::string(k % 8 == 0 ? "\n    " : " ") +
              realLiteral(value, program.single, 'E');
    }
    text += "];\n";
  };
  std::vector<std::size_t> used;  // columns that change
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const double initial = variableOf(program, inputs[i]).initial[0];
    if (std::any_of(rows.begin(), rows.end(),
                    [&](const auto& row) { return !(row[i] == initial); }))
      used.push_back(i);
  }
  for (const std::size_t i : used) column(inputs[i], i);
  for (std::size_t i = 0; i < outputs.size(); ++i) column(outputs[i], inputs.size() + i);
  text += "END_VAR\n  IF k < " + std::to_string(rows.size()) + " THEN\n    fbTested(";
  for (std::size_t n = 0; n < used.size(); ++n) {
    const Kind kind = variableOf(program, inputs[used[n]]).kind;
    const std::string cell = "c" + inputs[used[n]] + "[k]";
    text += (n == 0 ? "" : ",\n      ") + inputs[used[n]] + " := " +
            (kind == Kind::kReal  ? cell
             : kind == Kind::kInt ? real + "_TO_DINT(" + cell + ")"
                                  : "(" + cell + " > 0.5)");
  }
  text += ");\n";
  for (const std::string& name : outputs) {
    if (name == "iErrors") continue;
    const std::string value =
        isReal(name) ? "fbTested." + name : "DINT_TO_" + real + "(fbTested." + name + ")";
    text += "    r := " + value + " - c" + name + "[k];\n    IF ((r <= " +
            realLiteral(isReal(name) ? allowed(loop, program, name) : 0.25, program.single, 'E') +
            ") AND (r >= -" +
            realLiteral(isReal(name) ? allowed(loop, program, name) : 0.25, program.single, 'E') +
            ")) = FALSE THEN\n      xPassed := FALSE;\n      IF iFailed < 0 THEN\n        iFailed "
            ":= k;\n  "
            "    END_IF;\n    END_IF;\n";
  }
  return text + "    k := k + 1;\n  END_IF;\n  xDone := k >= " + std::to_string(rows.size()) +
         ";\nEND_FUNCTION_BLOCK\n";
}

}  // namespace fpc
