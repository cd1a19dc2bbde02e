#include "study/loop_contents.hpp"

#include <fstream>
#include <iterator>

namespace fpc {
namespace {

std::string contentOf(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

std::string contentsOf(const LoopFile& loop) {
  std::string all;
  if (!loop.model_file.empty()) all += contentOf(loop.model_file);
  if (!loop.identify.structure_file.empty()) all += contentOf(loop.identify.structure_file);
  if (loop.disturbance.source == DisturbanceSource::kCsv) {
    all += contentOf(loop.disturbance.csv.file);
    if (!loop.disturbance.csv.next_file.empty()) all += contentOf(loop.disturbance.csv.next_file);
  }
  return all;
}

}  // namespace fpc
