#include "study/run_journal.hpp"

#include <cstdlib>
#include <filesystem>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

RunJournal::RunJournal(const std::string& state_file, std::string identity)
    : file_(state_file.empty() ? "" : state_file + ".runs"), identity_(std::move(identity)) {}

bool RunJournal::exists() const { return !file_.empty() && std::filesystem::exists(file_); }

std::map<std::size_t, std::string> RunJournal::read() const {
  std::map<std::size_t, std::string> texts;
  std::ifstream stream(file_);
  std::string line;
  if (file_.empty() || !std::getline(stream, line) || stream.eof()) return texts;
  require(line == identity_, file_,
          "runs of this study or tuning: files and options as they were when it stopped");
  while (std::getline(stream, line) && !stream.eof()) {  // without its end of line it was cut off
    char* end = nullptr;
    const std::size_t run = std::strtoull(line.c_str(), &end, 10);
    require(end != line.c_str() && *end == ' ', file_, "lines NUMBER TEXT");
    texts[run] = end + 1;
  }
  return texts;
}

void RunJournal::begin() {
  if (file_.empty()) return;
  if (stream_.is_open()) stream_.close();
  stream_.open(file_, std::ios::trunc);
  stream_ << identity_ << "\n" << std::flush;
  require(stream_.good(), file_, "a writable file");
}

void RunJournal::add(std::size_t run, const std::string& text) {
  if (file_.empty()) return;
  stream_ << run << " " << text << "\n" << std::flush;
  require(stream_.good(), file_, "a writable file");
}

void RunJournal::remove() {
  if (file_.empty()) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace fpc
