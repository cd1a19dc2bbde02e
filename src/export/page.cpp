#include "export/page.hpp"

#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

std::string typeWord(const ir::Variable& v, bool single) {
  if (v.kind == ir::Kind::kBool) return "BOOL, bool";
  if (v.kind == ir::Kind::kInt) return "DINT, int32_t";
  return single ? "REAL, float" : "LREAL, double";
}

std::string signalTable(const ir::Program& program, ir::Role role) {
  std::string text = "| name | type | default | meaning |\n|---|---|---|---|\n";
  for (const ir::Variable& v : program.variables())
    if (v.role == role)
      text += "| `" + v.name + "` | " + typeWord(v, program.single) + " | " +
              (role == ir::Role::kInput ? shortText(v.initial[0]) : "") + " | " + v.meaning +
              " |\n";
  return text + "\n";
}

}  // namespace

std::string exportPage(const LoopFile& loop, const ir::Program& program, const ExportIdentity& id,
                       const ExportOptions& options) {
  const int real = program.single ? 4 : 8;
  std::string text =
      "# Block `" + program.name + "`: " + id.controller + " of loop " + id.loop + "\n\n";
  text += "For whoever puts this block into a PLC or a small board.\n\n| identity | |\n|---|---|\n";
  text +=
      "| exporter | " + id.exporter + " |\n| loop | " + id.loop + ": " + loop.report.title + " |\n";
  text += "| hash of model and loop | " + id.hash + ", `iIdentity` " + std::to_string(id.number) +
          " |\n";
  text += "| sample time | " + shortText(id.sample_time_s) + " s |\n| date | " + id.date + " |\n";
  text += "| precision | " + std::string(program.single ? "single" : "double") + " |\n";
  text += "| vectors | " + std::to_string(options.samples) + " samples, seed " +
          std::to_string(options.seed) + " |\n";
  text += "| tables | " + std::to_string(program.bytesOf(ir::Role::kTable, real)) + " bytes |\n";
  text += "| memory | " + std::to_string(program.bytesOf(ir::Role::kState, real)) +
          " bytes of state (without padding), " +
          std::to_string(program.bytesOf(ir::Role::kWork, real)) + " bytes of work |\n\n";
  text += "Size of the code and instructions of a step: `fmbpc export --check FOLDER`.\n\n";
  text +=
      "Measured values beyond +-1e12 count as none. After power-up, another hash, and `xReset` the "
      "block starts anew "
      "without a bump.\n\n## Inputs\n\n" +
      signalTable(program, ir::Role::kInput);
  return text + "## Outputs\n\n" + signalTable(program, ir::Role::kOutput);
}

}  // namespace fpc
