// Section `candidate`: a law that is watched beside the one in charge, and how it is handed over.
#include "config/read.hpp"

namespace fpc {

void readCandidate(YamlSection& root, LoopFile& loop) {
  YamlSection section = root.section("candidate");
  CandidateFile& candidate = loop.candidate;
  section.text("loop", candidate.file);
  section.integer("samples", candidate.params.samples, 40, 10000);
  section.boolean("automatic", candidate.params.automatic);
  checked(section, [&] { candidate.params.validate(); });
  section.finish();
  if (!candidate.file.empty()) candidate.loop = readCandidateLoop(candidate.file, loop);
}

}  // namespace fpc
