#include "runtime/journal_rows.hpp"

#include <algorithm>
#include <deque>

#include "fmbpc/base/input_error.hpp"
#include "runtime/journal_reader.hpp"
#include "runtime/record_journal.hpp"
#include "runtime/trajectory.hpp"

namespace fpc {
namespace {

JournalLabel labelOf(const std::string& journal) {
  auto label = journalLabel(journal);
  require(label.has_value(), journal, "a journal of this version");
  return *std::move(label);
}

}  // namespace

JournalRows::JournalRows(const std::string& journal) : journal_(journal) {
  const JournalLabel label = labelOf(journal);
  loop_ = parseLoop(label.text, label.loop);
  loop_.report.record_from_h = 0.0;
  layout_ = recordLayout(loop_);
  run_id_ = label.run_id;
  names_ = Trajectory(loop_, layout_, [](const std::vector<double>&) {}).names();
}

JournalRows::Rows JournalRows::read(std::uint32_t from, std::size_t most) const {
  JournalReader reader(journal_, layout_);
  require(reader.runId() == run_id_, journal_, "the run that it held before");
  RecordLayout part = layout_;
  part.first_step = std::max(from, reader.firstStep());
  reader.skip(part.first_step - reader.firstStep());
  Rows rows{part.first_step, {}};
  Trajectory table(loop_, part, [&rows](const std::vector<double>& cells) {
    rows.cells.insert(rows.cells.end(), cells.begin(), cells.end());
  });
  const auto full = [&] { return rows.cells.size() >= most * names_.size(); };
  std::deque<SampleRecord> held;
  for (SampleRecord sample; !full() && reader.next(sample);) {
    held.push_back(sample);
    const bool whole = layout_.isComplete(sample);
    for (; !full() && !held.empty() && (whole || held.size() > kSettled); held.pop_front())
      table.add(held.front());
  }
  return rows;
}

}  // namespace fpc
