// Section `candidate`: a law that is watched beside the one in charge, and how it is handed over.
#include "config/read.hpp"

namespace fpc {

void readCandidate(YamlSection& root, LoopFile& loop) {
  YamlSection section = root.section("candidate");
  CandidateFile& candidate = loop.candidate;
  section.text("loop", candidate.file);
  section.boolean("automatic", candidate.params.automatic);
  section.finish();
  if (!candidate.file.empty()) candidate.loop = readCandidateLoop(candidate.file, loop);
}

}  // namespace fpc
